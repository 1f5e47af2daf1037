#pragma once
#include <string>

#include "runner/terminal/line_input.hpp"
namespace tapstudy::runner {
// Asks the person at the terminal to do something and then press Enter. Type-ahead is discarded.
// False if the person typed quit, asked to stop, or the input ended.
bool asked_and_done(LineInput& input, const std::string& task);
}  // namespace tapstudy::runner
