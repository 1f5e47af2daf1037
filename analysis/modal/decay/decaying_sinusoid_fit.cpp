#include "analysis/modal/decay/decaying_sinusoid_fit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/NonLinearOptimization>

#include "analysis/statistics/distributions.hpp"
#include "core/algebra/dense_solvers.hpp"
#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using std::numbers::pi;
constexpr Eigen::Index max_samples = 4000;
constexpr Eigen::Index min_fit = 16;
constexpr int grid_frequencies = 60;
constexpr int grid_decays = 12;

// Unknowns: decay and angular frequency over the sampling rate; cosine, sine, offset.
class SinusoidModel {
 public:
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  explicit SinusoidModel(const Eigen::VectorXd& samples)
      : samples_{samples}, sum_{samples.sum()}, energy_{samples.squaredNorm()} {}
  int values() const { return static_cast<int>(samples_.size()); }
  static int inputs() { return 5; }

  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& residual) const {
    residual = basis(x[0], x[1]) * x.tail(3) - samples_;
    return 0;
  }
  int df(const Eigen::VectorXd& x, Eigen::MatrixXd& jacobian) const {
    const Eigen::MatrixXd b = basis(x[0], x[1]);
    const Eigen::ArrayXd n = steps();
    jacobian.resize(samples_.size(), 5);
    jacobian.col(0) = -n * (x[2] * b.col(0) + x[3] * b.col(1)).array();
    jacobian.col(1) = n * (x[3] * b.col(0) - x[2] * b.col(1)).array();
    jacobian.rightCols(3) = b;
    return 0;
  }
  // The best cosine, sine and offset for this decay and frequency, and the residual's energy, by
  // the sums of z^n, z^2n, |z|^2n in closed form and that of y z^n by Horner's scheme.
  std::pair<Eigen::Vector3d, double> best_shares(double decay, double omega) const {
    const std::complex<double> log_z{-decay, omega};
    const std::complex<double> first = sum_of_powers(log_z);
    const std::complex<double> second = sum_of_powers(2.0 * log_z);
    const double squares = sum_of_powers(-2.0 * decay).real();
    const std::complex<double> product = product_with_powers(std::exp(log_z));
    Eigen::Matrix3d gram;
    gram << (squares + second.real()) / 2.0, second.imag() / 2.0, first.real(),  //
        second.imag() / 2.0, (squares - second.real()) / 2.0, first.imag(),      //
        first.real(), first.imag(), static_cast<double>(samples_.size());
    const Eigen::Vector3d products{product.real(), product.imag(), sum_};
    const Eigen::Vector3d shares = core::SymmetricFactors{gram}.solve(products);
    return {shares, energy_ - shares.dot(products)};
  }

 private:
  std::complex<double> sum_of_powers(const std::complex<double>& log_z) const {
    const auto count = static_cast<double>(samples_.size());
    return (1.0 - std::exp(count * log_z)) / (1.0 - std::exp(log_z));
  }
  std::complex<double> product_with_powers(const std::complex<double>& z) const {
    double real = 0.0;
    double imaginary = 0.0;
    for (Eigen::Index n = samples_.size() - 1; n >= 0; --n) {
      const double turned = real * z.real() - imaginary * z.imag() + samples_[n];
      imaginary = real * z.imag() + imaginary * z.real();
      real = turned;
    }
    return {real, imaginary};
  }
  Eigen::ArrayXd steps() const {
    return Eigen::ArrayXd::LinSpaced(samples_.size(), 0.0,
                                     static_cast<double>(samples_.size() - 1));
  }
  Eigen::MatrixXd basis(double decay, double omega) const {
    const Eigen::ArrayXd n = steps();
    const Eigen::ArrayXd fall = (-decay * n).exp();
    Eigen::MatrixXd b{samples_.size(), 3};
    b.col(0) = fall * (omega * n).cos();
    b.col(1) = fall * (omega * n).sin();
    b.col(2).setOnes();
    return b;
  }
  const Eigen::VectorXd& samples_;
  double sum_;
  double energy_;
};

// Decays from one over the duration to the band's highest frequency times 2 pi.
Eigen::VectorXd best_of_grid(const SinusoidModel& model, double rate_hz, Eigen::Index samples,
                             const Band& band) {
  const double least_decay = 1.0 / static_cast<double>(samples);
  const double largest_decay = std::min(1.0, 2.0 * pi * band.high_hz / rate_hz);
  double least = std::numeric_limits<double>::infinity();
  Eigen::VectorXd best = Eigen::VectorXd::Zero(5);
  for (int i = 0; i < grid_frequencies; ++i) {
    const double share = (i + 0.5) / grid_frequencies;
    const double omega =
        2.0 * pi / rate_hz * band.low_hz * std::pow(band.high_hz / band.low_hz, share);
    for (int k = 0; k < grid_decays; ++k) {
      const double decay =
          least_decay * std::pow(largest_decay / least_decay, k / (grid_decays - 1.0));
      const auto [shares, energy] = model.best_shares(decay, omega);
      if (energy < least) {
        least = energy;
        best << decay, omega, shares;
      }
    }
  }
  return best;
}

FittedSinusoid sinusoid_of(const Eigen::VectorXd& x, const Eigen::MatrixXd& covariance,
                           double rate_hz) {
  const double decay = x[0];
  const double omega = x[1];
  const double size = std::hypot(x[2], x[3]);
  // a cos wt + b sin wt = size sin(wt + phase), the phase within a quarter turn, the sign either
  double phase = std::atan2(x[2], x[3]);
  phase -= pi * std::round(phase / pi);
  FittedSinusoid fit;
  fit.amplitude = size * std::exp(decay / omega * phase);
  fit.decay_per_s = decay * rate_hz;
  fit.frequency_hz = omega * rate_hz / (2.0 * pi);
  fit.start_s = -phase / omega / rate_hz;
  fit.decay_error_per_s = std::sqrt(covariance(0, 0)) * rate_hz;
  fit.frequency_error_hz = std::sqrt(covariance(1, 1)) * rate_hz / (2.0 * pi);
  const double square = size * size;
  Eigen::Vector4d slope;  // of the amplitude's logarithm
  slope << phase / omega, -decay * phase / (omega * omega), (x[2] + decay / omega * x[3]) / square,
      (x[3] - decay / omega * x[2]) / square;
  fit.amplitude_error =
      fit.amplitude * std::sqrt(slope.dot(covariance.topLeftCorner<4, 4>() * slope));
  return fit;
}
}  // namespace

std::optional<FittedSinusoid> fit_decaying_sinusoid(const FreeDecay& from_impact,
                                                    const Band& band) {
  FreeDecay decay = from_impact;
  if (decay.samples.size() > max_samples) {
    decay.samples.conservativeResize(max_samples);
  }
  if (decay.samples.size() < min_fit) {
    throw core::InvalidInput{"a sinusoid needs at least 16 samples after the impact"};
  }
  SinusoidModel model{decay.samples};
  Eigen::VectorXd x = best_of_grid(model, decay.rate_hz, decay.samples.size(), band);
  Eigen::LevenbergMarquardt<SinusoidModel> solver{model};
  solver.parameters.maxfev = 400;
  solver.minimize(x);
  const double omega_hz = x[1] * decay.rate_hz / (2.0 * pi);
  if (!x.allFinite() || x[0] <= 0.0 || !band.holds(omega_hz)) {
    return std::nullopt;
  }
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
  model(x, residual);
  model.df(x, jacobian);
  const Eigen::VectorXd size = jacobian.colwise().norm().transpose().cwiseMax(1e-300);
  const Eigen::MatrixXd scaled = jacobian * size.cwiseInverse().asDiagonal();
  const double variance =
      residual.squaredNorm() / static_cast<double>(decay.samples.size() - x.size());
  const Eigen::MatrixXd inverse = core::pseudo_inverse(scaled.transpose() * scaled) * variance;
  const Eigen::MatrixXd covariance =
      size.cwiseInverse().asDiagonal() * inverse * size.cwiseInverse().asDiagonal();
  FittedSinusoid fit = sinusoid_of(x, covariance, decay.rate_hz);
  const double energy = (decay.samples.array() - decay.samples.mean()).square().sum();
  fit.explained = energy > 0.0 ? 1.0 - residual.squaredNorm() / energy : 0.0;
  return fit;
}

namespace {
void check_speeds(const std::vector<double>& speeds_m_s, const std::vector<double>& amplitudes) {
  if (speeds_m_s.empty() || speeds_m_s.size() != amplitudes.size()) {
    throw core::InvalidInput{"a law of amplitudes needs as many speeds, and one at least"};
  }
  if (!std::ranges::all_of(speeds_m_s, [](double speed) { return speed > 0.0; })) {
    throw core::InvalidInput{"speeds of impact must be above 0"};
  }
}
}  // namespace

Estimate amplitude_per_speed(const std::vector<double>& speeds_m_s,
                             const std::vector<double>& amplitudes) {
  double speed_squares = 0.0;
  double products = 0.0;
  check_speeds(speeds_m_s, amplitudes);
  for (std::size_t i = 0; i < speeds_m_s.size(); ++i) {
    speed_squares += speeds_m_s[i] * speeds_m_s[i];
    products += speeds_m_s[i] * amplitudes[i];
  }
  const double slope = products / speed_squares;
  if (speeds_m_s.size() == 1) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return {slope, infinity, {-infinity, infinity}, std::nullopt};
  }
  double squares = 0.0;
  for (std::size_t i = 0; i < speeds_m_s.size(); ++i) {
    const double misfit = amplitudes[i] - slope * speeds_m_s[i];
    squares += misfit * misfit;
  }
  const auto freedom = static_cast<double>(speeds_m_s.size() - 1);
  return t_estimate(slope, std::sqrt(squares / freedom / speed_squares), freedom);
}

std::optional<AmplitudeLine> amplitude_line(const std::vector<double>& speeds_m_s,
                                            const std::vector<double>& amplitudes) {
  check_speeds(speeds_m_s, amplitudes);
  const auto count = static_cast<Eigen::Index>(speeds_m_s.size());
  const Eigen::ArrayXd speed = Eigen::Map<const Eigen::ArrayXd>(speeds_m_s.data(), count);
  const Eigen::ArrayXd amplitude = Eigen::Map<const Eigen::ArrayXd>(amplitudes.data(), count);
  const double spread = (speed - speed.mean()).square().sum();
  if (count < 3 || spread <= 1e-12 * speed.square().sum()) {
    return std::nullopt;
  }
  const double slope = ((speed - speed.mean()) * amplitude).sum() / spread;
  const double offset = amplitude.mean() - slope * speed.mean();
  const auto freedom = static_cast<double>(count - 2);
  const double variance = (amplitude - offset - slope * speed).square().sum() / freedom;
  const double offset_variance =
      variance * (1.0 / static_cast<double>(count) + speed.mean() * speed.mean() / spread);
  return AmplitudeLine{t_estimate(offset, std::sqrt(offset_variance), freedom),
                       t_estimate(slope, std::sqrt(variance / spread), freedom)};
}
}  // namespace tapstudy::analysis
