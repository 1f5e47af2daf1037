#include <fmt/format.h>

#include <algorithm>

#include "analysis/identification/participant_sections.hpp"
namespace tapstudy::analysis {
namespace {
// Unset if a stimulus has no level, or all have the same.
std::optional<Grouping> grouped(const std::string& name, const std::vector<std::string>& levels) {
  Grouping grouping{name, {}, {}};
  for (const std::string& level : levels) {
    if (level.empty()) {
      return std::nullopt;
    }
    auto found = std::ranges::find(grouping.levels, level);
    if (found == grouping.levels.end()) {
      found = grouping.levels.insert(found, level);
    }
    grouping.level_of_stimulus.push_back(static_cast<std::size_t>(found - grouping.levels.begin()));
  }
  return grouping.levels.size() > 1 ? std::optional{grouping} : std::nullopt;
}
}  // namespace

std::vector<Grouping> groupings_of_stimuli(const IdentificationData& data) {
  std::vector<Grouping> groupings;
  const auto add = [&](const std::string& name, const auto& level_of) {
    std::vector<std::string> levels;
    std::ranges::transform(data.stimuli, std::back_inserter(levels), level_of);
    if (auto grouping = grouped(name, levels)) {
      groupings.push_back(std::move(*grouping));
    }
  };
  add("technique", [](const Item& stimulus) { return stimulus.technique; });
  if (!data.stimuli.empty()) {
    for (const auto& [factor, level] : data.stimuli.front().factors) {
      add(factor, [&key = factor](const Item& stimulus) {
        const auto found = stimulus.factors.find(key);
        return found == stimulus.factors.end() ? std::string{} : found->second;
      });
    }
  }
  return groupings;
}

std::optional<Grouping> grouping_by_repetition(const IdentificationData& data) {
  int most = 0;
  for (const IdentifyingParticipant& person : data.participants) {
    for (const IdentifiedTrial& trial : person.trials) {
      if (trial.repetition < 1) {
        return std::nullopt;
      }
      most = std::max(most, trial.repetition);
    }
  }
  constexpr int most_levels = 20;
  constexpr int parts = 10;
  Grouping grouping{"presentation", {}, {}, most > most_levels ? (most + parts - 1) / parts : 1};
  const int step = grouping.repetitions_a_level;
  for (int first = 1; first <= most; first += step) {
    grouping.levels.push_back(step == 1
                                  ? fmt::format("{}", first)
                                  : fmt::format("{}–{}", first, std::min(most, first + step - 1)));
  }
  return most > 1 ? std::optional{grouping} : std::nullopt;
}
}  // namespace tapstudy::analysis
