#pragma once
#include <string>

#include "runner/terminal/line_input.hpp"
#include "runner/terminal/typed_commands.hpp"
namespace tapstudy::runner {
// Asks the person at the terminal to do something and then type `word`; empty: to press Enter.
// Type-ahead is discarded, except for the operator's lines, which go to `commands`.
// False if the person typed quit, asked to stop, or the input ended.
bool asked_and_done(LineInput& input, TypedCommands& commands, const std::string& task,
                    const std::string& word = "");
}  // namespace tapstudy::runner
