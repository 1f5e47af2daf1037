#pragma once
#include "runner/terminal/exit_code.hpp"
namespace tapstudy::runner {
// Parses and carries out one command line. Throws what the command throws.
ExitCode carry_out(int argc, const char* const* argv);
}  // namespace tapstudy::runner
