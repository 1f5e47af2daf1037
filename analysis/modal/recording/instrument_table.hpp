#pragma once
#include <string>
#include <vector>
namespace tapstudy::analysis {
struct PlainTable {
  std::string text;
  std::vector<std::string> units;  // of the columns, where they stand apart from the names: "(g)"
};

// A table as instruments and numerical programs write it, as read_csv takes it, line by line: what
// stands before the row above the first row of numbers becomes comments, cells separated by blanks
// become cells separated by tabs, a header with more cells than the rows (LabVIEW's comments) loses
// them, and a comment above the numbers that names as many columns as they have, one of them a
// time, becomes the header. Units are those of a row below the names ("s,g", "(ms),(g)"), which
// goes, or LabVIEW's (Y_Unit_Label). Times that LabVIEW did not save (X_Columns No) are those of
// its header (X0, Delta_X), unless its channels' differ. Rows of numbers: two successive lines of
// as many cells, all of them numbers or, but for the first, empty. Anything else stays as it is.
PlainTable plain_table(const std::string& text);

// Of a LabVIEW file with a header for each segment (Multi_Headings Yes) what stands before the
// second segment's, with a remark; any other text as it is.
std::string first_segment(std::string text, std::vector<std::string>& remarks);
}  // namespace tapstudy::analysis
