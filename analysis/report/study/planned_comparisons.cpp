#include "analysis/report/study/planned_comparisons.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>

#include "analysis/report/comparison.hpp"
#include "analysis/report/document/wording.hpp"
#include "analysis/report/study/groups.hpp"
#include "analysis/statistics/population/planned_contrasts.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;
constexpr std::uint64_t seed_of_signs = 1;

struct MeanOfAnswers {
  double sum{};
  int count{};
  double mean() const { return sum / count; }
};
// By participant, then by stimulus.
using MeansByStimulus = std::map<std::string, std::map<std::string, MeanOfAnswers>>;

// Right or wrong as 1 or 0, else the number that the answer is.
std::optional<double> value_of_answer(const AnswerRow& answer) {
  return answer.is_correct ? std::optional{*answer.is_correct ? 1.0 : 0.0}
                           : core::number_in<double>(answer.response);
}

// The one that was presented, or that stood beside a standard; empty: there were others.
std::string stimulus_of_answer(const AnswerRow& answer) {
  std::set<std::string> compared;
  for (const results::AlternativeRow& alternative : answer.alternatives) {
    if (alternative.is_comparison) {
      compared.insert(alternative.stimulus);
    }
  }
  return !answer.stimulus.empty() ? answer.stimulus
         : compared.size() == 1   ? *compared.begin()
                                  : std::string{};
}

MeansByStimulus means_by_stimulus(const std::vector<AnswerRow>& answers) {
  MeansByStimulus means;
  for (const AnswerRow& answer : answers) {
    if (const auto value = value_of_answer(answer)) {
      MeanOfAnswers& mean = means[answer.participant_id][stimulus_of_answer(answer)];
      mean.sum += *value;
      ++mean.count;
    }
  }
  return means;
}

HypothesisResult not_tested(const PlannedComparison& planned, const std::string& why) {
  return {planned.hypothesis, why, {}, 0.0, {}, 0.0};
}

HypothesisResult equivalence_of(const PlannedComparison& planned,
                                const std::vector<Interval>& differences, std::int64_t all,
                                bool is_ratio) {
  const std::int64_t ranges =
      std::ranges::count_if(differences, [](const Interval& one) { return one.low < one.high; });
  const std::string people = people_in_words(std::ssize(differences), all, ranges);
  if (differences.size() < 2) {
    return not_tested(planned, people + " with both values are too few");
  }
  const double bound = is_ratio ? std::log(planned.within) : planned.within;
  const EquivalenceTest test = equivalence_test(differences, bound);
  const auto shown = [&](double value) { return rounded(is_ratio ? std::exp(value) : value); };
  HypothesisResult result = not_tested(
      planned, fmt::format("two one-sided paired t tests{} against {} and {}; the larger p; {}",
                           ranges == 0 ? "" : " by the likelihood, with those beyond the levels,",
                           shown(-bound), shown(bound), people));
  result.p = test.p;
  result.finding =
      fmt::format("mean {} {}, 90 % CI {} to {}", is_ratio ? "ratio" : "difference",
                  shown(test.mean), shown(test.interval_90.low), shown(test.interval_90.high));
  return result;
}

HypothesisResult equivalent_stimuli(const PlannedComparison& planned,
                                    const MeansByStimulus& means) {
  std::vector<Interval> differences;
  for (const auto& [participant, of] : means) {
    const auto first = of.find(planned.hypothesis.stimulus);
    const auto second = of.find(planned.other_stimulus);
    if (first != of.end() && second != of.end()) {
      const double difference = first->second.mean() - second->second.mean();
      differences.push_back({difference, difference});
    }
  }
  return equivalence_of(planned, differences, std::ssize(means), false);
}

HypothesisResult equivalent_blocks(const PlannedComparison& planned,
                                   const std::optional<PersonalValues>& first,
                                   const std::optional<PersonalValues>& second) {
  if (!first || !second || first->measure != second->measure) {
    return not_tested(planned, "the blocks have no values of one measure");
  }
  if (first->is_ratio && planned.within <= 1.0) {
    return not_tested(planned, "their values are compared by ratios: `within` is to be above 1");
  }
  return equivalence_of(planned, differences_between(*first, *second),
                        number_in_both(*first, *second), first->is_ratio);
}

HypothesisResult contrast_result(const PlannedComparison& planned, const PairedContrast& contrast,
                                 const PersonalValues& values, std::int64_t all,
                                 const std::string& against) {
  HypothesisResult result = not_tested(
      planned, fmt::format("permutation test by signs of participants' {} against {}, {}; {}",
                           values.is_ratio ? "logarithms of ratios" : "differences", against,
                           planned.below ? "one-sided" : "two-sided",
                           people_in_words(contrast.participants, all, contrast.ranges)));
  result.p = contrast.p;
  result.finding = contrast_in_words(contrast.mean, contrast.interval, values.is_ratio);
  return result;
}

HypothesisResult different_blocks(const PlannedComparison& planned,
                                  const std::optional<PersonalValues>& first,
                                  const std::optional<PersonalValues>& second) {
  if (!first || !second || first->measure != second->measure) {
    return not_tested(planned, "the blocks have no values of one measure");
  }
  const auto contrast = contrast_of(*first, *second);
  return contrast ? contrast_result(planned, *contrast, *first, number_in_both(*first, *second),
                                    "those of " + planned.other_block)
                  : not_tested(planned, "fewer than two participants have values of both");
}

// By symmetry of the signs, the probability on one side is half of that on both.
HypothesisResult below_level(const PlannedComparison& planned,
                             const std::optional<PersonalValues>& values) {
  const auto contrast = values ? contrast_with(*values, *planned.below) : std::nullopt;
  if (!contrast) {
    return not_tested(planned, "fewer than two participants have values");
  }
  HypothesisResult result =
      contrast_result(planned, *contrast, *values, std::ssize(participants_of(*values)),
                      fmt::format("{}", rounded(*planned.below)));
  result.p = contrast->direction < 0.0 ? 0.5 * contrast->p : 1.0 - 0.5 * contrast->p;
  return result;
}

// The stimuli of each combination of levels: rows of the first factor, columns of the second.
using StimuliOfCells = std::vector<std::vector<std::vector<std::string>>>;

StimuliOfCells stimuli_of_cells(const BlockDesign& design, const PlannedComparison& planned) {
  std::vector<std::string> rows;
  std::vector<std::string> columns;
  const auto place_of = [](std::vector<std::string>& levels, const std::string& level) {
    const auto found = std::ranges::find(levels, level);
    if (found == levels.end()) {
      levels.push_back(level);
      return levels.size() - 1;
    }
    return static_cast<std::size_t>(found - levels.begin());
  };
  StimuliOfCells cells;
  for (const Item& stimulus : design.stimuli) {
    const std::size_t row = place_of(rows, stimulus.factors.at(planned.factors[0]));
    const std::size_t column = place_of(columns, stimulus.factors.at(planned.factors[1]));
    cells.resize(std::max(cells.size(), row + 1));
    for (auto& of_row : cells) {
      of_row.resize(columns.size());
    }
    cells[row][column].push_back(stimulus.name);
  }
  return cells;
}

// One person's mean of each cell, each stimulus of it counting the same; unset where one is
// missing.
std::optional<LevelTable> table_of_person(const std::map<std::string, MeanOfAnswers>& of,
                                          const StimuliOfCells& cells) {
  LevelTable table;
  for (const auto& row : cells) {
    table.emplace_back();
    for (const std::vector<std::string>& stimuli : row) {
      MeanOfAnswers mean;
      for (const std::string& name : stimuli) {
        const auto answered = of.find(name);
        if (answered == of.end()) {
          return std::nullopt;
        }
        mean.sum += answered->second.mean();
        ++mean.count;
      }
      table.back().push_back(mean.mean());
    }
  }
  return table;
}

HypothesisResult interaction_of_factors(const PlannedComparison& planned, const BlockDesign& design,
                                        const MeansByStimulus& means, bool has_right_answers) {
  const StimuliOfCells cells = stimuli_of_cells(design, planned);
  std::vector<LevelTable> tables;
  for (const auto& [participant, of] : means) {
    if (auto table = table_of_person(of, cells)) {
      tables.push_back(std::move(*table));
    }
  }
  if (tables.size() < 2) {
    return not_tested(planned, fmt::format("{} with all values are too few",
                                           people_in_words(std::ssize(tables), std::ssize(means))));
  }
  const InteractionTest test = interaction_test(tables, seed_of_signs);
  const char* const scale = has_right_answers ? "shares of right answers" : "mean ratings";
  HypothesisResult result = not_tested(
      planned, fmt::format("{}permutation test by signs of participants' interactions of {} and "
                           "{}, two-sided, on the scale of {}; {}",
                           test.is_exact ? "exact " : "", planned.factors[0], planned.factors[1],
                           scale, people_in_words(std::ssize(tables), std::ssize(means))));
  result.p = test.p;
  result.finding = fmt::format("interaction of {} and {}, F({:g}, {:g}) = {}", planned.factors[0],
                               planned.factors[1], test.numerator_freedom, test.denominator_freedom,
                               rounded(test.f));
  return result;
}

using Blocks = std::vector<std::shared_ptr<BlockSummary>>;

std::optional<PersonalValues> values_of(const std::string& name, const Blocks& blocks) {
  const auto found =
      std::ranges::find_if(blocks, [&](const auto& block) { return block->block == name; });
  return found == blocks.end() ? std::nullopt : (*found)->personal;
}

// What a block's comparisons are tested on.
struct Compared {
  const std::vector<AnswerRow>& answers;
  const BlockSummary& summary;
  const Blocks& blocks;
  const std::vector<ParticipantGroup>& groups;
};

HypothesisResult result_of(const PlannedComparison& planned, const BlockDesign& design,
                           const Compared& of) {
  try {
    if (!design.premise.empty()) {
      return not_tested(planned, design.premise);
    }
    if (!planned.groups.empty() && !of.summary.part_of.empty()) {
      return not_tested(planned,
                        "the block is reported at each value of its further axes, and has "
                        "no value a participant as a whole");
    }
    if (!planned.groups.empty()) {
      return compare_groups(planned, of.summary, of.groups);
    }
    if (planned.below) {
      return below_level(planned, values_of(design.name, of.blocks));
    }
    if (!planned.other_block.empty()) {
      const auto compare = planned.within > 0.0 ? equivalent_blocks : different_blocks;
      return compare(planned, values_of(design.name, of.blocks),
                     values_of(planned.other_block, of.blocks));
    }
    const MeansByStimulus means = means_by_stimulus(of.answers);
    return planned.factors.empty()
               ? equivalent_stimuli(planned, means)
               : interaction_of_factors(planned, design, means,
                                        of.answers.front().is_correct.has_value());
  } catch (const core::NotEstimable& error) {
    return not_tested(planned, error.what());
  }
}
}  // namespace

void add_planned_comparisons(const StudyDesign& design,
                             const std::map<std::string, std::vector<AnswerRow>>& answers,
                             const Blocks& blocks) {
  for (const BlockDesign& block : design.blocks) {
    const auto own = answers.find(block.name);
    const auto summary = std::ranges::find_if(blocks, [&](const auto& each) {
      return each->block == block.name || each->part_of == block.name;
    });
    if (own == answers.end() || summary == blocks.end()) {
      continue;
    }
    for (const PlannedComparison& planned : block.comparisons) {
      (*summary)->hypotheses.push_back(
          result_of(planned, block, {own->second, **summary, blocks, design.groups}));
    }
  }
}
}  // namespace tapstudy::analysis
