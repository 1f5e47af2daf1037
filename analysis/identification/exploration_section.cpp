#include <algorithm>
#include <functional>

#include "analysis/identification/participant_sections.hpp"
#include "analysis/participants/mean_proportion.hpp"
#include "analysis/statistics/quantiles.hpp"
namespace tapstudy::analysis {
namespace {
using ValueOf = std::function<std::optional<double>(const IdentifiedTrial& trial)>;

// The mean of participants' means over the trials of a stimulus (all, if unset).
Cell mean_cell(const IdentificationData& data, std::optional<std::size_t> stimulus,
               const ValueOf& value_of) {
  std::vector<double> means;
  for (const IdentifyingParticipant& person : data.participants) {
    double sum = 0.0;
    double n = 0.0;
    for (const IdentifiedTrial& trial : person.trials) {
      const auto value = !stimulus || trial.stimulus == *stimulus ? value_of(trial) : std::nullopt;
      sum += value.value_or(0.0);
      n += value ? 1.0 : 0.0;
    }
    if (n > 0.0) {
      means.push_back(sum / n);
    }
  }
  if (means.empty()) {
    return {"–", {Value{}, Value{}, Value{}}};
  }
  return mean_with_interval(means);
}

std::vector<Cell> row_of(const IdentificationData& data, const std::string& name,
                         std::optional<std::size_t> stimulus) {
  return {word(name),
          mean_cell(data, stimulus,
                    [](const IdentifiedTrial& trial) {
                      return std::optional{static_cast<double>(trial.impacts)};
                    }),
          mean_cell(data, stimulus,
                    [](const IdentifiedTrial& trial) { return trial.mean_impact_speed_m_s; }),
          mean_cell(data, stimulus,
                    [](const IdentifiedTrial& trial) { return std::optional{trial.contact_s}; })};
}
}  // namespace

ReportSection exploration_section(const IdentificationData& data) {
  ReportSection section{"What the participants did"};
  ReportTable table{"exploration",
                    "In a trial, means over participants (95 % CI, t)",
                    {column("presented", "stimulus"), interval_column("impacts", "impacts"),
                     interval_column("their speed, m/s", "speed_m_s"),
                     interval_column("time in contact, s", "contact_s")}};
  const bool are_impacts_known =
      std::ranges::any_of(data.participants, [](const IdentifyingParticipant& person) {
        return std::ranges::any_of(person.trials,
                                   [](const IdentifiedTrial& trial) { return trial.impacts > 0; });
      });
  if (!are_impacts_known) {
    section.tables.push_back(table);
    section.remarks.emplace_back("No impacts are stored of these trials.");
    return section;
  }
  for (std::size_t i = 0; i < data.stimuli.size(); ++i) {
    table.rows.push_back(row_of(data, data.stimuli[i].name, i));
  }
  table.rows.push_back(row_of(data, "all", std::nullopt));
  section.tables.push_back(table);
  section.remarks.emplace_back(
      "Where participants tapped some stimuli otherwise than others, that may explain answers. "
      "Impacts are all that came down on the plate, rebounds among them; forces of whole taps are "
      "with what was rendered.");
  return section;
}
}  // namespace tapstudy::analysis
