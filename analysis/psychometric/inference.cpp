#include "analysis/psychometric/inference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/numerics.hpp"
#include "core/error.hpp"
#include "core/rng.hpp"
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
      const Maximum found = held_at(place, outside, inside.at);
      if (maximum_.log_likelihood - found.log_likelihood > drop_) {
        // from the last point, too, and from it alone: one function of the value while it is
        // searched
        const auto excess = [&](double value) {
          return maximum_.log_likelihood - held_at(place, value, inside.at).log_likelihood - drop_;
        };
        return root(excess, inside.at[place], outside);
      }
      inside = found;
      step *= 2.0;
    }
    return no_end;
  }

 private:
  Maximum held_at(Eigen::Index place, double value, const PsychometricVector& last) const {
    PsychometricBox held = box_;
    held.low[place] = held.high[place] = value;
    PsychometricVector of_maximum = maximum_.at;
    of_maximum[place] = value;
    return greatest(likelihood_, held, {of_maximum, last});
  }

  const BinomialLikelihood& likelihood_;
  const PsychometricBox& box_;
  const Maximum& maximum_;
  double drop_;
};

std::vector<Level> drawn_anew(const std::vector<Level>& levels, const std::vector<double>& p,
                              core::Rng& rng) {
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
  core::Rng rng{seed};
  int as_bad = 0;
  for (int draw = 0; draw < draws; ++draw) {
    // answers that fit exactly differ by rounding
    const PsychometricFit drawn = fit_psychometric(model, drawn_anew(checked, p, rng));
    as_bad += drawn.deviance >= fit.deviance - 1e-9 ? 1 : 0;
  }
  return {fit.deviance, (1.0 + as_bad) / (draws + 1.0), draws};
}

}  // namespace tapstudy::analysis
