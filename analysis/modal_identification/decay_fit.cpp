#include "analysis/modal_identification/decay_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "analysis/modal_identification/decay_descent.hpp"
#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using Complex = std::complex<double>;

double error_of(const Eigen::Vector2d& slope, const Eigen::Matrix2d& covariance) {
  return std::sqrt(std::max(0.0, slope.dot(covariance * slope)));
}

// Of ln z, or of s: covariance of its real and imaginary part, in the unit of 1 / unit_s.
void set_pole_errors(const Complex& log_z, const Eigen::Matrix2d& covariance, double unit_s,
                     FittedMode& mode) {
  const double size = std::abs(log_z);
  const Eigen::Vector2d frequency_slope{log_z.real() / size, log_z.imag() / size};
  // d(-Re / |s|)
  const double cube = size * size * size;
  const Eigen::Vector2d ratio_slope{-log_z.imag() * log_z.imag() / cube,
                                    log_z.real() * log_z.imag() / cube};
  mode.frequency_error_hz =
      error_of(frequency_slope, covariance) / unit_s / (2.0 * std::numbers::pi);
  mode.ratio_error = error_of(ratio_slope, covariance);
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
  mode.significance = parts.dot(of_share.ldlt().solve(parts));
  return mode;
}

// All of one decay's poles taken as free.
DecayFit described(const DecayModel& model, const DecayModel::State& state, bool has_converged) {
  const double freedom = static_cast<double>(model.data().size() - model.unknowns());
  const Eigen::MatrixXd jacobian = model.jacobian(state);
  const Eigen::VectorXd scale = jacobian.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  const Eigen::MatrixXd scaled = jacobian * scale.asDiagonal();
  const double variance = state.sum_of_squares / freedom;
  const Eigen::MatrixXd inverse = core::pseudo_inverse(scaled.transpose() * scaled) * variance;
  const Eigen::MatrixXd covariance = scale.asDiagonal() * inverse * scale.asDiagonal();
  DecayFit fit;
  for (Eigen::Index k = 0; k < model.poles(); ++k) {
    fit.modes.push_back(mode_of(model, state, covariance, k));
  }
  // a bin's real and imaginary parts have half of N sigma^2 each
  fit.noise = std::sqrt(2.0 * variance / model.length());
  fit.explained = 1.0 - state.sum_of_squares / std::max(model.data().squaredNorm(), 1e-300);
  fit.sum_of_squares = state.sum_of_squares;
  fit.degrees_of_freedom = freedom;
  fit.has_converged = has_converged;
  const Eigen::VectorXd all = state.basis * state.shares;
  fit.fitted = all.head(all.size() / 2) + Complex{0.0, 1.0} * all.tail(all.size() / 2);
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

// Of the shared modes' amplitudes, the poles being known by all decays.
void set_significance(const DecayModel::State& state, double variance, std::size_t shared,
                      DecayFit& fit) {
  const Eigen::VectorXd scale = state.basis.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  const Eigen::MatrixXd scaled = state.basis * scale.asDiagonal();
  const Eigen::MatrixXd inverse = core::pseudo_inverse(scaled.transpose() * scaled) * variance;
  for (std::size_t k = 0; k < shared; ++k) {
    const auto row = 2 * static_cast<Eigen::Index>(k);
    const Eigen::Vector2d parts = state.shares.segment<2>(row).cwiseQuotient(scale.segment<2>(row));
    fit.modes[k].significance = parts.dot(inverse.block<2, 2>(row, row).ldlt().solve(parts));
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
                   const std::vector<double>& lines_hz) {
  std::vector<WeightedDecay> decay{started({&spectrum, {}, lines_hz}, start)};
  const bool has_converged = start.empty() || descend(decay, std::ssize(start));
  return described(decay.front().model, decay.front().state, has_converged);
}

SharedFit fit_shared_poles(const std::vector<SharingDecay>& sharing,
                           const std::vector<Pole>& shared) {
  std::vector<WeightedDecay> decays;
  for (const SharingDecay& decay : sharing) {
    decays.push_back(started(decay, shared));
  }
  SharedFit fit;
  const bool has_converged = descend(decays, std::ssize(shared));
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
}  // namespace tapstudy::analysis
