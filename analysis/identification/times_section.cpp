#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "analysis/identification/participant_sections.hpp"
#include "analysis/participants/mean_proportion.hpp"
#include "analysis/response_times/response_times.hpp"
#include "analysis/statistics/quantiles.hpp"
namespace tapstudy::analysis {
namespace {
using TimeOf = std::function<std::optional<double>(const IdentifiedTrial& trial)>;
using Counts = std::function<bool(const IdentifiedTrial& trial)>;

// Participants' medians, and quartiles of all.
void add_times(const IdentificationData& data, const std::string& what, const std::string& from,
               const Counts& counts, const TimeOf& time_of, ReportTable& table) {
  std::vector<double> medians;
  std::vector<double> all;
  for (const IdentifyingParticipant& person : data.participants) {
    std::vector<double> own;
    for (const IdentifiedTrial& trial : person.trials) {
      if (const auto time = counts(trial) ? time_of(trial) : std::nullopt) {
        own.push_back(*time);
      }
    }
    if (!own.empty()) {
      medians.push_back(quantile(own, 0.5));
      all.insert(all.end(), own.begin(), own.end());
    }
  }
  if (all.empty()) {
    return;
  }
  const Quartiles quarters = quartiles(all);
  table.rows.push_back({word(what), word(from), count(static_cast<std::int64_t>(all.size())),
                        mean_with_interval(medians), number(quarters.low), number(quarters.median),
                        number(quarters.high)});
}

ReportTable times_table(const IdentificationData& data) {
  ReportTable table{"response_times",
                    "Response times in seconds",
                    {column("answers", "answers"), column("from", "from"), column("n", "n"),
                     interval_column("mean of participants' medians (95 % CI, t)", "mean_median_s"),
                     column("lower quartile", "quartile_low_s"), column("median", "median_s"),
                     column("upper quartile", "quartile_high_s")}};
  const std::vector<std::pair<std::string, Counts>> subsets{
      {"all", [](const IdentifiedTrial&) { return true; }},
      {"right", [](const IdentifiedTrial& trial) { return trial.is_right; }},
      {"wrong", [](const IdentifiedTrial& trial) { return !trial.is_right; }}};
  for (const auto& [name, counts] : subsets) {
    add_times(
        data, name, "start", counts,
        [](const IdentifiedTrial& trial) { return trial.response_time_s; }, table);
    add_times(
        data, name, "first contact", counts,
        [](const IdentifiedTrial& trial) { return trial.time_from_first_contact_s; }, table);
  }
  for (std::size_t i = 0; i < data.stimuli.size(); ++i) {
    add_times(
        data, data.stimuli[i].name, "start",
        [i](const IdentifiedTrial& trial) { return trial.stimulus == i; },
        [](const IdentifiedTrial& trial) { return trial.response_time_s; }, table);
  }
  return table;
}

std::vector<TimedAnswers> timed(const IdentificationData& data) {
  std::vector<TimedAnswers> people;
  for (const IdentifyingParticipant& person : data.participants) {
    people.emplace_back();
    for (const IdentifiedTrial& trial : person.trials) {
      if (trial.response_time_s) {
        people.back().push_back({*trial.response_time_s, trial.is_right});
      }
    }
  }
  return people;
}

void add_conditional_accuracy(const IdentificationData& data, ReportSection& section) {
  constexpr std::size_t bins = 4;
  ReportTable table{"conditional_accuracy",
                    "Right answers by speed, quarters of each participant's answers",
                    {column("quarter", "quarter"), column("mean time, s", "mean_time_s"),
                     column("right", "share_right")}};
  const auto found = conditional_accuracy(timed(data), bins);
  Chart chart;
  chart.caption = "Share right over response time: the fastest to the slowest quarter.";
  chart.alternative = "Conditional accuracy function";
  chart.x_label = "response time, s";
  chart.y_label = "share right";
  chart.y_range = {0.0, 1.0};
  chart.levels = {1.0 / static_cast<double>(alternatives_among(data.responses))};
  std::vector<double> times;
  for (std::size_t i = 0; i < found.size(); ++i) {
    table.rows.push_back({count(static_cast<std::int64_t>(i) + 1), number(found[i].mean_time_s),
                          share(found[i].share_right)});
    chart.points.push_back({found[i].mean_time_s, found[i].share_right});
    chart.line.push_back(chart.points.back());
    times.push_back(found[i].mean_time_s);
  }
  section.tables.push_back(table);
  if (!times.empty()) {
    chart.x_range = range_of(times, false);
    section.charts.push_back(chart);
  }
}

// Unset if no right answer has a time.
std::optional<SpeedAndAccuracy> speed_and_accuracy(const IdentifyingParticipant& person) {
  double time = 0.0;
  double timed = 0.0;  // of the right ones
  double right = 0.0;
  for (const IdentifiedTrial& trial : person.trials) {
    const bool is_timed = trial.is_right && trial.response_time_s;
    time += is_timed ? *trial.response_time_s : 0.0;
    timed += is_timed ? 1.0 : 0.0;
    right += trial.is_right ? 1.0 : 0.0;
  }
  if (timed == 0.0) {
    return std::nullopt;
  }
  return SpeedAndAccuracy{right / static_cast<double>(person.trials.size()), time / timed};
}

ReportTable balanced_table(const IdentificationData& data) {
  ReportTable table{"balanced_integration",
                    "Speed and accuracy of each participant",
                    {column("participant", "participant_id"), column("right", "share_right"),
                     column("mean time of right answers, s", "mean_right_time_s"),
                     column("balanced integration score", "balanced_integration_score")}};
  std::vector<SpeedAndAccuracy> entries;
  for (const IdentifyingParticipant& person : data.participants) {
    if (const auto entry = speed_and_accuracy(person)) {
      entries.push_back(*entry);
      table.rows.push_back(
          {word(person.id), share(entries.back().share_right), number(entries.back().mean_time_s)});
    }
  }
  const auto scores = balanced_integration_scores(entries);
  if (scores.empty()) {
    table.rows.clear();
  }
  for (std::size_t i = 0; i < scores.size(); ++i) {
    table.rows[i].push_back(number(scores[i]));
  }
  return table;
}

bool are_times_known(const IdentificationData& data) {
  return std::ranges::any_of(data.participants, [](const IdentifyingParticipant& person) {
    return std::ranges::any_of(person.trials, [](const IdentifiedTrial& trial) {
      return trial.response_time_s.has_value();
    });
  });
}
}  // namespace

ReportSection times_section(const IdentificationData& data) {
  ReportSection section{"Response times"};
  if (!are_times_known(data)) {
    section.remarks.emplace_back("No times are known of these answers.");
    return section;
  }
  section.tables.push_back(times_table(data));
  add_conditional_accuracy(data, section);
  section.tables.push_back(balanced_table(data));
  section.remarks.emplace_back(
      "Times from the start of the trial, and from the first contact with the plate. The balanced "
      "integration score is z(share right) - z(mean time of right answers) over the participants "
      "(Liesefeld & Janczyk 2019); who was never right has none.");
  return section;
}
}  // namespace tapstudy::analysis
