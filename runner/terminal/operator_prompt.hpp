#pragma once
#include <string>

#include "runner/terminal/line_input.hpp"
namespace tapstudy::runner {
// Asks the operator to do something and to press Enter then. What was typed before the question is
// no answer to it. False: the operator typed quit, asked to stop, or is gone.
bool asked_and_done(LineInput& input, const std::string& task);
}  // namespace tapstudy::runner
