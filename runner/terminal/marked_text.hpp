#pragma once
#include <string>
#include <string_view>
namespace tapstudy::runner {
// Text of a study for a terminal: "# " headings and **bold** without their marks, in bold where the
// terminal shows it (ECMA-48 SGR). Lists and paragraphs stay as they are written.
std::string marked_text(std::string_view text, bool shows_bold);
}  // namespace tapstudy::runner
