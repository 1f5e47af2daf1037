#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "analysis/report/confusion/confusion_sections.hpp"
#include "analysis/statistics/contingency/agreement.hpp"
#include "analysis/statistics/contingency/information_transfer.hpp"
#include "inference/people.hpp"
#include "inference/rows.hpp"
namespace tapstudy::bench {
namespace {
using analysis::BlockDesign;
using analysis::IdentificationData;
constexpr int trials_of_each = 4;
constexpr std::size_t stimuli = 4;

// No stimulus three times running.
std::vector<int> constrained_order(core::Rng& rng) {
  for (;;) {
    const auto order = shuffled(stimuli, trials_of_each, rng);
    bool is_thrice = false;
    for (std::size_t i = 2; i < order.size(); ++i) {
      is_thrice = is_thrice || (order[i] == order[i - 1] && order[i] == order[i - 2]);
    }
    if (!is_thrice) {
      return {order.begin(), order.end()};
    }
  }
}

BlockDesign design_of(bool is_constrained) {
  BlockDesign design;
  design.name = "plates";
  design.is_order_known = is_constrained;  // unknown: shuffling answers draws the order again
  for (const char* const structure : {"one", "two"}) {
    for (const char* const material : {"wood", "steel"}) {
      analysis::Item item;
      item.name = fmt::format("{}_{}", material, structure);
      item.label = item.name;
      item.factors = {{"structure", structure}, {"material", material}};
      design.stimuli.push_back(item);
      design.responses.push_back(item);
    }
  }
  if (is_constrained) {
    design.redraw = [](const analysis::Place& place, std::uint64_t draw) {
      core::Rng rng{draw + 977 * static_cast<std::uint64_t>(place.participant_index)};
      return constrained_order(rng);
    };
  }
  return design;
}

enum class Attendance { all, some_stop };  // a third half way

// Right with the share, else a guess among all.
IdentificationData answers_of(const BlockDesign& design, const StudyDraw& draw,
                              const std::function<double()>& share_of_person,
                              Attendance attendance = Attendance::all) {
  std::vector<results::AnswerRow> answers;
  for (int person = 0; person < draw.people; ++person) {
    const double share = share_of_person();
    const bool stops = attendance == Attendance::some_stop && draw.rng.below(3) == 0;
    std::optional<std::size_t> last;
    const auto order = design.redraw ? constrained_order(draw.rng) : std::vector<int>{};
    const auto free_order = shuffled(stimuli, trials_of_each, draw.rng);
    std::vector<int> presented(stimuli, 0);
    for (std::size_t i = 0; i < free_order.size() / (stops ? 2 : 1); ++i) {
      const std::size_t stimulus =
          order.empty() ? free_order[i] : static_cast<std::size_t>(order[i]);
      last = draw.rng.uniform() < share ? stimulus : guess(draw.guesser, stimuli, last, draw.rng);
      results::AnswerRow& answer = answers.emplace_back();
      answer.participant_id = fmt::format("p{:02}", person);
      answer.participant_index = person;
      answer.stimulus = design.stimuli[stimulus].name;
      answer.response = design.responses[*last].name;
      answer.is_correct = stimulus == *last;
      answer.trial_id = static_cast<std::int64_t>(answers.size());
      answer.place_in_block = static_cast<int>(i);
      answer.repetition = ++presented[stimulus];
    }
  }
  return identification_data(design, answers);
}

using Test = std::function<std::optional<Outcome>(const BlockDesign&, const IdentificationData&,
                                                  core::Rng&)>;

Row of_guessers(const std::string& words, bool is_constrained, By by, const Test& test,
                Attendance attendance = Attendance::all) {
  const auto design = std::make_shared<const BlockDesign>(design_of(is_constrained));
  return {Kind::size, "identification", words, by, [=](const StudyDraw& draw) {
            const auto data = answers_of(
                *design, draw, [] { return 0.0; }, attendance);
            return test(*design, data, draw.rng);
          }};
}

std::optional<Outcome> accuracy(const BlockDesign& design, const IdentificationData& data,
                                core::Rng& rng) {
  return accuracy_against(*randomisation_of(design, data).tables, rng());
}

std::optional<Outcome> information(const BlockDesign& design, const IdentificationData& data,
                                   core::Rng& rng) {
  return Outcome{
      guessed_information(*randomisation_of(design, data).tables, draws_of_a_test, rng(), 1).p};
}

std::optional<Outcome> dependence(const BlockDesign& design, const IdentificationData& data,
                                  core::Rng& rng) {
  const auto tables = randomisation_of(design, data).tables;
  return Outcome{monte_carlo_independence(*tables, draws_of_a_test, rng(), 1).p};
}

std::optional<Outcome> agreement_in_factor(const BlockDesign& design,
                                           const IdentificationData& data, core::Rng& rng) {
  const analysis::ConfusionMatrix items{design.stimuli, design.responses};
  const auto tests = chance_tests(randomisation_of(design, data), items, {"material"},
                                  analysis::Draws{draws_of_a_test, rng()});
  return Outcome{tests.factors.at(0).p};
}

// All answers for those of one participant, who had so many blocks of shuffled stimuli.
std::optional<Outcome> accuracy_of_one(BlockDesign design, IdentificationData data,
                                       core::Rng& rng) {
  const std::size_t blocks = data.participants.size();
  analysis::IdentifyingParticipant one = data.participants.front();
  one.trials.clear();
  for (const auto& person : data.participants) {
    for (analysis::IdentifiedTrial trial : person.trials) {
      trial.place = one.trials.size();
      one.trials.push_back(trial);
    }
  }
  data.participants = {one};
  design.is_order_known = true;
  design.redraw = [blocks](const analysis::Place& /*place*/, std::uint64_t draw) {
    core::Rng again{draw};
    std::vector<int> order;
    for (std::size_t block = 0; block < blocks; ++block) {
      const auto shuffled_block = shuffled(stimuli, trials_of_each, again);
      order.insert(order.end(), shuffled_block.begin(), shuffled_block.end());
    }
    return order;
  };
  return accuracy_against(*randomisation_of(design, data).tables, rng());
}

// Of each participant how much the share right at one level of the first factor exceeds that at the
// other, less what preferences give: what the contrast's signs are exchanged of.
double beyond_preference(const analysis::IdentifyingParticipant& person,
                         const analysis::Grouping& grouping) {
  std::vector<double> named(stimuli, 0.0);
  for (const auto& trial : person.trials) {
    named[trial.response] += 1.0 / static_cast<double>(person.trials.size());
  }
  double sums[2]{0.0, 0.0};
  int trials[2]{0, 0};
  for (const auto& trial : person.trials) {
    const std::size_t level = grouping.level_of(trial);
    sums[level] += (trial.is_right ? 1.0 : 0.0) - named[trial.stimulus];
    ++trials[level];
  }
  return sums[0] / trials[0] - sums[1] / trials[1];
}

std::optional<Outcome> contrast(const BlockDesign& /*design*/, const IdentificationData& data,
                                core::Rng& rng) {
  const analysis::ReportSection section = contrasts_section(data);
  const analysis::Grouping grouping = groupings_of_stimuli(data).at(0);
  std::vector<double> differences;
  for (const auto& person : data.participants) {
    differences.push_back(beyond_preference(person, grouping));
  }
  return Outcome{std::get<double>(section.tables.at(0).rows.at(0).at(5).values.at(0)),
                 share_further_by_signs(differences, rng)};
}

// In proportion to the least squares slope of right answers on presentations 1 to 4.
double slope_over_presentations(const analysis::IdentifyingParticipant& person) {
  double slope = 0.0;
  for (const auto& trial : person.trials) {
    slope += trial.is_right ? trial.repetition - 0.5 * (trials_of_each + 1) : 0.0;
  }
  return slope;
}

std::optional<Outcome> learning(const BlockDesign& /*design*/, const IdentificationData& data,
                                core::Rng& rng) {
  std::vector<double> slopes;
  for (const auto& person : data.participants) {
    slopes.push_back(slope_over_presentations(person));
  }
  return Outcome{analysis::learning_of(data).value().p, share_further_by_signs(slopes, rng)};
}

// How much more often a class is named than presented.
std::optional<Outcome> naming(const BlockDesign& /*design*/, const IdentificationData& data,
                              core::Rng& rng) {
  std::vector<double> differences;
  for (const auto& person : data.participants) {
    const analysis::TableTotals totals = analysis::totals_of(counts_of(data, person));
    differences.push_back(static_cast<double>(totals.columns[0] - totals.rows[0]));
  }
  return sign_flips_of(differences, rng);
}

std::optional<Outcome> previous_trial(const BlockDesign& /*design*/, const IdentificationData& data,
                                      core::Rng& rng) {
  return Outcome{serial_dependence(sequences_of(data), draws_of_a_test, rng(), 1).last_right.p};
}

std::optional<Outcome> repeated_answer(const BlockDesign& /*design*/,
                                       const IdentificationData& data, core::Rng& rng) {
  return Outcome{
      serial_dependence(sequences_of(data), draws_of_a_test, rng(), 1).repeated_answer.p};
}

// Of people who are right in half of the trials on average.
IdentificationData of_different_people(const BlockDesign& design, const StudyDraw& draw) {
  return answers_of(design, draw, [&] { return personal_share(0.5, 0.2, draw.rng); });
}

// Bits of the pooled answers of ever more people: four of them are right in 1/2 + 1/8.
std::optional<Outcome> transferred(const BlockDesign& design, const StudyDraw& draw) {
  const IdentificationData data = of_different_people(design, draw);
  std::vector<analysis::CountTable> tables;
  for (const auto& person : data.participants) {
    tables.push_back(counts_of(data, person));
  }
  const double right = 0.625;
  const double bits =
      2.0 + right * std::log2(right) + (1.0 - right) * std::log2((1.0 - right) / (stimuli - 1.0));
  const auto interval = analysis::information_interval(tables);
  return interval ? std::optional{holds(*interval, bits)} : std::nullopt;
}
}  // namespace

std::vector<Row> rows_of_identification() {
  const auto design = std::make_shared<const BlockDesign>(design_of(false));
  return {
      of_guessers("right answers against chance", false, By::guessers, accuracy),
      of_guessers("the same, no stimulus three times running", true, By::guessers, accuracy),
      of_guessers("the same, some stop half way", false, By::guessers, accuracy,
                  Attendance::some_stop),
      of_guessers("one participant's right answers, 16 N trials", false, By::guessers,
                  accuracy_of_one),
      of_guessers("agreement in a factor", false, By::guessers, agreement_in_factor),
      of_guessers("answers depend on stimuli", false, By::guessers, dependence),
      of_guessers("information against guesses", false, By::guessers, information),
      of_guessers("contrast of a factor", false, By::guessers, contrast),
      of_guessers("the same, some stop half way", false, By::guessers, contrast,
                  Attendance::some_stop),
      of_guessers("learning", false, By::guessers, learning),
      of_guessers("effect of the trial before", false, By::people, previous_trial),
      of_guessers("answer of the trial before", false, By::people, repeated_answer),
      of_guessers("a class named more often than presented", false, By::people, naming),
      {Kind::coverage, "identification", "information, participants' shares right differ",
       By::people, [design](const StudyDraw& draw) { return transferred(*design, draw); }},
  };
}
}  // namespace tapstudy::bench
