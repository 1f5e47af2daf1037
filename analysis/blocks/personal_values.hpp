#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// What each participant's answers to a block come to, as one number.
struct PersonalValues {
  std::string measure;  // with its unit; blocks of one measure can be compared
  bool is_ratio{};      // values are above 0, and compared by their ratio
  std::map<std::string, double> by_participant;
};

// Of the people for whom value_of gives one.
template <class People, class ValueOf>
PersonalValues personal_values(std::string measure, bool is_ratio, const People& people,
                               const ValueOf& value_of) {
  PersonalValues values{std::move(measure), is_ratio, {}};
  for (const auto& person : people) {
    if (const std::optional<double> value = value_of(person)) {
      values.by_participant[person.participant_id] = *value;
    }
  }
  return values;
}

// Unset without trials.
inline std::optional<double> share_of(const Proportion& proportion) {
  return proportion.trials > 0 ? std::optional{proportion.value()} : std::nullopt;
}
}  // namespace tapstudy::analysis
