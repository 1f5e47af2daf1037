#include "analysis/modal/decay/decay_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/algebra/blas.hpp"
#include "core/algebra/dense_solvers.hpp"
#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double least_damping = 1e-12;

// One decay's normal equations, in blocks: shared poles as s [1/s], own poles and shares in columns
// of unit length.
struct Normal {
  Eigen::MatrixXd shared;
  Eigen::MatrixXd between;  // shared × own
  Eigen::MatrixXd own;
  Eigen::VectorXd shared_slope;
  Eigen::VectorXd own_slope;
  Eigen::VectorXd own_size;
};

double seconds(const DecayModel& model) {
  return model.length() / model.rate_hz();
}

Normal normal_equations(const WeightedDecay& decay, Eigen::Index shared) {
  const DecayModel& model = decay.model;
  const Eigen::MatrixXd slopes = model.pole_slopes(decay.state);
  Eigen::MatrixXd all = model.information(decay.state, slopes);
  const Eigen::Index own = all.cols() - 2 * shared;
  const Eigen::VectorXd size = all.diagonal().tail(own).cwiseSqrt().cwiseMax(1e-300);
  Eigen::VectorXd scale = Eigen::VectorXd::Constant(all.cols(), seconds(model));
  scale.tail(own) = size.cwiseInverse();
  all = decay.weight * (scale.asDiagonal() * all * scale.asDiagonal());
  Eigen::VectorXd slope{all.cols()};
  slope << slopes.transpose() * decay.state.residual,
      decay.state.basis.transpose() * decay.state.residual;
  slope = decay.weight * scale.cwiseProduct(slope);
  return {all.topLeftCorner(2 * shared, 2 * shared),
          all.topRightCorner(2 * shared, own),
          all.bottomRightCorner(own, own),
          slope.head(2 * shared),
          slope.tail(own),
          size};
}

void damp(Eigen::MatrixXd& matrix, double damping) {
  matrix.diagonal() *= 1.0 + damping;
}

// The steps of the shared poles [1/s] and, decay by decay, of their own ones.
struct Step {
  Eigen::VectorXd shared;
  std::vector<Eigen::VectorXd> own;
};
Step step_of(const std::vector<Normal>& normals, double damping) {
  const Eigen::Index shared = normals.front().shared_slope.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(shared, shared);
  for (const Normal& normal : normals) {
    matrix += normal.shared;
  }
  damp(matrix, damping);
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(shared);
  std::vector<core::SymmetricFactors> own;
  for (const Normal& normal : normals) {
    Eigen::MatrixXd damped = normal.own;
    damp(damped, damping);
    own.emplace_back(damped);
    matrix -= normal.between * own.back().solve_columns(normal.between.transpose());
    slope += normal.shared_slope - normal.between * own.back().solve(normal.own_slope);
  }
  Step step{core::SymmetricFactors{matrix}.solve(slope), {}};
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Normal& normal = normals[i];
    step.own.emplace_back(own[i]
                              .solve(normal.own_slope - normal.between.transpose() * step.shared)
                              .cwiseQuotient(normal.own_size));
  }
  return step;
}

double sum_of_squares(const std::vector<WeightedDecay>& decays) {
  double sum = 0.0;
  for (const WeightedDecay& decay : decays) {
    sum += decay.weight * decay.state.sum_of_squares;
  }
  return sum;
}

std::vector<Normal> normal_equations(const std::vector<WeightedDecay>& decays,
                                     Eigen::Index shared) {
  std::vector<Normal> normals;
  for (const WeightedDecay& decay : decays) {
    normals.push_back(normal_equations(decay, shared));
  }
  return normals;
}

std::vector<DecayModel::State> moved(const std::vector<WeightedDecay>& decays, const Step& step) {
  std::vector<DecayModel::State> states;
  for (std::size_t i = 0; i < decays.size(); ++i) {
    const DecayModel& model = decays[i].model;
    Eigen::VectorXd logs = decays[i].state.logs;
    const Eigen::Index own = logs.size() - step.shared.size();
    logs.head(step.shared.size()) += step.shared * seconds(model);
    logs.tail(own) += step.own[i].head(own);
    states.push_back(model.at(logs));
  }
  return states;
}

void exchange(std::vector<WeightedDecay>& decays, std::vector<DecayModel::State>& states) {
  for (std::size_t i = 0; i < decays.size(); ++i) {
    std::swap(decays[i].state, states[i]);
  }
}
}  // namespace

bool descend(std::vector<WeightedDecay>& decays, Eigen::Index shared, const Settling& settling) {
  double damping = 1e-3;
  double before = sum_of_squares(decays);
  std::vector<Normal> normals = normal_equations(decays, shared);
  for (int step = 0; step < settling.most_steps; ++step) {
    std::vector<DecayModel::State> states = moved(decays, step_of(normals, damping));
    exchange(decays, states);
    const double after = sum_of_squares(decays);
    if (!(after <= before)) {
      exchange(decays, states);
      damping *= 8.0;
      if (damping > 1e8) {
        return true;  // no direction leads down
      }
      continue;
    }
    if (before - after <= settling.share * before) {
      return true;
    }
    before = after;
    damping = std::max(damping / 5.0, least_damping);
    normals = normal_equations(decays, shared);
  }
  return false;
}

Eigen::MatrixXd information_on_shared(const std::vector<WeightedDecay>& decays,
                                      Eigen::Index shared) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(2 * shared, 2 * shared);
  for (const Normal& normal : normal_equations(decays, shared)) {
    matrix += normal.shared - normal.between * core::SymmetricFactors{normal.own}.solve_columns(
                                                   normal.between.transpose());
  }
  return matrix;
}

namespace {
using Complex = std::complex<double>;

double error_of(const Eigen::Vector2d& slope, const Eigen::Matrix2d& covariance) {
  return std::sqrt(std::max(0.0, slope.dot(covariance * slope)));
}

}  // namespace

Pole errors_of_pole(const Complex& log_z, const Eigen::Matrix2d& covariance, double unit_s) {
  const double size = std::abs(log_z);
  const Eigen::Vector2d frequency_slope{log_z.real() / size, log_z.imag() / size};
  // d(-Re / |s|)
  const double cube = size * size * size;
  const Eigen::Vector2d ratio_slope{-log_z.imag() * log_z.imag() / cube,
                                    log_z.real() * log_z.imag() / cube};
  return {error_of(frequency_slope, covariance) / unit_s / (2.0 * std::numbers::pi),
          error_of(ratio_slope, covariance)};
}

namespace {
void set_pole_errors(const Complex& log_z, const Eigen::Matrix2d& covariance, double unit_s,
                     FittedMode& mode) {
  const Pole errors = errors_of_pole(log_z, covariance, unit_s);
  mode.frequency_error_hz = errors.frequency_hz;
  mode.ratio_error = errors.damping_ratio;
  mode.decay_error_per_s = std::sqrt(std::max(0.0, covariance(0, 0))) / unit_s;
}

FittedMode mode_of(const DecayModel& model, const DecayModel::State& state,
                   const Eigen::MatrixXd& covariance, Eigen::Index k) {
  const Complex log_z = model.log_of_pole(state.logs, k);
  const double a = state.shares[2 * k];
  const double b = state.shares[2 * k + 1];
  FittedMode mode;
  mode.pole = pole_of(log_z, model.rate_hz());
  mode.amplitude = std::hypot(a, b);
  mode.phase_rad = std::atan2(-b, a);
  const Eigen::Index row = 2 * k;
  set_pole_errors(log_z, covariance.block<2, 2>(row, row) / (model.length() * model.length()),
                  1.0 / model.rate_hz(), mode);
  const Eigen::Index share = 2 * model.poles() + 2 * k;
  const Eigen::Matrix2d of_share = covariance.block<2, 2>(share, share);
  const Eigen::Vector2d parts{a, b};
  const double amplitude = std::max(mode.amplitude, 1e-300);
  mode.amplitude_error = error_of({a / amplitude, b / amplitude}, of_share);
  mode.phase_error_rad = error_of({-b / amplitude, a / amplitude}, of_share) / amplitude;
  mode.significance = parts.dot(core::SymmetricFactors{of_share}.solve(parts));
  return mode;
}

}  // namespace

void set_residual(const DecayModel& model, const DecayModel::State& state, DecayFit& fit) {
  const auto values = static_cast<double>(model.data().size());
  fit.degrees_of_freedom = std::max(1.0, values - static_cast<double>(model.unknowns()));
  fit.sum_of_squares = state.sum_of_squares;
  // a bin's real and imaginary parts have half of N sigma^2 each
  fit.noise = std::sqrt(2.0 * fit.sum_of_squares / fit.degrees_of_freedom / model.length());
  fit.explained = 1.0 - state.sum_of_squares / std::max(model.data().squaredNorm(), 1e-300);
  const Eigen::VectorXd all = state.basis * state.shares;
  fit.fitted = all.head(all.size() / 2) + Complex{0.0, 1.0} * all.tail(all.size() / 2);
}

namespace {
// All of one decay's poles taken as free.
DecayFit described(const DecayModel& model, const DecayModel::State& state, bool has_converged) {
  DecayFit fit;
  set_residual(model, state, fit);
  fit.has_converged = has_converged;
  const Eigen::MatrixXd information = model.information(state, model.pole_slopes(state));
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  const double variance = fit.sum_of_squares / fit.degrees_of_freedom;
  const Eigen::MatrixXd inverse =
      core::pseudo_inverse(scale.asDiagonal() * information * scale.asDiagonal()) * variance;
  const Eigen::MatrixXd covariance = scale.asDiagonal() * inverse * scale.asDiagonal();
  for (Eigen::Index k = 0; k < model.poles(); ++k) {
    fit.modes.push_back(mode_of(model, state, covariance, k));
  }
  return fit;
}

WeightedDecay started(const SharingDecay& decay, const std::vector<Pole>& shared) {
  std::vector<Pole> poles = shared;
  poles.insert(poles.end(), decay.own.begin(), decay.own.end());
  const BandSpectrum& spectrum = *decay.spectrum;
  DecayModel model{spectrum, std::ssize(poles), decay.lines_hz};
  if (model.data().size() <= model.unknowns()) {
    throw core::InvalidInput{"a decay is too short for so many modes"};
  }
  DecayModel::State state = model.at(model.logs_of(poles));
  const double variance = static_cast<double>(spectrum.length) * decay.noise * decay.noise / 2.0;
  return {std::move(model), std::move(state), 1.0 / variance};
}

// The significance of the shared modes' amplitudes in one decay, their poles being known from all
// decays.
void set_significance(const DecayModel::State& state, double variance, std::size_t shared,
                      DecayFit& fit) {
  const Eigen::VectorXd scale = state.gram.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  const Eigen::MatrixXd inverse =
      core::pseudo_inverse(scale.asDiagonal() * state.gram * scale.asDiagonal()) * variance;
  for (std::size_t k = 0; k < shared; ++k) {
    const auto row = 2 * static_cast<Eigen::Index>(k);
    const Eigen::Vector2d parts = state.shares.segment<2>(row).cwiseQuotient(scale.segment<2>(row));
    fit.modes[k].significance =
        parts.dot(core::SymmetricFactors{inverse.block<2, 2>(row, row)}.solve(parts));
  }
}

// The shared poles' errors are those of all decays together.
void set_shared_errors(const std::vector<WeightedDecay>& decays, std::size_t shared,
                       SharedFit& fit) {
  double squares = 0.0;
  double freedom = 2.0 * static_cast<double>(shared * (decays.size() - 1));
  for (std::size_t i = 0; i < decays.size(); ++i) {
    squares += decays[i].weight * decays[i].state.sum_of_squares;
    freedom += fit.decays[i].degrees_of_freedom;
  }
  fit.degrees_of_freedom = freedom;
  const Eigen::MatrixXd covariance =
      core::pseudo_inverse(information_on_shared(decays, static_cast<Eigen::Index>(shared))) *
      (squares / freedom);
  for (DecayFit& decay : fit.decays) {
    for (std::size_t k = 0; k < shared; ++k) {
      const auto row = 2 * static_cast<Eigen::Index>(k);
      set_pole_errors(log_of(decay.modes[k].pole, 1.0), covariance.block<2, 2>(row, row), 1.0,
                      decay.modes[k]);
    }
  }
}
}  // namespace

DecayFit fit_decay(const BandSpectrum& spectrum, const std::vector<Pole>& start,
                   const std::vector<double>& lines_hz, const Settling& settling) {
  std::vector<WeightedDecay> decay{started({&spectrum, {}, lines_hz}, start)};
  const bool has_converged = start.empty() || descend(decay, std::ssize(start), settling);
  return described(decay.front().model, decay.front().state, has_converged);
}

SharedFit fit_shared_poles(const std::vector<SharingDecay>& sharing,
                           const std::vector<Pole>& shared) {
  std::vector<WeightedDecay> decays;
  for (const SharingDecay& decay : sharing) {
    decays.push_back(started(decay, shared));
  }
  SharedFit fit;
  const bool has_converged = descend(decays, std::ssize(shared), settled_fit);
  for (const WeightedDecay& decay : decays) {
    fit.decays.push_back(described(decay.model, decay.state, has_converged));
  }
  set_shared_errors(decays, shared.size(), fit);
  for (std::size_t i = 0; i < decays.size(); ++i) {
    const double variance = decays[i].state.sum_of_squares / fit.decays[i].degrees_of_freedom;
    set_significance(decays[i].state, variance, shared.size(), fit.decays[i]);
  }
  return fit;
}

std::vector<std::vector<Pole>> shared_poles_without(const std::vector<SharingDecay>& sharing,
                                                    const std::vector<Pole>& shared,
                                                    const std::vector<std::size_t>& group_of,
                                                    std::size_t groups) {
  std::vector<Normal> normals;
  for (const SharingDecay& decay : sharing) {
    normals.push_back(normal_equations(started(decay, shared), std::ssize(shared)));
  }
  std::vector<std::vector<Pole>> all(groups, shared);
  for (std::size_t group = 0; group < groups; ++group) {
    std::vector<Normal> others;
    for (std::size_t i = 0; i < normals.size(); ++i) {
      if (group_of[i] != group) {
        others.push_back(normals[i]);
      }
    }
    const Eigen::VectorXd step = step_of(others, least_damping).shared;
    for (std::size_t k = 0; k < shared.size() && step.allFinite(); ++k) {
      const auto row = 2 * static_cast<Eigen::Index>(k);
      all[group][k] = pole_of(log_of(shared[k], 1.0) + Complex{step[row], step[row + 1]}, 1.0);
    }
  }
  return all;
}
}  // namespace tapstudy::analysis
