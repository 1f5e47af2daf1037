#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "analysis/report/confusion/confusion_sections.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/population/serial_dependence.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "analysis/statistics/resampling/replicates.hpp"
#include "analysis/statistics/response_times.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::uint64_t learning_seed = 6;
constexpr std::uint64_t serial_seed = 7;

// Least squares of right answers on presentations; unset for one presentation.
std::optional<double> slope_of(const IdentifyingParticipant& person) {
  const auto n = static_cast<double>(person.trials.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (const IdentifiedTrial& trial : person.trials) {
    mean_x += trial.repetition / n;
    mean_y += trial.is_right ? 1.0 / n : 0.0;
  }
  double products = 0.0;
  double squares = 0.0;
  for (const IdentifiedTrial& trial : person.trials) {
    const double x = trial.repetition - mean_x;
    products += x * ((trial.is_right ? 1.0 : 0.0) - mean_y);
    squares += x * x;
  }
  return squares > 0.0 ? std::optional{products / squares} : std::nullopt;
}

void add_learning(const IdentificationData& data, ReportSection& section) {
  ReportTable table{"learning",
                    "Change of right answers per presentation",
                    {interval_column("change (95 % CI, t)", "change"),
                     column("participants", "participants"), column("permutation", "p")}};
  if (const auto learning = learning_of(data)) {
    table.rows.push_back({interval(learning->mean, learning->interval),
                          count(learning->participants), probability(learning->p)});
    section.remarks.emplace_back(
        "Learning: each participant's slope of right answers over the presentations of a stimulus, "
        "tested by changing the signs of slopes.");
  } else {
    section.remarks.emplace_back(
        "No learning: fewer than two participants were presented a stimulus twice.");
  }
  section.tables.push_back(table);
}

std::size_t right_answer(const IdentificationData& data, std::size_t stimulus) {
  const auto found = std::ranges::find_if(data.responses, [&](const Item& response) {
    return data.stimuli[stimulus].is_answered_by(response.name);
  });
  return static_cast<std::size_t>(found - data.responses.begin());
}

std::size_t number_of_answers(const IdentificationData& data) {
  std::size_t answers = 0;
  for (const IdentifyingParticipant& person : data.participants) {
    answers += person.trials.size();
  }
  return answers;
}

bool are_presented_twice(const IdentificationData& data) {
  return std::ranges::any_of(data.participants, [&](const IdentifyingParticipant& person) {
    return std::ranges::any_of(totals_of(counts_of(data, person)).rows,
                               [](std::int64_t presented) { return presented > 1; });
  });
}

void add_serial(const IdentificationData& data, ReportSection& section) {
  ReportTable table{
      "previous_trial",
      "What the trial before does to an answer",
      {column("the answer is", "effect"), column("of trials", "trials"), column("share", "share"),
       column("expected", "expected"), column("permutation", "p")}};
  if (!are_presented_twice(data)) {
    section.tables.push_back(table);
    section.remarks.emplace_back(
        "Effects of the trial before are not tested: nobody was presented a stimulus twice.");
    return;
  }
  constexpr int most_shuffles = 9999;
  constexpr int fewest_shuffles = 9;
  constexpr std::size_t cost_of_an_answer = 10;
  const int draws = affordable_replicates(cost_of_an_answer * number_of_answers(data),
                                          fewest_shuffles, most_shuffles);
  const SerialDependence found = serial_dependence(sequences_of(data), draws, serial_seed);
  const auto add = [&](const std::string& name, const SerialEffect& effect) {
    table.rows.push_back({word(name), count(effect.trials), share(effect.observed),
                          share(effect.expected), probability(effect.p)});
  };
  add("that of the trial before", found.repeated_answer);
  add("right for the trial before", found.last_right);
  section.tables.push_back(table);
  section.remarks.push_back(fmt::format(
      "Expected: the mean over all permutations of each participant's answers among trials of the "
      "same stimulus; two-sided, by {} of them{}.",
      draws,
      draws < fewest_draws_to_count
          ? ", from whose spread p is computed by Student's t (answers are many)"
          : ""));
}
}  // namespace

std::vector<AnswerSequence> sequences_of(const IdentificationData& data) {
  std::vector<AnswerSequence> sequences;
  for (const IdentifyingParticipant& person : data.participants) {
    sequences.emplace_back();
    for (const IdentifiedTrial& trial : person.trials) {
      sequences.back().stimuli.push_back(trial.stimulus);
      sequences.back().right.push_back(right_answer(data, trial.stimulus));
      sequences.back().responses.push_back(trial.response);
    }
  }
  return sequences;
}

std::optional<PairedContrast> learning_of(const IdentificationData& data) {
  std::vector<double> slopes;
  if (grouping_by_repetition(data)) {
    for (const IdentifyingParticipant& person : data.participants) {
      if (const auto slope = slope_of(person)) {
        slopes.push_back(*slope);
      }
    }
  }
  return slopes.size() < 2 ? std::nullopt : std::optional{paired_contrast(slopes, learning_seed)};
}

ReportSection order_section(const IdentificationData& data) {
  ReportSection section{"Learning and order"};
  add_learning(data, section);
  add_serial(data, section);
  return section;
}

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
                        mean_of_positive(medians), number(quarters.low), number(quarters.median),
                        number(quarters.high)});
}

ReportTable times_table(const IdentificationData& data) {
  ReportTable table{"response_times",
                    "Response times in seconds",
                    {column("answers", "answers"), column("from", "from"), column("n", "n"),
                     interval_column("mean of participants' medians (95 % CI)", "mean_median_s"),
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
      core::citing("Times from the start of the trial, and from the first contact with the plate. "
                   "The balanced integration score is z(share right) - z(mean time of right "
                   "answers) over the participants ({}); who was never right has none.",
                   "Liesefeld & Janczyk 2019"_source));
  return section;
}

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
  return mean_of_positive(means);
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
                    "In a trial, means over participants (95 % CI)",
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
