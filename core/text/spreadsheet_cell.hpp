#pragma once
#include <string>
#include <string_view>
// Spreadsheets take a cell of a CSV file for a formula, and run it, where its text begins with
// = + - @ (in full width, too), a tab or a line break. A text that does is therefore written with
// an apostrophe before it, which is how a spreadsheet's users themselves enter what is not to be
// run. Numbers stay as they are. A text that begins with apostrophes before such a character gets
// one more, so that no two texts are written alike: whoever takes away one apostrophe where
// apostrophes stand before such a text has the text as it was.
namespace tapstudy::core {
std::string guarded_cell(std::string_view text);
// The inverse.
std::string_view text_of_cell(std::string_view cell);
}  // namespace tapstudy::core
