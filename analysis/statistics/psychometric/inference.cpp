#include "analysis/statistics/psychometric/inference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/numerics.hpp"
#include "analysis/statistics/psychometric/likelihood.hpp"
#include "analysis/statistics/psychometric/maximum_search.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();

void check_confidence(double confidence) {
  if (!(confidence > 0.0 && confidence < 1.0)) {
    throw core::InvalidInput{fmt::format("a confidence is between 0 and 1, not {}", confidence)};
  }
}

PsychometricFit fit_with_threshold(const PsychometricModel& model,
                                   const std::vector<Level>& levels) {
  PsychometricFit fit = fit_psychometric(model, levels);
  if (!fit.curve && fit.outcome != FitOutcome::step) {
    throw core::NotEstimable{
        fmt::format("there is no interval without a threshold: {}", explanation(fit.outcome))};
  }
  return fit;
}

// One end of an interval of one parameter, searched from the maximum outwards.
class Profile {
 public:
  Profile(const BinomialLikelihood& likelihood, const PsychometricBox& box, const Maximum& maximum,
          double drop)
      : likelihood_{likelihood}, box_{box}, maximum_{maximum}, drop_{drop} {}

  double end(Eigen::Index place, double first_step, double no_end) const {
    const double limit = first_step > 0.0 ? box_.high[place] : box_.low[place];
    Maximum inside = maximum_;
    double step = first_step;
    while (inside.at[place] != limit) {
      const double outside = first_step > 0.0 ? std::min(limit, inside.at[place] + step)
                                              : std::max(limit, inside.at[place] + step);
      const Maximum found = profile_at(place, outside, inside.at);
      if (maximum_.log_likelihood - found.log_likelihood > drop_) {
        // from the last point, too, and from it alone: one function of the value while it is
        // searched
        const auto excess = [&](double value) {
          return maximum_.log_likelihood - profile_at(place, value, inside.at).log_likelihood -
                 drop_;
        };
        return root(excess, inside.at[place], outside);
      }
      inside = found;
      step *= 2.0;
    }
    return no_end;
  }

 private:
  Maximum profile_at(Eigen::Index place, double value, const PsychometricVector& last) const {
    PsychometricBox held = box_;
    held.low[place] = held.high[place] = value;
    PsychometricVector of_maximum = maximum_.at;
    of_maximum[place] = value;
    return MaximumSearch{likelihood_, held}.maximum(likelihood_, {of_maximum, last});
  }

  const BinomialLikelihood& likelihood_;
  const PsychometricBox& box_;
  const Maximum& maximum_;
  double drop_;
};

std::vector<Level> parametric_bootstrap_sample(const std::vector<Level>& levels,
                                               const std::vector<double>& p, core::Rng& rng) {
  std::vector<Level> drawn = levels;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    drawn[i].answers.successes = 0;
    for (std::int64_t trial = 0; trial < drawn[i].answers.trials; ++trial) {
      drawn[i].answers.successes += rng.uniform() < p[i] ? 1 : 0;
    }
  }
  return drawn;
}
}  // namespace

PsychometricIntervals profile_intervals(const PsychometricModel& model,
                                        const std::vector<Level>& levels, double confidence) {
  check_confidence(confidence);
  const PsychometricFit fit = fit_with_threshold(model, levels);
  const BinomialLikelihood likelihood = likelihood_of(model, levels);
  const PsychometricBox box = search_box(model, likelihood.levels());
  const Profile profile{likelihood, box, fit.maximum, 0.5 * chi_squared_quantile(confidence, 1.0)};
  const double step = 0.1 * axis_range(likelihood.levels(), model.shape).length();
  return {{from_axis(model.shape, profile.end(threshold_at, -step, -infinity)),
           from_axis(model.shape, profile.end(threshold_at, step, infinity))},
          {std::exp(profile.end(log_slope_at, -0.1, -infinity)),
           std::exp(profile.end(log_slope_at, 0.1, infinity))}};
}

std::optional<PsychometricCurve> curve_with_threshold(const PsychometricModel& model,
                                                      const std::vector<Level>& levels,
                                                      const PsychometricFit& fit) {
  constexpr double as_likely = 1e-3;
  if (fit.outcome != FitOutcome::step) {
    return fit.curve;
  }
  const BinomialLikelihood likelihood = likelihood_of(model, levels);
  const PsychometricBox box = search_box(model, likelihood.levels());
  const Profile profile{likelihood, box, fit.maximum, as_likely};
  const double step = 0.1 * axis_range(likelihood.levels(), model.shape).length();
  const double low = profile.end(threshold_at, -step, box.low[threshold_at]);
  const double high = profile.end(threshold_at, step, box.high[threshold_at]);
  return PsychometricCurve{from_axis(model.shape, 0.5 * (low + high)),
                           std::exp(box.high[log_slope_at]), likelihood.guess(fit.maximum.at),
                           fit.maximum.at[lapse_at]};
}

GoodnessOfFit deviance_test(const PsychometricModel& model, const std::vector<Level>& levels,
                            int draws, std::uint64_t seed) {
  const PsychometricFit fit = fit_psychometric(model, levels);
  if (draws < 1) {
    throw core::InvalidInput{fmt::format("a bootstrap takes 1 draw or more, not {}", draws)};
  }
  const std::vector<Level> checked = checked_levels(levels, model.shape);
  const BinomialLikelihood likelihood{model.shape, checked, model.rates};
  const std::vector<double> p = likelihood.proportions(fit.maximum.at);
  constexpr double rounding = 1e-9;  // answers that fit exactly differ by it
  const MaximumSearch search{likelihood, search_box(model, checked)};
  core::Rng rng{seed};
  int as_bad = 0;
  for (int draw = 0; draw < draws; ++draw) {
    const BinomialLikelihood drawn{model.shape, parametric_bootstrap_sample(checked, p, rng),
                                   model.rates};
    const double as_likely = drawn.saturated() - 0.5 * (fit.deviance - rounding);
    as_bad += search.is_exceeded(drawn, as_likely, fit.maximum.at) ? 0 : 1;
  }
  return {fit.deviance, (1.0 + as_bad) / (draws + 1.0), draws};
}

namespace {
// 1 at 0, 0 from 1 on.
double raised_cosine(double along) {
  return along >= 1.0 ? 0.0 : 0.5 * (1.0 + std::cos(std::numbers::pi * std::max(0.0, along)));
}

double log_sum_of(const std::vector<double>& logarithms) {
  const double most = *std::ranges::max_element(logarithms);
  double sum = 0.0;
  for (const double one : logarithms) {
    sum += std::exp(one - most);
  }
  return most + std::log(sum);
}

Eigen::ArrayXd etas_of(const GridAxis& axis) {
  Eigen::ArrayXd etas{static_cast<Eigen::Index>(axis.cells)};
  for (Eigen::Index i = 0; i < etas.size(); ++i) {
    etas[i] = axis.centre(static_cast<std::size_t>(i));
  }
  return etas;
}

class Grid {
 public:
  Grid(const PosteriorAxes& axes, const PsychometricModel& model, const std::vector<Level>& levels,
       double breadth)
      : axes_{axes},
        model_{model},
        levels_{levels},
        range_{axis_range(levels, model.shape)},
        breadth_{breadth},
        likelihood_{levels, etas_of(axes[eta_at])},
        p_(levels.size()) {}

  Marginals marginals() {
    add_all();
    return summed();
  }

  // ln of the mean likelihood over the prior, as far as the grid's cells go.
  double log_evidence() {
    add_all();
    return log_sum_of(log_densities_) - log_sum_of(log_priors_);
  }

 private:
  void add_all() {
    for (std::size_t t = 0; t < axes_[position_at].cells; ++t) {
      for (std::size_t w = 0; w < axes_[log_width_at].cells; ++w) {
        add_curves(axes_[position_at].centre(t), axes_[log_width_at].centre(w));
      }
    }
  }

  void add_curves(double position, double log_width) {
    const double width = std::exp(log_width);
    // ln width is the coordinate: its density is that of the width times the width
    const double log_prior = log_prior_of_position(position, range_, breadth_) +
                             log_prior_of_width(width, range_, breadth_) + log_width;
    const double slope = width_of_unit_slope(model_.shape) / width;
    std::vector<double> shape_values;
    for (const Level& level : levels_) {
      shape_values.push_back(
          core::shape_value(model_.shape, level.value, from_axis(model_.shape, position), slope));
    }
    for (std::size_t g = 0; g < axes_[guess_rate_at].cells; ++g) {
      for (std::size_t l = 0; l < axes_[lapse_rate_at].cells; ++l) {
        add_dispersions(axes_[guess_rate_at].centre(g), axes_[lapse_rate_at].centre(l), log_prior,
                        shape_values);
      }
    }
  }

  void add_dispersions(double guess, double lapse, double log_prior,
                       const std::vector<double>& shape_values) {
    const double log_prior_of_rates = log_prior_of_rate(guess) + log_prior_of_rate(lapse);
    for (std::size_t i = 0; i < levels_.size(); ++i) {
      p_[i] = guess + (1.0 - guess - lapse) * shape_values[i];
    }
    const Eigen::ArrayXd& log_likelihoods = likelihood_.log_likelihoods(p_);
    for (std::size_t e = 0; e < axes_[eta_at].cells; ++e) {
      const double log_density =
          log_prior + log_prior_of_rates + log_prior_of_rate(axes_[eta_at].centre(e));
      log_priors_.push_back(log_density);
      log_densities_.push_back(log_density + log_likelihoods[static_cast<Eigen::Index>(e)]);
    }
  }

  // The densities lie in the order of the axes, the last one, eta, fastest.
  Marginals summed() const {
    const Eigen::Map<const Eigen::ArrayXd> logs{log_densities_.data(),
                                                static_cast<Eigen::Index>(log_densities_.size())};
    const double greatest = logs.maxCoeff();
    Marginals marginals;
    for (std::size_t axis = 0; axis < posterior_parameters; ++axis) {
      marginals[axis].assign(axes_[axis].cells, 0.0);
    }
    const auto etas = static_cast<Eigen::Index>(axes_[eta_at].cells);
    Eigen::Map<Eigen::ArrayXd> of_eta{marginals[eta_at].data(), etas};
    double total = 0.0;
    for (Eigen::Index first = 0; first < logs.size(); first += etas) {
      const Eigen::ArrayXd densities = (logs.segment(first, etas) - greatest).exp();
      of_eta += densities;
      const double sum = densities.sum();
      total += sum;
      auto rest = static_cast<std::size_t>(first / etas);
      for (std::size_t axis = eta_at; axis-- > 0;) {
        marginals[axis][rest % axes_[axis].cells] += sum;
        rest /= axes_[axis].cells;
      }
    }
    for (std::vector<double>& marginal : marginals) {
      for (double& probability : marginal) {
        probability /= total;
      }
    }
    return marginals;
  }

  const PosteriorAxes& axes_;
  const PsychometricModel& model_;
  const std::vector<Level>& levels_;
  AxisRange range_;
  double breadth_;
  BetaBinomialLikelihood likelihood_;
  std::vector<double> p_;  // of each level
  std::vector<double> log_densities_;
  std::vector<double> log_priors_;
};
}  // namespace

double log_prior_of_position(double position, const AxisRange& range, double breadth) {
  const double outside = std::max({0.0, range.low - position, position - range.high});
  return std::log(raised_cosine(outside / (0.5 * breadth * range.length())));
}

double log_prior_of_width(double width, const AxisRange& range, double breadth) {
  const double gap = range.smallest_gap;
  const double broad = breadth * range.length();
  return std::log(raised_cosine((2.0 * gap - width) / gap)) +
         std::log(raised_cosine((width - broad) / (2.0 * broad)));
}

double log_prior_of_rate(double rate) {
  return 9.0 * std::log1p(-rate);  // beta(1, 10)
}

double width_of_unit_slope(core::PsychometricShape shape) {
  const auto position_of = [&](double value) {
    return on_axis(shape, core::shape_quantile(shape, value, 1.0, 1.0));
  };
  return position_of(0.95) - position_of(0.05);
}

PosteriorAxes prior_axes(const PsychometricModel& model, const std::vector<Level>& levels,
                         double breadth) {
  constexpr std::array<std::size_t, posterior_parameters> cells{16, 16, 4, 4, 10};
  const AxisRange range = axis_range(levels, model.shape);
  const double outside = 0.5 * breadth * range.length();
  PosteriorAxes axes{GridAxis{range.low - outside, range.high + outside},
                     GridAxis{std::log(range.smallest_gap), std::log(6.0 * outside)},
                     GridAxis{model.guess.low, model.guess.high},
                     GridAxis{model.lapse.low, model.lapse.high}, GridAxis{0.0, 1.0}};
  for (std::size_t place = 0; place < posterior_parameters; ++place) {
    const bool is_free = axes[place].low < axes[place].high;
    axes[place].cells = is_free ? cells[place] : 1;
  }
  return axes;
}

Marginals marginals_on(const PosteriorAxes& axes, const PsychometricModel& model,
                       const std::vector<Level>& levels, double breadth) {
  return Grid{axes, model, levels, breadth}.marginals();
}

namespace {
// The axis from the first to the last cell that is not negligible, and one further on either side.
GridAxis narrowed(const GridAxis& axis, const std::vector<double>& marginal) {
  const double negligible = 1e-5 * *std::ranges::max_element(marginal);
  const auto is_kept = [&](double probability) { return probability > negligible; };
  const auto first = std::ranges::find_if(marginal, is_kept) - marginal.begin();
  const auto last =
      std::find_if(marginal.rbegin(), marginal.rend(), is_kept).base() - marginal.begin();
  return {std::max(axis.low, axis.low + static_cast<double>(first - 1) * axis.cell()),
          std::min(axis.high, axis.low + static_cast<double>(last + 1) * axis.cell()), axis.cells};
}

// Each cell's probability lies evenly in it.
double quantile_on(const GridAxis& axis, const std::vector<double>& marginal, double probability) {
  double below = 0.0;
  for (std::size_t i = 0; i < marginal.size(); ++i) {
    if (below + marginal[i] >= probability) {
      const double along = marginal[i] > 0.0 ? (probability - below) / marginal[i] : 0.0;
      return axis.low + (static_cast<double>(i) + along) * axis.cell();
    }
    below += marginal[i];
  }
  return axis.high;
}

Marginal summary(const GridAxis& axis, const std::vector<double>& marginal, double confidence) {
  Marginal result;
  for (std::size_t i = 0; i < marginal.size(); ++i) {
    result.mean += marginal[i] * axis.centre(i);
  }
  double variance = 0.0;
  for (std::size_t i = 0; i < marginal.size(); ++i) {
    variance += marginal[i] * std::pow(axis.centre(i) - result.mean, 2.0);
  }
  result.standard_deviation = std::sqrt(variance);
  for (std::size_t i = 0; axis.cells > 1 && i < marginal.size(); ++i) {
    result.at.push_back(axis.centre(i));
    result.density.push_back(marginal[i] / axis.cell());
  }
  result.median = quantile_on(axis, marginal, 0.5);
  result.credible = {quantile_on(axis, marginal, 0.5 * (1.0 - confidence)),
                     quantile_on(axis, marginal, 0.5 * (1.0 + confidence))};
  return result;
}

// Of answers that are guesses at every level against those with a threshold.
double guessing(const PsychometricModel& model, const std::vector<Level>& levels, double breadth) {
  const PosteriorAxes axes = prior_axes(model, levels, breadth);
  const GridAxis& guesses = axes[guess_rate_at];
  Proportion all;
  for (const Level& level : levels) {
    all.successes += level.answers.successes;
    all.trials += level.answers.trials;
  }
  std::vector<double> logarithms;
  std::vector<double> priors;
  for (std::size_t i = 0; i < guesses.cells; ++i) {
    priors.push_back(log_prior_of_rate(guesses.centre(i)));
    logarithms.push_back(priors.back() + binomial_log_likelihood(all, guesses.centre(i)));
  }
  const double of_guesses = log_sum_of(logarithms) - log_sum_of(priors);
  const double of_threshold = Grid{axes, model, levels, breadth}.log_evidence();
  return 1.0 / (1.0 + std::exp(of_threshold - of_guesses));
}

PosteriorEstimates estimates_of(const PsychometricModel& model, const std::vector<Level>& levels,
                                double confidence, double breadth) {
  constexpr int narrowings = 3;
  PosteriorAxes axes = prior_axes(model, levels, breadth);
  Marginals marginals = marginals_on(axes, model, levels, breadth);
  for (int narrowing = 1; narrowing <= narrowings; ++narrowing) {
    for (std::size_t axis = 0; axis < posterior_parameters; ++axis) {
      axes[axis] = narrowed(axes[axis], marginals[axis]);
      const bool is_last = narrowing == narrowings && axes[axis].cells > 1;
      axes[axis].cells *= is_last ? 2 : 1;
    }
    marginals = marginals_on(axes, model, levels, breadth);
  }
  const auto at = [&](std::size_t axis) {
    return summary(axes[axis], marginals[axis], confidence);
  };
  PosteriorEstimates result{at(position_at),
                            at(log_width_at),
                            at(guess_rate_at),
                            at(lapse_rate_at),
                            at(eta_at),
                            0.0,
                            {},
                            0.0,
                            {},
                            guessing(model, levels, breadth)};
  const auto value_at = [&](double position) { return from_axis(model.shape, position); };
  const auto slope_at = [&](double log_width) {
    return width_of_unit_slope(model.shape) / std::exp(log_width);
  };
  const Interval& position = result.position.credible;
  result.threshold = value_at(result.position.median);
  result.threshold_interval = {value_at(position.low), result.guessing > 0.5 * (1.0 - confidence)
                                                           ? infinity
                                                           : value_at(position.high)};
  result.slope = slope_at(result.log_width.median);
  result.slope_interval = {slope_at(result.log_width.credible.high),
                           slope_at(result.log_width.credible.low)};
  return result;
}
}  // namespace

PsychometricPosterior psychometric_posterior(const PsychometricModel& model,
                                             const std::vector<Level>& levels, double confidence,
                                             double breadth) {
  if (!(confidence > 0.0 && confidence < 1.0)) {
    throw core::InvalidInput{fmt::format("a confidence is between 0 and 1, not {}", confidence)};
  }
  PsychometricPosterior posterior;
  posterior.outcome = fit_psychometric(model, levels).outcome;
  if (posterior.outcome == FitOutcome::step) {
    posterior.outcome = FitOutcome::fitted;
  }
  if (posterior.outcome != FitOutcome::fitted) {
    return posterior;
  }
  posterior.estimates =
      estimates_of(model, checked_levels(levels, model.shape), confidence, breadth);
  return posterior;
}
}  // namespace tapstudy::analysis
