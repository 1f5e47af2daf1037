#include "analysis/statistics/psychometric/maximum_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
namespace tapstudy::analysis {
namespace {
// Thinned out to so many, the ends among them.
std::vector<double> thinned(const std::vector<double>& all, std::size_t most) {
  if (all.size() <= most) {
    return all;
  }
  std::vector<double> some;
  for (std::size_t i = 0; i < most; ++i) {
    some.push_back(all[i * (all.size() - 1) / (most - 1)]);
  }
  return some;
}

// Starts lie at the levels and between them: a step there may be likelier than any gentle slope.
std::vector<double> start_positions(const BinomialLikelihood& likelihood,
                                    const PsychometricBox& box) {
  constexpr std::size_t most = 21;
  if (box.low[threshold_at] == box.high[threshold_at]) {
    return {box.low[threshold_at]};
  }
  std::vector<double> positions;
  for (const Level& level : likelihood.levels()) {
    const double at = on_axis(likelihood.shape(), level.value);
    if (!positions.empty()) {
      positions.push_back(0.5 * (positions.back() + at));
    }
    positions.push_back(at);
  }
  return thinned(positions, most);
}

std::vector<double> start_slopes(const AxisRange& range, const PsychometricBox& box) {
  if (box.low[log_slope_at] == box.high[log_slope_at]) {
    return {box.low[log_slope_at]};
  }
  constexpr int slopes_between = 8;
  const double gentlest = std::log(0.5 / range.length());
  const double steepest = std::log(50.0 / range.smallest_gap);
  std::vector<double> slopes;
  for (int i = 0; i <= slopes_between; ++i) {
    slopes.push_back(gentlest + i * (steepest - gentlest) / slopes_between);
  }
  return slopes;
}

std::vector<double> start_lapses(const PsychometricBox& box) {
  const double low = box.low[lapse_at];
  const double high = box.high[lapse_at];
  return low == high ? std::vector{low} : std::vector{low, 0.5 * (low + high), high};
}

// Impossible answers stay so, but have no effect where there are none of them: 0 times it is 0.
double log_of(double probability) {
  constexpr double least = 1e-300;
  return std::log(std::max(probability, least));
}

std::vector<double> start_guesses(const PsychometricBox& box) {
  const double low = box.low[guess_at];
  const double width = box.high[guess_at] - low;
  return width > 0.0 ? std::vector{low + 0.1 * width, low + 0.5 * width} : std::vector{low};
}

// From a rough maximum to the last digits of its place.
Maximum climbed_on(const BinomialLikelihood& likelihood, const PsychometricBox& box,
                   const Maximum& rough) {
  return refined(likelihood, box, local_maximum(likelihood, box, rough.at));
}

// The higher one of two that have met.
void add_if_apart(const Climb& climb, std::vector<Climb>& others) {
  constexpr double near = 1e-2;  // of a width of the function, and of a rate's range
  const auto met = std::ranges::find_if(others, [&](const Climb& other) {
    const PsychometricVector apart = climb.best().at - other.best().at;
    const double slope = std::exp(other.best().at[log_slope_at]);
    return std::abs(apart[threshold_at]) * slope < near && std::abs(apart[log_slope_at]) < near &&
           std::abs(apart[guess_at]) < 0.1 * near && std::abs(apart[lapse_at]) < 0.1 * near;
  });
  if (met == others.end()) {
    others.push_back(climb);
  } else if (climb.best().log_likelihood > met->best().log_likelihood) {
    *met = climb;
  }
}
}  // namespace

MaximumSearch::MaximumSearch(const BinomialLikelihood& likelihood, const PsychometricBox& box)
    : box_{box} {
  const std::vector<double> positions = start_positions(likelihood, box);
  const std::vector<double> slopes =
      start_slopes(axis_range(likelihood.levels(), likelihood.shape()), box);
  const std::vector<double> lapses = start_lapses(box);
  const std::vector<double> guesses = start_guesses(box);
  in_a_group_ = static_cast<Eigen::Index>(positions.size() * guesses.size());
  const auto points = in_a_group_ * static_cast<Eigen::Index>(slopes.size() * lapses.size());
  const auto levels = static_cast<Eigen::Index>(likelihood.levels().size());
  points_.reserve(static_cast<std::size_t>(points));
  log_success_.resize(points, levels);
  log_failure_.resize(points, levels);
  for (const double slope : slopes) {
    std::vector<std::vector<double>> shapes;
    for (const double position : positions) {
      const PsychometricVector at{position, slope, 0.0, 0.0};  // of a level 0 it is infinite
      shapes.push_back(likelihood.shape_values(inside(box, at)));
    }
    for (const double lapse : lapses) {
      for (std::size_t i = 0; i < positions.size(); ++i) {
        for (const double guess : guesses) {
          add({positions[i], slope, guess, lapse}, likelihood, shapes[i]);
        }
      }
    }
  }
}

void MaximumSearch::add(const PsychometricVector& at, const BinomialLikelihood& likelihood,
                        const std::vector<double>& shape_values) {
  const auto row = static_cast<Eigen::Index>(points_.size());
  const double guess = likelihood.guess(at);
  const double gain = 1.0 - guess - at[lapse_at];
  for (std::size_t i = 0; i < shape_values.size(); ++i) {
    const double p = guess + gain * shape_values[i];
    log_success_(row, static_cast<Eigen::Index>(i)) = log_of(p);
    log_failure_(row, static_cast<Eigen::Index>(i)) = log_of(1.0 - p);
  }
  points_.push_back(inside(box_, at));
}

std::vector<PsychometricVector> MaximumSearch::starts(const BinomialLikelihood& likelihood) const {
  const auto levels = static_cast<Eigen::Index>(likelihood.levels().size());
  Eigen::VectorXd successes{levels};
  Eigen::VectorXd failures{levels};
  for (Eigen::Index i = 0; i < levels; ++i) {
    const Proportion& answers = likelihood.levels()[static_cast<std::size_t>(i)].answers;
    successes[i] = static_cast<double>(answers.successes);
    failures[i] = static_cast<double>(answers.trials - answers.successes);
  }
  const Eigen::VectorXd values = log_success_ * successes + log_failure_ * failures;
  std::vector<PsychometricVector> starts;
  for (Eigen::Index group = 0; group < values.size(); group += in_a_group_) {
    Eigen::Index likeliest = 0;
    values.segment(group, in_a_group_).maxCoeff(&likeliest);
    starts.push_back(points_[static_cast<std::size_t>(group + likeliest)]);
  }
  return starts;
}

// Climbs that have met go on as one.
Maximum MaximumSearch::rough_maximum(const BinomialLikelihood& likelihood,
                                     const std::vector<PsychometricVector>& further_starts,
                                     double enough) const {
  constexpr double rough_gain = 1e-6;  // tells the maxima apart; the greatest is climbed to the end
  constexpr int steps_alone = 5;
  std::vector<PsychometricVector> all = further_starts;
  const std::vector<PsychometricVector> of_grid = starts(likelihood);
  all.insert(all.end(), of_grid.begin(), of_grid.end());
  Maximum best{all.front(), -std::numeric_limits<double>::infinity()};
  const auto is_enough = [&](const Climb& climb) {
    best = climb.best().log_likelihood > best.log_likelihood ? climb.best() : best;
    return best.log_likelihood > enough;
  };
  std::vector<Climb> apart;
  for (const PsychometricVector& start : all) {
    Climb climb{likelihood, box_, start, rough_gain};
    climb.advance(steps_alone);
    if (is_enough(climb)) {
      return best;
    }
    add_if_apart(climb, apart);
  }
  for (Climb& climb : apart) {
    climb.finish();
    if (is_enough(climb)) {
      break;
    }
  }
  return best;
}

Maximum MaximumSearch::maximum(const BinomialLikelihood& likelihood,
                               const std::vector<PsychometricVector>& further_starts) const {
  const Maximum rough =
      rough_maximum(likelihood, further_starts, std::numeric_limits<double>::infinity());
  return climbed_on(likelihood, box_, rough);
}

bool MaximumSearch::is_exceeded(const BinomialLikelihood& likelihood, double log_likelihood,
                                const PsychometricVector& start) const {
  const Maximum rough = rough_maximum(likelihood, {start}, log_likelihood);
  return rough.log_likelihood > log_likelihood ||
         climbed_on(likelihood, box_, rough).log_likelihood > log_likelihood;
}
}  // namespace tapstudy::analysis
