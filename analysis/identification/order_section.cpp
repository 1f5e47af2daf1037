#include <fmt/format.h>

#include <algorithm>

#include "analysis/identification/participant_sections.hpp"
#include "analysis/participants/paired_contrast.hpp"
#include "analysis/participants/serial_dependence.hpp"
#include "analysis/resampling/replicates.hpp"
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
}  // namespace tapstudy::analysis
