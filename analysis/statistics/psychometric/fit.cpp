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
constexpr double impossible = -std::numeric_limits<double>::infinity();

PsychometricVector inside(const PsychometricBox& box, const PsychometricVector& at) {
  return at.cwiseMax(box.low).cwiseMin(box.high);
}

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

// Fisher scoring with Levenberg's damping.
class Climb {
 public:
  Climb(const BinomialLikelihood& likelihood, const PsychometricBox& box,
        const PsychometricVector& start, double smallest_gain)
      : likelihood_{&likelihood},
        box_{&box},
        smallest_gain_{smallest_gain},
        at_{inside(box, start)},
        here_{likelihood.slopes(at_)} {}

  // So many steps, or as many as there are.
  void advance(int steps) {
    for (int i = 0; i < steps && !is_over_; ++i) {
      step();
    }
  }
  Maximum best() const { return {at_, here_.log_likelihood}; }

 private:
  void step() {
    constexpr double most_damping = 1e12;
    PsychometricVector score;
    Eigen::Matrix4d information = remove_fixed_parameters(here_, *box_, at_, score);
    information.diagonal() *= 1.0 + damping_;
    information.diagonal().array() += 1e-12;
    const PsychometricVector next = inside(*box_, at_ + information.ldlt().solve(score));
    const BinomialLikelihood::Slopes there =
        next.allFinite() ? likelihood_->slopes(next)
                         : BinomialLikelihood::Slopes{.log_likelihood = impossible};
    if (there.log_likelihood >= here_.log_likelihood) {
      const double gain = there.log_likelihood - here_.log_likelihood;
      is_over_ = gain < smallest_gain_ && damping_ < 1.0;
      at_ = next;
      here_ = there;
      damping_ = std::max(1e-9, 0.1 * damping_);
    } else {
      damping_ = 10.0 * damping_;
      is_over_ = !(damping_ < most_damping);
    }
  }

  const BinomialLikelihood* likelihood_;
  const PsychometricBox* box_;
  double smallest_gain_;
  PsychometricVector at_;
  BinomialLikelihood::Slopes here_;
  double damping_{1e-3};
  bool is_over_{false};
};
}  // namespace

Maximum local_maximum(const BinomialLikelihood& likelihood, const PsychometricBox& box,
                      const PsychometricVector& start, double smallest_gain) {
  Climb climb{likelihood, box, start, smallest_gain};
  climb.advance(max_iterations);
  return climb.best();
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
    BinomialLikelihood::Slopes slopes = likelihood.slopes(at);
    slopes.information = observed_information(likelihood, at);
    const Eigen::Matrix4d information = remove_fixed_parameters(slopes, box, at, score);
    const Eigen::LDLT<Eigen::Matrix4d> solver{information};
    const PsychometricVector step = solver.solve(score);
    if (!solver.isPositive() || !(step.norm() < last_length)) {
      break;
    }
    last_length = step.norm();
    at = inside(box, at + step);
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
  Maximum best{all.front(), impossible};
  const auto advance = [&](Climb& climb, int steps) {
    climb.advance(steps);
    best = climb.best().log_likelihood > best.log_likelihood ? climb.best() : best;
    return best.log_likelihood > enough;
  };
  std::vector<Climb> apart;
  for (const PsychometricVector& start : all) {
    Climb climb{likelihood, box_, start, rough_gain};
    if (advance(climb, steps_alone)) {
      return best;
    }
    add_if_apart(climb, apart);
  }
  for (Climb& climb : apart) {
    if (advance(climb, max_iterations)) {
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

PsychometricFit fit_psychometric(const PsychometricModel& model, const std::vector<Level>& levels) {
  check_rates(model);
  const BinomialLikelihood likelihood = likelihood_of(model, levels);
  const PsychometricBox box = search_box(model, likelihood.levels());
  PsychometricFit fit;
  fit.maximum = MaximumSearch{likelihood, box}.maximum(likelihood);
  fit.outcome = outcome_of(model, likelihood, fit.maximum);
  fit.deviance = likelihood.deviance(fit.maximum.at);
  if (fit.outcome == FitOutcome::fitted) {
    fit.curve = curve_of(likelihood, fit.maximum.at);
  }
  return fit;
}
}  // namespace tapstudy::analysis
