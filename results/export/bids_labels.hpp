#pragma once
#include <map>
#include <string>
#include <vector>
namespace tapstudy::results {
// Labels of the Brain Imaging Data Structure are letters and digits (ASCII).
struct BidsLabels {
  std::map<std::string, std::string> by_name;
  std::vector<std::string> notes;  // what was changed that a reader must know of
};
// Of names, in order. Of a name of letters, digits, '-' and '_' the label is its letters and
// digits; any other name, a person's for instance, is replaced by `substitute` and a number. Labels
// that would be the same, or differ in case alone, get a number.
BidsLabels bids_labels(const std::vector<std::string>& names, const std::string& substitute);
}  // namespace tapstudy::results
