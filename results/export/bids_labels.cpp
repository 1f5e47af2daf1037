#include "results/export/bids_labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
namespace tapstudy::results {
namespace {
bool is_letter_or_digit(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}
bool is_plain(const std::string& name) {
  return std::ranges::any_of(name, is_letter_or_digit) && std::ranges::all_of(name, [](char c) {
           return is_letter_or_digit(c) || c == '-' || c == '_';
         });
}
std::string cleaned(const std::string& name) {
  std::string label;
  std::ranges::copy_if(name, std::back_inserter(label), is_letter_or_digit);
  return label;
}
// As file systems that ignore case see it.
std::string lowered(std::string label) {
  std::ranges::transform(label, label.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return label;
}
}  // namespace

BidsLabels bids_labels(const std::vector<std::string>& names, const std::string& substitute) {
  BidsLabels labels;
  std::set<std::string> taken;
  int replaced = 0;
  int numbered = 0;
  for (const std::string& name : names) {
    const std::string wanted =
        is_plain(name) ? cleaned(name) : fmt::format("{}{:02}", substitute, ++replaced);
    std::string label = wanted;
    for (int i = 2; !taken.insert(lowered(label)).second; ++i) {
      label = fmt::format("{}x{}", wanted, i);
    }
    numbered += label == wanted ? 0 : 1;
    labels.by_name[name] = label;
  }
  if (replaced > 0) {
    labels.notes.push_back(
        fmt::format("names that are no labels were replaced by {}01 and so on, in order: {}",
                    substitute, replaced));
  }
  if (numbered > 0) {
    labels.notes.push_back(fmt::format(
        "labels that would have been the same were told apart by x2 and so on: {}", numbered));
  }
  return labels;
}
}  // namespace tapstudy::results
