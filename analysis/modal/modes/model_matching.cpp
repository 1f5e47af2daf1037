#include "analysis/modal/modes/model_matching.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/modal/modes/assignment.hpp"
#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/numerics.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double skip_cost = max_match_difference * max_match_difference;
constexpr double most_of_shape =
    0.5;  // of skip_cost: frequencies that agree are never parted by it
constexpr int max_rounds = 50;
const double farthest_log = std::log(2.0);  // of frequencies from the model's: E from 1/4 to 4
constexpr std::size_t fewest_to_leave = 3;  // modes: of one or two any factor fits some pair
constexpr double clearly_better = 0.25;     // share of the cost
constexpr double nearly_as_good = 2.0;
constexpr double same_log = 0.01;

struct Pair {
  std::size_t measured{};
  std::size_t model{};
};

struct Assignment {
  std::vector<Pair> pairs;
  double log_factor{};  // measured over model
  double cost{};        // pairs and those left alone
};

double of(const Eigen::MatrixXd& assurance, const Pair& pair) {
  return assurance(static_cast<Eigen::Index>(pair.measured), static_cast<Eigen::Index>(pair.model));
}

class Matcher {
 public:
  Matcher(const std::vector<double>& measured, const std::vector<double>& model,
          const Eigen::MatrixXd& assurance)
      : measured_{measured}, model_{model}, assurance_{assurance} {}

  Assignment settled_from(double log_factor) const {
    Assignment now = assigned(log_factor);
    for (int round = 0; round < max_rounds; ++round) {
      const Assignment next = assigned(now.log_factor);
      const bool is_settled = next.cost >= now.cost - 1e-15;
      now = next.cost < now.cost ? next : now;
      if (is_settled) {
        break;
      }
    }
    return now;
  }

  // Settled from the factor of each pair of modes, which is near to that of every assignment.
  std::vector<Assignment> all_settled() const {
    std::vector<Assignment> all;
    for (const double measured : measured_) {
      for (const double model : model_) {
        if (std::abs(measured - model) <= farthest_log) {
          all.push_back(settled_from(measured - model));
        }
      }
    }
    return all;
  }

  // That of the stated modulus, unless another with as many modes is clearly better.
  Assignment best_of(const std::vector<Assignment>& all) const {
    Assignment best = settled_from(0.0);
    double least = clearly_better * best.cost;
    for (const Assignment& other : all) {
      if (other.pairs.size() >= std::max(best.pairs.size(), fewest_to_leave) &&
          other.cost < least) {
        best = other;
        least = other.cost;
      }
    }
    return best;
  }

 private:
  // Columns beyond the model's modes stand for having no partner.
  Assignment assigned(double log_factor) const {
    const auto rows = static_cast<Eigen::Index>(measured_.size());
    const auto columns = static_cast<Eigen::Index>(model_.size());
    Eigen::MatrixXd cost = Eigen::MatrixXd::Constant(rows, columns + rows, skip_cost);
    for (Eigen::Index i = 0; i < rows; ++i) {
      for (Eigen::Index j = 0; j < columns; ++j) {
        cost(i, j) =
            cost_of({static_cast<std::size_t>(i), static_cast<std::size_t>(j)}, log_factor);
      }
    }
    std::vector<Pair> pairs;
    const std::vector<std::size_t> partners = least_cost_assignment(cost);
    for (std::size_t i = 0; i < partners.size(); ++i) {
      if (partners[i] < model_.size()) {
        pairs.push_back({i, partners[i]});
      }
    }
    return with_factor(std::move(pairs), log_factor);
  }

  double cost_of(const Pair& pair, double log_factor) const {
    const double difference = measured_[pair.measured] - model_[pair.model] - log_factor;
    const double unlike = assurance_.size() == 0 ? 0.0 : 1.0 - of(assurance_, pair);
    return difference * difference + most_of_shape * skip_cost * unlike;
  }

  // The least-squares factor of these pairs.
  Assignment with_factor(std::vector<Pair> pairs, double log_factor) const {
    Assignment result{std::move(pairs), log_factor, 0.0};
    double sum = 0.0;
    for (const Pair& pair : result.pairs) {
      sum += measured_[pair.measured] - model_[pair.model];
    }
    if (!result.pairs.empty()) {
      result.log_factor = sum / static_cast<double>(result.pairs.size());
    }
    for (const Pair& pair : result.pairs) {
      result.cost += cost_of(pair, result.log_factor);
    }
    result.cost += skip_cost * static_cast<double>(measured_.size() - result.pairs.size());
    return result;
  }

  const std::vector<double>& measured_;
  const std::vector<double>& model_;
  const Eigen::MatrixXd& assurance_;
};

std::optional<double> rival_factor(const std::vector<Assignment>& all, const Assignment& chosen) {
  std::optional<double> rival;
  double least = nearly_as_good * chosen.cost;
  for (const Assignment& other : all) {
    if (other.pairs.size() >= chosen.pairs.size() && other.cost < least &&
        std::abs(other.log_factor - chosen.log_factor) > same_log) {
      least = other.cost;
      rival = other.log_factor;
    }
  }
  return rival;
}

std::vector<double> logarithms(const std::vector<double>& values) {
  std::vector<double> logs(values.size());
  std::ranges::transform(values, logs.begin(), [](double x) { return std::log(x); });
  return logs;
}

std::vector<double> logarithms_of(const std::vector<Estimate>& estimates) {
  std::vector<double> values;
  std::ranges::transform(estimates, std::back_inserter(values), &Estimate::value);
  return logarithms(values);
}

// The standard error of ln factor and the degrees of freedom of its t.
struct FactorError {
  double value{};
  double degrees_of_freedom{};
};
FactorError error_of(const Assignment& found, const std::vector<Estimate>& measured_hz,
                     double squares) {
  const auto count = static_cast<double>(found.pairs.size());
  if (found.pairs.size() > 1) {
    return {std::sqrt(squares / (count - 1.0) / count), count - 1.0};
  }
  const Estimate& only = measured_hz[found.pairs.front().measured];
  constexpr double many = 1e6;  // its interval is taken as it is
  const double half = (only.interval.high - only.interval.low) / 2.0 / t_quantile(0.975, many);
  return {half / only.value, many};
}
}  // namespace

std::optional<ModelUpdate> update_youngs_modulus(const std::vector<Estimate>& measured_hz,
                                                 const std::vector<double>& model_hz,
                                                 double youngs_modulus_pa,
                                                 const Eigen::MatrixXd& assurance) {
  const std::vector<double> measured = logarithms_of(measured_hz);
  const std::vector<double> model = logarithms(model_hz);
  const Matcher matcher{measured, model, assurance};
  const std::vector<Assignment> all = matcher.all_settled();
  const Assignment found = matcher.best_of(all);
  if (found.pairs.empty()) {
    return std::nullopt;
  }
  ModelUpdate update;
  double squares = 0.0;
  for (const Pair& pair : found.pairs) {
    const double difference = measured[pair.measured] - model[pair.model] - found.log_factor;
    update.matched.push_back(
        {pair.measured, pair.model, std::expm1(difference),
         assurance.size() == 0 ? std::nullopt : std::optional{of(assurance, pair)}});
    squares += difference * difference;
  }
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (std::ranges::find(found.pairs, i, &Pair::measured) == found.pairs.end()) {
      update.unmatched.push_back(i);
    }
  }
  update.rms_misfit = std::sqrt(squares / static_cast<double>(found.pairs.size()));
  const FactorError error = error_of(found, measured_hz, squares);
  const double half = t_quantile(0.975, error.degrees_of_freedom) * error.value;
  const auto modulus = [&](double log_factor) {
    return youngs_modulus_pa * std::exp(2.0 * log_factor);
  };
  const double value = modulus(found.log_factor);
  update.youngs_modulus_pa = {value,
                              2.0 * value * error.value,
                              {modulus(found.log_factor - half), modulus(found.log_factor + half)},
                              std::nullopt};
  if (const auto rival = rival_factor(all, found)) {
    update.rival_pa = modulus(*rival);
  }
  return update;
}

double match_cost(const std::vector<Estimate>& measured_hz, const std::vector<double>& model_hz) {
  const std::vector<double> measured = logarithms_of(measured_hz);
  const std::vector<double> model = logarithms(model_hz);
  const Eigen::MatrixXd unknown;
  const Matcher matcher{measured, model, unknown};
  return matcher.best_of(matcher.all_settled()).cost;
}

namespace {
constexpr int decades_each_way = 2;
constexpr int solutions_per_decade = 4;
constexpr int between_solutions = 10;
constexpr std::size_t fewest_modes = 3;
constexpr double derivative_step = 0.01;  // of the logarithm of springs / E

// The step between solutions in ln(springs / E).
double step_log() {
  return std::log(10.0) / solutions_per_decade;
}

// The sum of squares as a function of ln(springs / E) relative to the stated value (a profile).
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

// The covariance of ln E and ln(springs / E): ln f depends on half of ln E, and on ln(springs / E)
// by by_springs.
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
