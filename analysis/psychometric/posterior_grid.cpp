#include "analysis/psychometric/posterior_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "analysis/psychometric/beta_binomial.hpp"
namespace tapstudy::analysis {
namespace {
// 1 at 0, 0 from 1 on.
double raised_cosine(double along) {
  return along >= 1.0 ? 0.0 : 0.5 * (1.0 + std::cos(std::numbers::pi * std::max(0.0, along)));
}

class Grid {
 public:
  Grid(const PosteriorAxes& axes, const PsychometricModel& model, const std::vector<Level>& levels)
      : axes_{axes}, model_{model}, levels_{levels}, range_{axis_range(levels, model.shape)} {}

  Marginals marginals() {
    for (std::size_t t = 0; t < axes_[position_at].cells; ++t) {
      for (std::size_t w = 0; w < axes_[log_width_at].cells; ++w) {
        add_curves(axes_[position_at].centre(t), axes_[log_width_at].centre(w));
      }
    }
    return summed();
  }

 private:
  void add_curves(double position, double log_width) {
    const double width = std::exp(log_width);
    // ln width is the coordinate: its density is that of the width times the width
    const double log_prior =
        log_prior_of_position(position, range_) + log_prior_of_width(width, range_) + log_width;
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
    for (std::size_t e = 0; e < axes_[eta_at].cells; ++e) {
      const double eta = axes_[eta_at].centre(e);
      double log_density = log_prior + log_prior_of_rates + log_prior_of_rate(eta);
      for (std::size_t i = 0; i < levels_.size(); ++i) {
        const double p = guess + (1.0 - guess - lapse) * shape_values[i];
        log_density += beta_binomial_log_likelihood(levels_[i].answers, p, eta);
      }
      log_densities_.push_back(log_density);
    }
  }

  // The densities lie in the order of the axes, the last one fastest.
  Marginals summed() const {
    const double greatest = *std::ranges::max_element(log_densities_);
    Marginals marginals;
    for (std::size_t axis = 0; axis < posterior_parameters; ++axis) {
      marginals[axis].assign(axes_[axis].cells, 0.0);
    }
    double total = 0.0;
    for (std::size_t place = 0; place < log_densities_.size(); ++place) {
      const double density = std::exp(log_densities_[place] - greatest);
      total += density;
      std::size_t rest = place;
      for (std::size_t axis = posterior_parameters; axis-- > 0;) {
        marginals[axis][rest % axes_[axis].cells] += density;
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
  std::vector<double> log_densities_;
};
}  // namespace

double log_prior_of_position(double position, const AxisRange& range) {
  const double outside = std::max({0.0, range.low - position, position - range.high});
  return std::log(raised_cosine(outside / (0.5 * range.length())));
}

double log_prior_of_width(double width, const AxisRange& range) {
  const double gap = range.smallest_gap;
  return std::log(raised_cosine((2.0 * gap - width) / gap)) +
         std::log(raised_cosine((width - range.length()) / (2.0 * range.length())));
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

PosteriorAxes prior_axes(const PsychometricModel& model, const std::vector<Level>& levels) {
  constexpr std::array<std::size_t, posterior_parameters> cells{16, 16, 4, 4, 10};
  const AxisRange range = axis_range(levels, model.shape);
  PosteriorAxes axes{GridAxis{range.low - 0.5 * range.length(), range.high + 0.5 * range.length()},
                     GridAxis{std::log(range.smallest_gap), std::log(3.0 * range.length())},
                     GridAxis{model.guess.low, model.guess.high},
                     GridAxis{model.lapse.low, model.lapse.high}, GridAxis{0.0, 1.0}};
  for (std::size_t place = 0; place < posterior_parameters; ++place) {
    const bool is_free = axes[place].low < axes[place].high;
    axes[place].cells = is_free ? cells[place] : 1;
  }
  return axes;
}

Marginals marginals_on(const PosteriorAxes& axes, const PsychometricModel& model,
                       const std::vector<Level>& levels) {
  return Grid{axes, model, levels}.marginals();
}
}  // namespace tapstudy::analysis
