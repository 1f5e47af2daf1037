#include "analysis/modal/decay/resting_pole_fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "analysis/modal/decay/decay_fit.hpp"
#include "analysis/modal/decay/decay_model.hpp"
#include "core/algebra/blas.hpp"
#include "core/algebra/dense_solvers.hpp"
#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr int most_resting_steps = 25;
constexpr double settled_step = 1e-3;  // of a standard error

// Re s and Im s of each pole [1/s].
Eigen::VectorXd parameters_of(const std::vector<RestingPole>& poles) {
  Eigen::VectorXd all{2 * std::ssize(poles)};
  for (Eigen::Index k = 0; k < std::ssize(poles); ++k) {
    const std::complex<double> s = log_of(poles[static_cast<std::size_t>(k)].pole, 1.0);
    all.segment<2>(2 * k) << s.real(), s.imag();
  }
  return all;
}

std::vector<RestingPole> poles_from(const Eigen::VectorXd& parameters,
                                    std::vector<RestingPole> poles) {
  for (Eigen::Index k = 0; k < std::ssize(poles); ++k) {
    poles[static_cast<std::size_t>(k)].pole =
        pole_of({parameters[2 * k], parameters[2 * k + 1]}, 1.0);
  }
  return poles;
}

Eigen::Index terms_of(const std::vector<RestingPole>& poles) {
  Eigen::Index terms = 0;
  for (const RestingPole& one : poles) {
    terms += one.terms;
  }
  return terms;
}

// One decay with its series of exponentials.
class Series {
 public:
  Series(const NearbyDecay& decay, const std::vector<RestingPole>& poles)
      : poles_{poles}, model_{decay.spectrum, terms_of(poles), decay.lines_hz} {
    if (model_.data().size() <= model_.unknowns()) {
      throw core::InvalidInput{"a decay is too short for so many terms"};
    }
  }

  DecayModel::State at(const Eigen::VectorXd& parameters) const {
    Eigen::VectorXd logs{2 * model_.poles()};
    Eigen::Index row = 0;
    const double samples_per_s = model_.length() / model_.rate_hz();
    for (std::size_t k = 0; k < poles_.size(); ++k) {
      const auto first = 2 * static_cast<Eigen::Index>(k);
      for (int term = 1; term <= poles_[k].terms; ++term) {
        logs[row++] = term * parameters[first] * samples_per_s;
        logs[row++] = parameters[first + 1] * samples_per_s;
      }
    }
    return model_.at(logs);
  }

  // d residual / d parameters: of r = y - B c, c = B^+ y, it is -(1 - B B^+) dB c - B^+' dB' r
  // (Golub & Pereyra 1973).
  Eigen::MatrixXd slopes(const DecayModel::State& here) const {
    const double seconds = model_.length() / model_.rate_hz();
    const auto parameters = 2 * std::ssize(poles_);
    Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(here.basis.rows(), parameters);
    Eigen::MatrixXd towards = Eigen::MatrixXd::Zero(here.basis.cols(), parameters);
    Eigen::Index exponential = 0;
    for (Eigen::Index k = 0; k < std::ssize(poles_); ++k) {
      for (int term = 1; term <= poles_[static_cast<std::size_t>(k)].terms; ++term) {
        const Eigen::MatrixXd columns = model_.column_slopes(here, exponential);
        const Eigen::Vector2d shares = here.shares.segment<2>(2 * exponential);
        const Eigen::Vector2d per_parameter{term * seconds, seconds};
        for (Eigen::Index part = 0; part < 2; ++part) {
          const auto slope = per_parameter[part] * columns.middleCols<2>(2 * part);
          moved.col(2 * k + part) += slope * shares;
          towards.col(2 * k + part).segment<2>(2 * exponential) = slope.transpose() * here.residual;
        }
        ++exponential;
      }
    }
    const Eigen::VectorXd per_size =
        here.basis.colwise().norm().cwiseMax(1e-300).cwiseInverse().transpose();
    const Eigen::MatrixXd basis = here.basis * per_size.asDiagonal();
    const Eigen::MatrixXd explained =
        core::pseudo_inverse(core::inner_products(basis, basis)) *
        (core::inner_products(basis, moved) - per_size.asDiagonal() * towards);
    return core::combination(basis, explained) - moved;
  }

  double values() const { return static_cast<double>(model_.data().size()); }
  double energy() const { return model_.data().squaredNorm(); }

 private:
  std::vector<RestingPole> poles_;
  DecayModel model_;
};

// The normal equations of one decay, divided by its noise's variance.
struct Equations {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd slope;
};

class SharedSeries {
 public:
  SharedSeries(const std::vector<NearbyDecay>& decays, const std::vector<RestingPole>& poles) {
    for (const NearbyDecay& decay : decays) {
      series_.emplace_back(decay, poles);
    }
  }

  std::vector<DecayModel::State> at(const Eigen::VectorXd& parameters) const {
    std::vector<DecayModel::State> states;
    for (const Series& one : series_) {
      states.push_back(one.at(parameters));
    }
    return states;
  }

  double deviance(const std::vector<DecayModel::State>& states) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < states.size(); ++i) {
      sum += series_[i].values() *
             std::log(std::max(states[i].sum_of_squares, least_squares(i)) / series_[i].values());
    }
    return sum;
  }

  std::vector<Equations> equations(const std::vector<DecayModel::State>& states) const {
    std::vector<Equations> all;
    for (std::size_t i = 0; i < states.size(); ++i) {
      const Eigen::MatrixXd slopes = series_[i].slopes(states[i]);
      const double variance =
          std::max(states[i].sum_of_squares, least_squares(i)) / series_[i].values();
      all.push_back({slopes.transpose() * slopes / variance,
                     -(slopes.transpose() * states[i].residual) / variance});
    }
    return all;
  }

  const Series& of(std::size_t i) const { return series_[i]; }

 private:
  // A synthetic decay has no noise but its rounding.
  double least_squares(std::size_t i) const { return 1e-18 * series_[i].energy() + 1e-290; }

  std::vector<Series> series_;
};

Equations sum_of(const std::vector<Equations>& some, Eigen::Index unknowns) {
  Equations sum{Eigen::MatrixXd::Zero(unknowns, unknowns), Eigen::VectorXd::Zero(unknowns)};
  for (const Equations& one : some) {
    sum.matrix += one.matrix;
    sum.slope += one.slope;
  }
  return sum;
}

bool all_decay(const Eigen::VectorXd& parameters) {
  for (Eigen::Index i = 0; i < parameters.size(); i += 2) {
    if (!(parameters[i] < 0.0 && parameters[i + 1] > 0.0)) {
      return false;
    }
  }
  return true;
}

Eigen::VectorXd step_from(const Equations& sum, double damping) {
  Eigen::MatrixXd matrix = sum.matrix;
  matrix.diagonal() *= 1.0 + damping;
  return core::SymmetricFactors{matrix}.solve(sum.slope);
}

// Steps until one is small beside the standard errors; true if it came to that.
bool settle(const SharedSeries& series, Eigen::VectorXd& parameters,
            std::vector<DecayModel::State>& states) {
  double damping = 1e-3;
  double before = series.deviance(states);
  Equations sum = sum_of(series.equations(states), parameters.size());
  for (int i = 0; i < most_resting_steps; ++i) {
    const Eigen::VectorXd step = step_from(sum, damping);
    const Eigen::VectorXd moved = parameters + step;
    if (!step.allFinite()) {
      return false;
    }
    if (all_decay(moved)) {
      std::vector<DecayModel::State> there = series.at(moved);
      const double after = series.deviance(there);
      if (after <= before) {
        const double size = std::sqrt(std::max(0.0, step.dot(sum.matrix * step)));
        parameters = moved;
        states = std::move(there);
        before = after;
        if (size < settled_step) {
          return true;
        }
        damping = std::max(damping / 5.0, 1e-9);
        sum = sum_of(series.equations(states), parameters.size());
        continue;
      }
    }
    damping *= 8.0;
    if (damping > 1e8) {
      return true;  // no direction leads down
    }
  }
  return false;
}

// The first pole's series over the first periods: their mean slope is less of a noise than that of
// one sample.
SeenAtTap seen_at(const DecayModel::State& state, const Eigen::VectorXd& parameters,
                  const RestingPole& pole, const Series& series) {
  constexpr double first_periods = 4.0;
  const double span_s = first_periods * 2.0 * std::numbers::pi / parameters[1];
  std::complex<double> first{};
  std::complex<double> last{};
  for (int term = 1; term <= pole.terms; ++term) {
    const Eigen::Index row = 2 * static_cast<Eigen::Index>(term - 1);
    const std::complex<double> share{state.shares[row], -state.shares[row + 1]};
    first += share;
    last += share * std::exp(term * parameters[0] * span_s);  // beside the frequency at rest
  }
  SeenAtTap seen;
  seen.amplitude = std::abs(first);
  seen.pole = pole.pole;
  if (std::abs(first) > 0.0 && std::abs(last) > 0.0) {
    const std::complex<double> turned = std::log(last / first);
    seen.pole = pole_of({turned.real() / span_s, parameters[1] + turned.imag() / span_s}, 1.0);
  }
  const Eigen::Index columns = 2 * static_cast<Eigen::Index>(pole.terms);
  seen.share = (state.basis.leftCols(columns) * state.shares.head(columns)).squaredNorm() /
               std::max(series.energy(), 1e-290);
  return seen;
}
}  // namespace

double schwarz(double deviance, double unknowns, const std::vector<NearbyDecay>& decays) {
  double values = 0.0;
  for (const NearbyDecay& decay : decays) {
    values += 2.0 * static_cast<double>(decay.spectrum.values.size());
  }
  return deviance + unknowns * std::log(values);
}

RestingFit fit_resting_poles(const std::vector<NearbyDecay>& decays,
                             const std::vector<RestingPole>& start) {
  const SharedSeries series{decays, start};
  Eigen::VectorXd parameters = parameters_of(start);
  std::vector<DecayModel::State> states = series.at(parameters);
  RestingFit fit;
  fit.has_converged = settle(series, parameters, states);
  fit.poles = poles_from(parameters, start);
  fit.deviance = series.deviance(states);
  const double unknowns = static_cast<double>(parameters.size()) +
                          2.0 * static_cast<double>(terms_of(start) * std::ssize(decays));
  fit.criterion = schwarz(fit.deviance, unknowns, decays);
  for (std::size_t i = 0; i < states.size(); ++i) {
    fit.seen.push_back(seen_at(states[i], parameters, start.front(), series.of(i)));
  }
  double values = 0.0;
  double log_variances = 0.0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    // a bin's real and imaginary parts have half of N sigma^2 each
    log_variances +=
        series.of(i).values() * std::log(static_cast<double>(decays[i].spectrum.length));
    values += series.of(i).values();
  }
  fit.noise = std::sqrt(2.0 * std::exp((fit.deviance - log_variances) / values));
  return fit;
}

std::vector<Pole> without_each_impact(const std::vector<NearbyDecay>& decays,
                                      const RestingFit& fit) {
  const SharedSeries series{decays, fit.poles};
  const Eigen::VectorXd parameters = parameters_of(fit.poles);
  const std::vector<Equations> all = series.equations(series.at(parameters));
  const Equations sum = sum_of(all, parameters.size());
  std::map<int, std::vector<Equations>> by_impact;
  for (std::size_t i = 0; i < decays.size(); ++i) {
    by_impact[decays[i].impact].push_back(all[i]);
  }
  std::vector<Pole> poles;
  for (const auto& [impact, some] : by_impact) {
    const Equations of_impact = sum_of(some, parameters.size());
    const Equations others{sum.matrix - of_impact.matrix, sum.slope - of_impact.slope};
    const Eigen::VectorXd step = step_from(others, 0.0);
    poles.push_back(
        poles_from(step.allFinite() ? Eigen::VectorXd{parameters + step} : parameters, fit.poles)
            .front()
            .pole);
  }
  return poles;
}

Pole noise_errors(const std::vector<NearbyDecay>& decays, const RestingFit& fit) {
  const SharedSeries series{decays, fit.poles};
  const Eigen::VectorXd parameters = parameters_of(fit.poles);
  const Equations sum = sum_of(series.equations(series.at(parameters)), parameters.size());
  const Eigen::Matrix2d covariance = core::pseudo_inverse(sum.matrix).topLeftCorner<2, 2>();
  return errors_of_pole({parameters[0], parameters[1]}, covariance, 1.0);
}

OwnPoles deviance_of_own(const std::vector<NearbyDecay>& decays,
                         const std::vector<std::vector<Pole>>& poles) {
  OwnPoles own;
  for (std::size_t i = 0; i < decays.size(); ++i) {
    const DecayModel model{decays[i].spectrum, std::ssize(poles[i]), decays[i].lines_hz};
    if (model.data().size() <= model.unknowns()) {
      throw core::InvalidInput{"a decay is too short for so many modes"};
    }
    const DecayModel::State state = model.at(model.logs_of(poles[i]));
    const auto values = static_cast<double>(model.data().size());
    const double sum = std::min(state.sum_of_squares, model.data().squaredNorm());
    own.deviance += values * std::log(std::max(sum, 1e-290) / values);
    own.unknowns += 4.0 * static_cast<double>(poles[i].size());
  }
  return own;
}
}  // namespace tapstudy::analysis
