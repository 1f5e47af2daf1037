#include "analysis/statistics/psychometric/fit.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr int max_iterations = 300;
constexpr double most_damping = 1e12;

bool is_held(const PsychometricBox& box, const PsychometricVector& at,
             const PsychometricVector& score, Eigen::Index i) {
  return box.low[i] == box.high[i] || (at[i] <= box.low[i] && score[i] <= 0.0) ||
         (at[i] >= box.high[i] && score[i] >= 0.0);
}

// The information where held parameters are as if known: their rows and columns are those of 1.
Eigen::Matrix4d remove_fixed_parameters(const BinomialLikelihood::Slopes& slopes,
                                        const PsychometricBox& box, const PsychometricVector& at,
                                        PsychometricVector& score) {
  Eigen::Matrix4d information = slopes.information;
  score = slopes.score;
  for (Eigen::Index i = 0; i < 4; ++i) {
    if (is_held(box, at, slopes.score, i)) {
      information.row(i).setZero();
      information.col(i).setZero();
      information(i, i) = 1.0;
      score[i] = 0.0;
    }
  }
  return information;
}
}  // namespace

Maximum local_maximum(const BinomialLikelihood& likelihood, const PsychometricBox& box,
                      const PsychometricVector& start, double smallest_gain) {
  Maximum best{start.cwiseMax(box.low).cwiseMin(box.high), 0.0};
  best.log_likelihood = likelihood.value(best.at);
  double damping = 1e-3;
  for (int iteration = 0; iteration < max_iterations && damping < most_damping; ++iteration) {
    PsychometricVector score;
    Eigen::Matrix4d information =
        remove_fixed_parameters(likelihood.slopes(best.at), box, best.at, score);
    information.diagonal() *= 1.0 + damping;
    information.diagonal().array() += 1e-12;
    const PsychometricVector step = information.ldlt().solve(score);
    const PsychometricVector next = (best.at + step).cwiseMax(box.low).cwiseMin(box.high);
    const double value =
        next.allFinite() ? likelihood.value(next) : -std::numeric_limits<double>::infinity();
    if (value >= best.log_likelihood) {
      const double gain = value - best.log_likelihood;
      best = {next, value};
      if (gain < smallest_gain && damping < 1.0) {
        break;
      }
      damping = std::max(1e-9, 0.1 * damping);
    } else {
      damping = 10.0 * damping;
    }
  }
  return best;
}

namespace {
// How the score falls as each parameter grows.
Eigen::Matrix4d observed_information(const BinomialLikelihood& likelihood,
                                     const PsychometricVector& at) {
  constexpr double h = 1e-5;
  Eigen::Matrix4d information;
  for (Eigen::Index i = 0; i < 4; ++i) {
    const PsychometricVector ahead = likelihood.slopes(at + h * PsychometricVector::Unit(i)).score;
    const PsychometricVector behind = likelihood.slopes(at - h * PsychometricVector::Unit(i)).score;
    information.col(i) = (behind - ahead) / (2.0 * h);
  }
  return 0.5 * (information + information.transpose());
}
}  // namespace

// Newton's steps: those of Fisher's scoring may jump from one side of the maximum to the other.
Maximum refined(const BinomialLikelihood& likelihood, const PsychometricBox& box,
                const Maximum& rough) {
  PsychometricVector at = rough.at;
  constexpr int most_steps = 20;
  constexpr double shortest = 1e-12;
  double last_length = 1e-2;
  for (int i = 0; i < most_steps && last_length > shortest; ++i) {
    PsychometricVector score;
    const BinomialLikelihood::Slopes slopes{likelihood.slopes(at).score,
                                            observed_information(likelihood, at)};
    const Eigen::Matrix4d information = remove_fixed_parameters(slopes, box, at, score);
    const Eigen::LDLT<Eigen::Matrix4d> solver{information};
    const PsychometricVector step = solver.solve(score);
    if (!solver.isPositive() || !(step.norm() < last_length)) {
      break;
    }
    last_length = step.norm();
    at = (at + step).cwiseMax(box.low).cwiseMin(box.high);
  }
  return {at, likelihood.value(at)};
}

namespace {
constexpr double same_likelihood = 1e-6;  // differences of log-likelihoods below this are none

void check_rates(const PsychometricModel& model) {
  const auto is_range = [](const Interval& rate) {
    return 0.0 <= rate.low && rate.low <= rate.high;
  };
  if (!is_range(model.guess) || !is_range(model.lapse) ||
      !(model.guess.high + model.lapse.high < 1.0)) {
    throw core::InvalidInput{fmt::format(
        "ranges of guess and lapse rate are 0 <= low <= high, and the sum of both is below 1, not "
        "[{}, {}] and [{}, {}]",
        model.guess.low, model.guess.high, model.lapse.low, model.lapse.high)};
  }
}

// The best that a constant proportion within the rates' bounds can do.
double constant_log_likelihood(const PsychometricModel& model, const std::vector<Level>& levels) {
  Proportion all;
  for (const Level& level : levels) {
    all.successes += level.answers.successes;
    all.trials += level.answers.trials;
  }
  const double p = std::clamp(all.value(), model.guess.low, 1.0 - model.lapse.low);
  return binomial_log_likelihood(all, p);
}

// Two parameters take two levels that are neither at the foot nor at the top of the curve.
bool is_step(const BinomialLikelihood& likelihood, const PsychometricVector& at) {
  constexpr double end = 1e-4;
  return std::ranges::count_if(likelihood.shape_values(at),
                               [](double value) { return value > end && value < 1.0 - end; }) < 2;
}

FitOutcome outcome_of(const PsychometricModel& model, const BinomialLikelihood& likelihood,
                      const Maximum& maximum) {
  const auto all_of = [&](auto is_so) { return std::ranges::all_of(likelihood.levels(), is_so); };
  if (all_of([](const Level& level) { return level.answers.successes == level.answers.trials; })) {
    return FitOutcome::all_successes;
  }
  if (all_of([](const Level& level) { return level.answers.successes == 0; })) {
    return FitOutcome::no_successes;
  }
  if (maximum.log_likelihood - constant_log_likelihood(model, likelihood.levels()) <
      same_likelihood) {
    return FitOutcome::no_increase;
  }
  const AxisRange range = axis_range(likelihood.levels(), model.shape);
  if (maximum.at[threshold_at] < range.low) {
    return FitOutcome::threshold_below;
  }
  if (maximum.at[threshold_at] > range.high) {
    return FitOutcome::threshold_above;
  }
  return is_step(likelihood, maximum.at) ? FitOutcome::step : FitOutcome::fitted;
}

PsychometricCurve curve_of(const BinomialLikelihood& likelihood, const PsychometricVector& at) {
  return {from_axis(likelihood.shape(), at[threshold_at]), std::exp(at[log_slope_at]),
          likelihood.guess(at), at[lapse_at]};
}
}  // namespace

std::string_view explanation(FitOutcome outcome) {
  using enum FitOutcome;
  switch (outcome) {
    case fitted:
      return "a threshold was found";
    case all_successes:
      return "every answer is a success";
    case no_successes:
      return "no answer is a success";
    case no_increase:
      return "the answers do not increase with the value";
    case step:
      return "the answers change within one step between levels, so the slope is not determined";
    case threshold_below:
      return "the threshold is below the lowest level";
    case threshold_above:
      return "the threshold is above the highest level";
  }
  return "";
}

BinomialLikelihood likelihood_of(const PsychometricModel& model, const std::vector<Level>& levels) {
  return {model.shape, checked_levels(levels, model.shape), model.rates};
}

PsychometricBox search_box(const PsychometricModel& model, const std::vector<Level>& levels) {
  const AxisRange range = axis_range(levels, model.shape);
  const Interval guess = model.rates == Rates::equal ? Interval{0.0, 0.0} : model.guess;
  return {{range.low - 3.0 * range.length(), std::log(0.05 / range.length()), guess.low,
           model.lapse.low},
          {range.high + 3.0 * range.length(), std::log(50.0 / range.smallest_gap), guess.high,
           model.lapse.high}};
}

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

PsychometricVector likeliest_position(const BinomialLikelihood& likelihood,
                                      const PsychometricBox& box,
                                      const std::vector<double>& positions, double slope,
                                      double lapse) {
  Maximum best{{positions.front(), slope, box.low[guess_at], lapse},
               -std::numeric_limits<double>::infinity()};  // if impossible at every position
  const bool is_guess_free = box.low[guess_at] < box.high[guess_at];
  const std::vector<double> shares = is_guess_free ? std::vector{0.1, 0.5} : std::vector{0.0};
  for (const double position : positions) {
    for (const double share : shares) {
      const double guess = box.low[guess_at] + share * (box.high[guess_at] - box.low[guess_at]);
      const PsychometricVector at =
          PsychometricVector{position, slope, guess, lapse}.cwiseMax(box.low).cwiseMin(box.high);
      if (const double value = likelihood.value(at); !(value <= best.log_likelihood)) {
        best = {at, value};
      }
    }
  }
  return best.at;
}

// The likeliest start of each slope and lapse rate: each may have a maximum of its own.
std::vector<PsychometricVector> starts_of(const BinomialLikelihood& likelihood,
                                          const PsychometricBox& box) {
  const std::vector<double> positions = start_positions(likelihood, box);
  std::vector<PsychometricVector> starts;
  for (const double slope :
       start_slopes(axis_range(likelihood.levels(), likelihood.shape()), box)) {
    for (const double lapse : start_lapses(box)) {
      starts.push_back(likeliest_position(likelihood, box, positions, slope, lapse));
    }
  }
  return starts;
}
}  // namespace

Maximum global_maximum(const BinomialLikelihood& likelihood, const PsychometricBox& box,
                       const std::vector<PsychometricVector>& further_starts) {
  std::vector<PsychometricVector> starts = starts_of(likelihood, box);
  starts.insert(starts.end(), further_starts.begin(), further_starts.end());
  constexpr double rough_gain = 1e-6;  // tells the maxima apart; the greatest is climbed to the end
  Maximum best{starts.front(), -std::numeric_limits<double>::infinity()};
  for (const PsychometricVector& start : starts) {
    const Maximum found = local_maximum(likelihood, box, start, rough_gain);
    if (found.log_likelihood > best.log_likelihood) {
      best = found;
    }
  }
  return refined(likelihood, box, local_maximum(likelihood, box, best.at));
}

PsychometricFit fit_psychometric(const PsychometricModel& model, const std::vector<Level>& levels) {
  check_rates(model);
  const BinomialLikelihood likelihood = likelihood_of(model, levels);
  const PsychometricBox box = search_box(model, likelihood.levels());
  PsychometricFit fit;
  fit.maximum = global_maximum(likelihood, box);
  fit.outcome = outcome_of(model, likelihood, fit.maximum);
  fit.deviance = likelihood.deviance(fit.maximum.at);
  if (fit.outcome == FitOutcome::fitted) {
    fit.curve = curve_of(likelihood, fit.maximum.at);
  }
  return fit;
}
}  // namespace tapstudy::analysis
