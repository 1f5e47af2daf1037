#include "analysis/modal_identification/spring_update.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/numerics.hpp"
namespace tapstudy::analysis {
namespace {
constexpr int decades_each_way = 2;
constexpr int solutions_per_decade = 4;
constexpr int between_solutions = 10;
constexpr std::size_t fewest_modes = 3;
constexpr double derivative_step = 0.01;  // of the logarithm of springs / E

// Between solutions, in ln(springs / E).
double step_log() {
  return std::log(10.0) / solutions_per_decade;
}

// Of ln(springs / E), relative to what was stated.
class Profile {
 public:
  Profile(const std::vector<Estimate>& measured_hz, const FrequenciesOnSprings& frequencies_hz)
      : measured_hz_{measured_hz}, frequencies_hz_{frequencies_hz} {}

  std::vector<double> model_hz(double log_factor) const {
    return frequencies_hz_(std::exp(log_factor));
  }
  double squares(const std::vector<double>& model_hz) const {
    return match_cost(measured_hz_, model_hz);
  }

 private:
  const std::vector<Estimate>& measured_hz_;
  const FrequenciesOnSprings& frequencies_hz_;
};

// Logarithms of frequencies go over into one another evenly.
std::vector<double> interpolated(const std::vector<double>& low_hz,
                                 const std::vector<double>& high_hz, double share) {
  std::vector<double> between_hz;
  for (std::size_t i = 0; i < std::min(low_hz.size(), high_hz.size()); ++i) {
    between_hz.push_back(low_hz[i] * std::pow(high_hz[i] / low_hz[i], share));
  }
  return between_hz;
}

// The sum has several minima, narrower than the solutions lie apart: the deepest is sought between
// them by interpolation, then by solutions around it. Unset if it lies at an end.
std::optional<double> best_log_factor(const Profile& profile) {
  constexpr int intervals = 2 * decades_each_way * solutions_per_decade;
  const double first_log = -0.5 * intervals * step_log();
  const double fine_log = step_log() / between_solutions;
  double best_log = first_log;
  double least = HUGE_VAL;
  std::vector<double> low_hz = profile.model_hz(first_log);
  for (int i = 0; i < intervals; ++i) {
    std::vector<double> high_hz = profile.model_hz(first_log + (i + 1) * step_log());
    for (int j = 0; j <= between_solutions; ++j) {
      const double share = static_cast<double>(j) / between_solutions;
      const double squares = profile.squares(interpolated(low_hz, high_hz, share));
      if (squares < least) {
        least = squares;
        best_log = first_log + (i + share) * step_log();
      }
    }
    low_hz = std::move(high_hz);
  }
  if (std::abs(best_log) > -first_log - fine_log) {
    return std::nullopt;
  }
  return minimum([&](double log) { return profile.squares(profile.model_hz(log)); },
                 best_log - 2.0 * fine_log, best_log + 2.0 * fine_log)
      .at;
}

// Derivatives of the logarithms of the matched modes by ln(springs / E). Nothing where modes come
// or go within so small a step.
std::optional<Eigen::VectorXd> sensitivities(const Profile& profile, double log_factor,
                                             const std::vector<MatchedMode>& matched) {
  const auto below_hz = profile.model_hz(log_factor - derivative_step);
  const auto above_hz = profile.model_hz(log_factor + derivative_step);
  Eigen::VectorXd by_log(static_cast<Eigen::Index>(matched.size()));
  for (std::size_t i = 0; i < matched.size(); ++i) {
    const std::size_t mode = matched[i].model;
    if (mode >= below_hz.size() || mode >= above_hz.size()) {
      return std::nullopt;
    }
    by_log[static_cast<Eigen::Index>(i)] =
        std::log(above_hz[mode] / below_hz[mode]) / (2.0 * derivative_step);
  }
  return by_log;
}

double degrees_of_freedom(const Eigen::VectorXd& by_springs) {
  return static_cast<double>(by_springs.size()) - 2.0;
}

// Of ln E and ln(springs / E): ln f is half of ln E, and by_springs of the other.
Eigen::Matrix2d covariance_of(const Eigen::VectorXd& by_springs, double rms_misfit) {
  const Eigen::Index modes = by_springs.size();
  Eigen::MatrixX2d jacobian(modes, 2);
  jacobian << Eigen::VectorXd::Constant(modes, 0.5), by_springs;
  const double squares = rms_misfit * rms_misfit * static_cast<double>(modes);
  return squares / degrees_of_freedom(by_springs) * (jacobian.transpose() * jacobian).inverse();
}

Estimate from_logarithm(double log_value, double log_error, double t) {
  const double value = std::exp(log_value);
  return {value,
          value * log_error,
          {std::exp(log_value - t * log_error), std::exp(log_value + t * log_error)},
          std::nullopt};
}
}  // namespace

std::optional<SpringUpdate> update_springs(const std::vector<Estimate>& measured_hz,
                                           const FrequenciesOnSprings& frequencies_hz,
                                           double youngs_modulus_pa) {
  const Profile profile{measured_hz, frequencies_hz};
  const auto log_factor = best_log_factor(profile);
  if (!log_factor) {
    return std::nullopt;
  }
  SpringUpdate result;
  result.model_hz = profile.model_hz(*log_factor);
  const auto update = update_youngs_modulus(measured_hz, result.model_hz, youngs_modulus_pa);
  if (!update || update->matched.size() < fewest_modes) {
    return std::nullopt;
  }
  result.model = *update;
  const auto by_springs = sensitivities(profile, *log_factor, update->matched);
  if (!by_springs) {
    return std::nullopt;
  }
  const Eigen::Matrix2d covariance = covariance_of(*by_springs, update->rms_misfit);
  const double t = t_quantile(0.975, degrees_of_freedom(*by_springs));
  const double log_modulus = std::log(update->youngs_modulus_pa.value);
  result.model.youngs_modulus_pa = from_logarithm(log_modulus, std::sqrt(covariance(0, 0)), t);
  result.spring_factor = from_logarithm(*log_factor + log_modulus - std::log(youngs_modulus_pa),
                                        std::sqrt(covariance.sum()), t);
  return result;
}
}  // namespace tapstudy::analysis
