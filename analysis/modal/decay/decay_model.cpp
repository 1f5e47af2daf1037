#include "analysis/modal/decay/decay_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/algebra/lapack.hpp"
namespace tapstudy::analysis {
namespace {
using Complex = std::complex<double>;

// Sums over n = 0 ... N - 1 of z^n q^n and, times n, of n z^n q^n, at every bin's q; q^N = 1 there.
// Near z q = 1, where the quotient loses its digits, by the series.
class GeometricSums {
 public:
  GeometricSums(const Complex& log_z, const BandSpectrum& spectrum)
      : log_z_{log_z},
        z_{std::exp(log_z)},
        length_{static_cast<double>(spectrum.length)},
        z_to_length_{std::exp(log_z * length_)},
        spectrum_{spectrum} {}

  Complex value(Eigen::Index bin) const {
    const Complex u = exponent(bin);
    return is_near_one(u) ? value_near_one(u) : quotient(1.0 - z_to_length_, 1.0 - turned(bin));
  }
  // The derivative of the value by ln z.
  Complex slope(Eigen::Index bin) const {
    const Complex u = exponent(bin);
    if (is_near_one(u)) {
      return slope_near_one(u);
    }
    const Complex x = turned(bin);
    const Complex value = quotient(1.0 - z_to_length_, 1.0 - x);
    return quotient(product(value, x) - length_ * z_to_length_, 1.0 - x);
  }

 private:
  // The library's product and quotient of complex numbers look for infinities: several times
  // slower.
  static Complex product(const Complex& a, const Complex& b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
  }
  static Complex quotient(const Complex& a, const Complex& b) {
    const double scale = 1.0 / (b.real() * b.real() + b.imag() * b.imag());
    return {(a.real() * b.real() + a.imag() * b.imag()) * scale,
            (a.imag() * b.real() - a.real() * b.imag()) * scale};
  }
  Complex exponent(Eigen::Index bin) const {
    return {log_z_.real(), log_z_.imag() - spectrum_.rad_per_sample[bin]};
  }
  Complex turned(Eigen::Index bin) const { return product(z_, spectrum_.delay[bin]); }
  bool is_near_one(const Complex& u) const {
    constexpr double near = 1e-3;
    return (u.real() * u.real() + u.imag() * u.imag()) * length_ * length_ < near * near;
  }
  Complex value_near_one(const Complex& u) const {
    const double first = length_ * (length_ - 1.0) / 2.0;
    const double second = first * (2.0 * length_ - 1.0) / 3.0;
    return length_ + u * (first + u * (second / 2.0 + u * first * first / 6.0));
  }
  Complex slope_near_one(const Complex& u) const {
    const double first = length_ * (length_ - 1.0) / 2.0;
    const double second = first * (2.0 * length_ - 1.0) / 3.0;
    return first + u * (second + u * first * first / 2.0);
  }

  Complex log_z_;
  Complex z_;
  double length_;
  Complex z_to_length_;
  const BandSpectrum& spectrum_;
};
}  // namespace

CutExponential cut_exponential(const std::complex<double>& log_z, const BandSpectrum& spectrum) {
  const GeometricSums of_z{log_z, spectrum};
  const GeometricSums of_conjugate{std::conj(log_z), spectrum};
  const Eigen::Index bins = spectrum.values.size();
  CutExponential both{Eigen::VectorXcd(bins), Eigen::VectorXcd(bins)};
  for (Eigen::Index k = 0; k < bins; ++k) {
    const Complex one = of_z.value(k);
    const Complex other = of_conjugate.value(k);
    both.plus[k] = (one + other) / 2.0;
    both.minus[k] = (one - other) / 2.0;
  }
  return both;
}

CutExponential cut_exponential_slope(const std::complex<double>& c,
                                     const std::complex<double>& log_z,
                                     const BandSpectrum& spectrum) {
  const GeometricSums of_z{log_z, spectrum};
  const GeometricSums of_conjugate{std::conj(log_z), spectrum};
  const Eigen::Index bins = spectrum.values.size();
  CutExponential both{Eigen::VectorXcd(bins), Eigen::VectorXcd(bins)};
  for (Eigen::Index k = 0; k < bins; ++k) {
    const Complex one = c * of_z.slope(k);
    const Complex other = std::conj(c) * of_conjugate.slope(k);
    both.plus[k] = (one + other) / 2.0;
    both.minus[k] = (one - other) / 2.0;
  }
  return both;
}

namespace {
constexpr Eigen::Index smooth_terms = 4;
constexpr double max_growth = 30.0;

// The columns of cosine and sine.
void set_pair(Eigen::MatrixXd& columns, Eigen::Index first, const CutExponential& both) {
  columns.col(first) = stacked(both.plus);
  columns.col(first + 1) = stacked(Complex{0.0, -1.0} * both.minus);
}

// Squares of e^(2 max_growth) can still be added up.
bool grows_beyond_bounds(const Eigen::VectorXd& logs) {
  const Eigen::Index poles = logs.size() / 2;
  return poles > 0 &&
         !(Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<2>>(logs.data(), poles)
               .maxCoeff() <= 2.0 * max_growth);
}
}  // namespace

DecayModel::DecayModel(const BandSpectrum& spectrum, Eigen::Index poles,
                       const std::vector<double>& lines_hz)
    : spectrum_{spectrum},
      poles_{poles},
      length_{static_cast<double>(spectrum.length)},
      data_{stacked(spectrum.values)} {
  const Eigen::ArrayXcd& q = spectrum.delay;
  const auto lines = static_cast<Eigen::Index>(lines_hz.size());
  nuisance_ = Eigen::MatrixXd{data_.size(), smooth_terms + 2 * lines};
  nuisance_.col(0) = stacked((1.0 / (1.0 - q)).matrix());
  Eigen::ArrayXcd of_power = Eigen::ArrayXcd::Ones(q.size());
  for (int power = 0; power < smooth_terms - 1; ++power) {
    nuisance_.col(power + 1) = stacked(of_power.matrix());
    of_power *= q;
  }
  for (Eigen::Index k = 0; k < lines; ++k) {
    const Complex log_z = log_of({lines_hz[static_cast<std::size_t>(k)], 0.0}, spectrum.rate_hz);
    set_pair(nuisance_, smooth_terms + 2 * k, cut_exponential(log_z, spectrum));
  }
}

DecayModel::State DecayModel::at(const Eigen::VectorXd& logs) const {
  State state{logs, {}, Eigen::MatrixXd{data_.size(), 2 * poles_ + nuisance_.cols()}, {}, 0.0};
  for (Eigen::Index k = 0; k < poles_; ++k) {
    set_pair(state.basis, 2 * k, cut_exponential(log_of_pole(logs, k), spectrum_));
  }
  state.basis.rightCols(nuisance_.cols()) = nuisance_;
  if (grows_beyond_bounds(logs) || !state.basis.allFinite()) {  // fits nothing
    state.shares = Eigen::VectorXd::Zero(state.basis.cols());
    state.residual = data_;
    state.sum_of_squares = std::numeric_limits<double>::infinity();
    return state;
  }
  const Eigen::RowVectorXd size = state.basis.colwise().norm().cwiseMax(1e-300);
  state.shares = core::least_squares(state.basis * size.cwiseInverse().asDiagonal(), data_)
                     .solution.cwiseQuotient(size.transpose());
  state.residual = data_ - state.basis * state.shares;
  state.sum_of_squares = state.residual.squaredNorm();
  return state;
}

Eigen::MatrixXd DecayModel::jacobian(const State& state) const {
  Eigen::MatrixXd result{data_.size(), unknowns()};
  for (Eigen::Index k = 0; k < poles_; ++k) {
    const Complex share{state.shares[2 * k], -state.shares[2 * k + 1]};
    const CutExponential slopes =
        cut_exponential_slope(share, log_of_pole(state.logs, k), spectrum_);
    result.col(2 * k) = stacked(slopes.plus) / length_;
    result.col(2 * k + 1) = stacked(Complex{0.0, 1.0} * slopes.minus) / length_;
  }
  result.rightCols(2 * poles_ + nuisance_.cols()) = state.basis;
  return result;
}

Eigen::MatrixXd DecayModel::column_slopes(const State& state, Eigen::Index pole) const {
  const std::array<Complex, 2> shares{Complex{1.0, 0.0}, Complex{0.0, -1.0}};  // of cosine and sine
  Eigen::MatrixXd result{data_.size(), 4};
  for (Eigen::Index i = 0; i < 2; ++i) {
    const CutExponential slopes = cut_exponential_slope(shares.at(static_cast<std::size_t>(i)),
                                                        log_of_pole(state.logs, pole), spectrum_);
    result.col(i) = stacked(slopes.plus) / length_;
    result.col(2 + i) = stacked(Complex{0.0, 1.0} * slopes.minus) / length_;
  }
  return result;
}

Eigen::VectorXd DecayModel::logs_of(const std::vector<Pole>& poles) const {
  Eigen::VectorXd logs{2 * std::ssize(poles)};
  for (Eigen::Index k = 0; k < std::ssize(poles); ++k) {
    const Complex log_z = log_of(poles[static_cast<std::size_t>(k)], spectrum_.rate_hz);
    logs.segment<2>(2 * k) << std::min(log_z.real() * length_, max_growth), log_z.imag() * length_;
  }
  return logs;
}
}  // namespace tapstudy::analysis
