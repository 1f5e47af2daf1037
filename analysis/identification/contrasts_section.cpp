#include <fmt/format.h>

#include <algorithm>

#include "analysis/identification/participant_sections.hpp"
#include "analysis/participants/paired_contrast.hpp"
#include "analysis/rank_tests/signed_rank.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::uint64_t contrasts_seed = 5;

struct Contrast {
  std::string group;
  std::string first;
  std::string second;
  PairedContrast result;
};

Proportion right_at(const IdentifyingParticipant& person, const Grouping& grouping,
                    std::size_t level) {
  Proportion right;
  for (const IdentifiedTrial& trial : person.trials) {
    const bool is_of_level = grouping.level_of(trial) == level;
    right.trials += is_of_level ? 1 : 0;
    right.successes += is_of_level && trial.is_right ? 1 : 0;
  }
  return right;
}

// Of each participant with answers of both levels: the difference of the shares right.
std::vector<double> differences(const IdentificationData& data, const Grouping& grouping,
                                std::size_t first, std::size_t second) {
  std::vector<double> found;
  for (const IdentifyingParticipant& person : data.participants) {
    const Proportion of_first = right_at(person, grouping, first);
    const Proportion of_second = right_at(person, grouping, second);
    if (of_first.trials > 0 && of_second.trials > 0) {
      found.push_back(of_first.value() - of_second.value());
    }
  }
  return found;
}

std::vector<Contrast> contrasts_of(const IdentificationData& data, const Grouping& grouping) {
  std::vector<Contrast> contrasts;
  for (std::size_t i = 0; i < grouping.levels.size(); ++i) {
    for (std::size_t j = i + 1; j < grouping.levels.size(); ++j) {
      const std::vector<double> found = differences(data, grouping, i, j);
      if (found.size() > 1) {
        contrasts.push_back({grouping.name, grouping.levels[i], grouping.levels[j],
                             paired_contrast(found, contrasts_seed)});
      }
    }
  }
  return contrasts;
}
}  // namespace

ReportSection contrasts_section(const IdentificationData& data) {
  ReportTable table{"contrasts",
                    "Differences of right answers within participants",
                    {column("of", "of"), column("first", "first"), column("second", "second"),
                     interval_column("first - second (95 % CI, t)", "difference"),
                     column("participants", "participants"), column("permutation", "p"),
                     column("after Holm", "p_holm")}};
  ReportSection section{"Contrasts"};
  for (const Grouping& grouping : groupings_of_stimuli(data)) {
    const std::vector<Contrast> contrasts = contrasts_of(data, grouping);
    std::vector<double> p;
    std::ranges::transform(contrasts, std::back_inserter(p),
                           [](const Contrast& contrast) { return contrast.result.p; });
    const std::vector<double> adjusted = holm_adjusted(p);
    for (std::size_t i = 0; i < contrasts.size(); ++i) {
      const PairedContrast& result = contrasts[i].result;
      table.rows.push_back({word(contrasts[i].group), word(contrasts[i].first),
                            word(contrasts[i].second), interval(result.mean, result.interval),
                            count(result.participants), probability(result.p),
                            probability(adjusted[i])});
    }
  }
  section.tables.push_back(table);
  if (table.rows.empty()) {
    section.remarks.emplace_back(
        "No contrasts: no technique or factor has two levels that two participants were "
        "presented.");
    return section;
  }
  section.remarks.emplace_back(
      "Differences of a participant's shares right; two-sided permutation test by changing the "
      "signs of participants' differences (all patterns up to 16, else 9999), adjusted within a "
      "technique or factor by Holm 1979. A participant who prefers some answers is right more "
      "often where they are right.");
  return section;
}
}  // namespace tapstudy::analysis
