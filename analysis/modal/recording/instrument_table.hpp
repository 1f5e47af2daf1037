#pragma once
#include <string>
namespace tapstudy::analysis {
// A table as instruments and numerical programs write it, as read_csv takes it, line by line: what
// stands before the row above the first row of numbers becomes comments, cells separated by blanks
// become cells separated by tabs, a header with more cells than the rows (LabVIEW's comments) loses
// them, and a comment above the numbers that names as many columns as they have, one of them a
// time, becomes the header. Rows of numbers: two successive lines of as many cells, all of them
// numbers or, but for the first, empty. Anything else stays as it is.
std::string plain_table(const std::string& text);
}  // namespace tapstudy::analysis
