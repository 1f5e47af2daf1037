#pragma once
#include "runner/terminal/exit_code.hpp"
namespace tapstudy::runner {
// Parses and runs one command line. Throws what the command throws.
ExitCode run_command_line(int argc, const char* const* argv);
}  // namespace tapstudy::runner
