#include "analysis/equality/equality_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "analysis/statistics/distributions.hpp"
#include "analysis/thresholds/comparison_level.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using results::AlternativeRow;
using results::AnswerRow;
constexpr double max_rate = 0.1;
constexpr int draws_of_fit = 200;
constexpr std::uint64_t test_seed = 1;

bool is_judged_greater(const BlockDesign& design, const AnswerRow& answer) {
  const auto named =
      std::ranges::find(answer.alternatives, answer.response, &AlternativeRow::label);
  if (named == answer.alternatives.end()) {
    throw core::InvalidInput{
        fmt::format("block '{}': '{}', the answer of {} to trial {}, names no "
                    "alternative",
                    design.name, answer.response, answer.participant_id, answer.number)};
  }
  return named->is_comparison != design.axis->is_smaller_asked;
}

// Half of the distance from F = 0.25 to F = 0.75 at this slope, which scales it.
double jnd_at(core::PsychometricShape shape, double slope) {
  return std::isinf(slope) ? 0.0
                           : 0.5 * (core::shape_quantile(shape, 0.75, 0.0, slope) -
                                    core::shape_quantile(shape, 0.25, 0.0, slope));
}

void estimate(ParticipantEquality& person, const BlockDesign& design) {
  const PsychometricModel model = equality_model(design);
  try {
    const PsychometricFit fit = fit_psychometric(model, person.levels);
    const auto curve = curve_with_threshold(model, person.levels, fit);
    if (!curve) {
      person.no_estimate = explanation(fit.outcome);
      return;
    }
    const PsychometricIntervals intervals = profile_intervals(model, person.levels);
    person.estimate = {
        *curve,
        intervals.threshold,
        fit.curve ? std::optional{jnd_at(model.shape, fit.curve->slope)} : std::nullopt,
        {jnd_at(model.shape, intervals.slope.high), intervals.slope.low > 0.0
                                                        ? jnd_at(model.shape, intervals.slope.low)
                                                        : std::numeric_limits<double>::infinity()},
        std::nullopt};
    if (!design.is_for_main_results) {
      person.estimate->goodness = deviance_test(model, person.levels, draws_of_fit, test_seed);
    }
  } catch (const core::NotEstimable& error) {  // too few levels
    person.no_estimate = error.what();
  }
}

void add_means(EqualityResults& results) {
  std::vector<double> equalities;
  std::vector<double> log_jnds;
  for (const ParticipantEquality& person : results.participants) {
    if (person.estimate) {
      equalities.push_back(person.estimate->curve.threshold);
      if (person.estimate->jnd) {
        log_jnds.push_back(std::log10(*person.estimate->jnd));
      }
    }
  }
  if (equalities.size() > 1) {
    results.equality = paired_contrast(equalities, test_seed);
  }
  if (log_jnds.size() > 1) {
    results.log_jnd = paired_contrast(log_jnds, test_seed);
  }
}
}  // namespace

PsychometricModel equality_model(const BlockDesign& design) {
  return {design.shape, {0.0, max_rate}, {0.0, max_rate}, Rates::equal};
}

EqualityResults equality_results(const BlockDesign& design, const std::vector<AnswerRow>& answers) {
  if (!design.axis) {
    throw core::InvalidInput{fmt::format("block '{}': has no axis", design.name)};
  }
  std::map<std::string, ParticipantEquality> people;
  for (const AnswerRow& answer : answers) {
    ParticipantEquality& person = people[answer.participant_id];
    person.participant_id = answer.participant_id;
    if (const auto level = comparison_level(design, answer)) {
      const bool is_greater = is_judged_greater(design, answer);
      count_at(person.levels, *level, is_greater);
      add_track_point(person.track, answer, *level, is_greater);
    }
  }
  EqualityResults results;
  for (auto& [name, person] : people) {
    estimate(person, design);
    results.participants.push_back(std::move(person));
  }
  add_means(results);
  return results;
}
}  // namespace tapstudy::analysis
