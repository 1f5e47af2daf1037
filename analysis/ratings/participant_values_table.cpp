#include "analysis/ratings/participant_values_table.hpp"

#include <fmt/format.h>

#include "analysis/participants/mean_proportion.hpp"
#include "analysis/statistics/quantiles.hpp"
namespace tapstudy::analysis {
ReportTable participant_values_table(const std::string& title, const Column& of,
                                     const std::vector<std::string>& participants,
                                     const std::vector<std::string>& stimuli,
                                     const RatingTable& values) {
  ReportTable table{"participants",
                    title,
                    {column("participant", "participant_id"), column("stimulus", "stimulus"), of}};
  table.is_for_programs = true;
  for (std::size_t person = 0; person < participants.size(); ++person) {
    for (std::size_t i = 0; i < stimuli.size(); ++i) {
      table.rows.push_back(
          {word(participants[person]), word(stimuli[i]), number(values[person][i])});
    }
  }
  return table;
}

std::vector<MainResult> means_over_participants(const std::string& what,
                                                const std::vector<std::string>& stimuli,
                                                const std::vector<std::vector<double>>& values) {
  std::vector<MainResult> means;
  for (std::size_t i = 0; i < stimuli.size() && values.size() > 1; ++i) {
    std::vector<double> of_stimulus;
    for (const std::vector<double>& of_participant : values) {
      of_stimulus.push_back(of_participant[i]);
    }
    means.push_back({fmt::format("{}: {}", what, stimuli[i]), mean_and_spread(of_stimulus).mean,
                     t_interval(of_stimulus)});
  }
  return means;
}
}  // namespace tapstudy::analysis
