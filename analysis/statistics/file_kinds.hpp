#pragma once
#include <string>
#include <string_view>
namespace tapstudy::analysis {
// Throws InvalidInput, with what the file is and how it becomes a table of text, for the beginning
// of a workbook, of another program's own data or of a compressed file.
void check_may_be_text(std::string_view beginning, const std::string& file);
}  // namespace tapstudy::analysis
