#pragma once
#include <map>
#include <string>
namespace tapstudy::analysis {
// What each participant's answers to a block come to, as one number.
struct PersonalValues {
  std::string measure;  // with its unit; blocks of one measure can be compared
  bool is_ratio{};      // values are above 0, and compared by their ratio
  std::map<std::string, double> by_participant;
};
}  // namespace tapstudy::analysis
