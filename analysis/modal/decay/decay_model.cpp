#include "analysis/modal/decay/decay_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/algebra/blas.hpp"
#include "core/algebra/lapack.hpp"
namespace tapstudy::analysis {
namespace {
using Complex = std::complex<double>;

// Complex numbers, one a bin. Parts apart, because processors multiply several of them at a time
// so.
struct Parts {
  Eigen::ArrayXd real;
  Eigen::ArrayXd imag;
  void set(Eigen::Index bin, const Complex& value) {
    real[bin] = value.real();
    imag[bin] = value.imag();
  }
};

// a (b + add)
Parts product(const Parts& a, const Parts& b, const Complex& add = {}) {
  return {a.real * (b.real + add.real()) - a.imag * (b.imag + add.imag()),
          a.real * (b.imag + add.imag()) + a.imag * (b.real + add.real())};
}

// Sums over n = 0 ... N - 1 of z^n q^n and, times n, of n z^n q^n, at every bin's q; q^N = 1 there.
// Near z q = 1, where the quotient loses its digits, by the series.
class GeometricSums {
 public:
  GeometricSums(const Complex& log_z, const BandSpectrum& spectrum)
      : log_z_{log_z},
        length_{static_cast<double>(spectrum.length)},
        z_to_length_{std::exp(log_z * length_)},
        spectrum_{spectrum} {
    const Complex z = std::exp(log_z);
    const Parts delay{spectrum.delay.real(), spectrum.delay.imag()};
    turned_ = {z.real() * delay.real - z.imag() * delay.imag,
               z.real() * delay.imag + z.imag() * delay.real};
    const Eigen::ArrayXd per_square =
        ((1.0 - turned_.real).square() + turned_.imag.square()).inverse();
    inverse_ = {(1.0 - turned_.real) * per_square, turned_.imag * per_square};
  }

  Parts values() const {
    const Complex n = 1.0 - z_to_length_;
    Parts all{n.real() * inverse_.real - n.imag() * inverse_.imag,
              n.real() * inverse_.imag + n.imag() * inverse_.real};
    for (const Eigen::Index bin : bins_near_one()) {
      all.set(bin, value_near_one(exponent(bin)));
    }
    return all;
  }
  // The derivatives of the values by ln z.
  Parts slopes() const {
    Parts all = product(inverse_, product(values(), turned_), -length_ * z_to_length_);
    for (const Eigen::Index bin : bins_near_one()) {
      all.set(bin, slope_near_one(exponent(bin)));
    }
    return all;
  }

 private:
  Complex exponent(Eigen::Index bin) const {
    return {log_z_.real(), log_z_.imag() - spectrum_.rad_per_sample[bin]};
  }
  std::vector<Eigen::Index> bins_near_one() const {
    constexpr double near = 1e-3;
    std::vector<Eigen::Index> bins;
    if (std::abs(log_z_.real()) * length_ < near) {
      for (Eigen::Index bin = 0; bin < spectrum_.rad_per_sample.size(); ++bin) {
        if (std::norm(exponent(bin)) * length_ * length_ < near * near) {
          bins.push_back(bin);
        }
      }
    }
    return bins;
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
  double length_;
  Complex z_to_length_;
  const BandSpectrum& spectrum_;
  Parts turned_;   // z q
  Parts inverse_;  // 1 / (1 - z q)
};

// Of an exponential and of its conjugate.
struct BothSums {
  Parts of_z;
  Parts of_conjugate;
};
BothSums values_of(const Complex& log_z, const BandSpectrum& spectrum) {
  return {GeometricSums{log_z, spectrum}.values(),
          GeometricSums{std::conj(log_z), spectrum}.values()};
}
BothSums slopes_of(const Complex& log_z, const BandSpectrum& spectrum) {
  return {GeometricSums{log_z, spectrum}.slopes(),
          GeometricSums{std::conj(log_z), spectrum}.slopes()};
}

Parts half_sum(const BothSums& both) {
  return {(both.of_z.real + both.of_conjugate.real) / 2.0,
          (both.of_z.imag + both.of_conjugate.imag) / 2.0};
}
Parts half_difference(const BothSums& both) {
  return {(both.of_z.real - both.of_conjugate.real) / 2.0,
          (both.of_z.imag - both.of_conjugate.imag) / 2.0};
}

// c times the sum of z, its conjugate times that of the conjugate.
BothSums times(const Complex& c, const BothSums& both) {
  const auto scaled = [](const Complex& by, const Parts& parts) {
    return Parts{by.real() * parts.real - by.imag() * parts.imag,
                 by.real() * parts.imag + by.imag() * parts.real};
  };
  return {scaled(c, both.of_z), scaled(std::conj(c), both.of_conjugate)};
}

CutExponential as_complex(const BothSums& both) {
  const auto joined = [](const Parts& parts) {
    Eigen::VectorXcd all{parts.real.size()};
    all.real() = parts.real.matrix();
    all.imag() = parts.imag.matrix();
    return all;
  };
  return {joined(half_sum(both)), joined(half_difference(both))};
}
}  // namespace

CutExponential cut_exponential(const std::complex<double>& log_z, const BandSpectrum& spectrum) {
  return as_complex(values_of(log_z, spectrum));
}

CutExponential cut_exponential_slope(const std::complex<double>& c,
                                     const std::complex<double>& log_z,
                                     const BandSpectrum& spectrum) {
  return as_complex(times(c, slopes_of(log_z, spectrum)));
}

namespace {
constexpr Eigen::Index smooth_terms = 4;
constexpr double max_growth = 30.0;

// scale times (half the sum) and times (j half the difference).
void set_pair(const BothSums& both, double scale, Eigen::Index plus, Eigen::Index minus,
              Eigen::MatrixXd& columns) {
  const Parts sum = half_sum(both);
  const Parts difference = half_difference(both);
  const Eigen::Index bins = sum.real.size();
  columns.col(plus).head(bins) = scale * sum.real;
  columns.col(plus).tail(bins) = scale * sum.imag;
  columns.col(minus).head(bins) = -scale * difference.imag;
  columns.col(minus).tail(bins) = scale * difference.real;
}

// The columns of cosine and sine.
void set_oscillation(const Complex& log_z, const BandSpectrum& spectrum, Eigen::Index first,
                     Eigen::MatrixXd& columns) {
  set_pair(values_of(log_z, spectrum), 1.0, first, first + 1, columns);
  columns.col(first + 1) *= -1.0;
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
    set_oscillation(log_z, spectrum, smooth_terms + 2 * k, nuisance_);
  }
}

DecayModel::State DecayModel::at(const Eigen::VectorXd& logs) const {
  State state{logs, {}, Eigen::MatrixXd{data_.size(), 2 * poles_ + nuisance_.cols()}, {}, {}, 0.0};
  for (Eigen::Index k = 0; k < poles_; ++k) {
    set_oscillation(log_of_pole(logs, k), spectrum_, 2 * k, state.basis);
  }
  state.basis.rightCols(nuisance_.cols()) = nuisance_;
  if (grows_beyond_bounds(logs) || !state.basis.allFinite()) {  // fits nothing
    state.shares = Eigen::VectorXd::Zero(state.basis.cols());
    state.gram = Eigen::MatrixXd::Zero(state.basis.cols(), state.basis.cols());
    state.residual = data_;
    state.sum_of_squares = std::numeric_limits<double>::infinity();
    return state;
  }
  state.gram = core::gram(state.basis);
  state.shares = core::least_squares(state.basis, state.gram, data_).solution;
  state.residual = data_ - state.basis * state.shares;
  state.sum_of_squares = state.residual.squaredNorm();
  return state;
}

Eigen::MatrixXd DecayModel::pole_slopes(const State& state) const {
  Eigen::MatrixXd result{data_.size(), 2 * poles_};
  for (Eigen::Index k = 0; k < poles_; ++k) {
    const Complex share{state.shares[2 * k], -state.shares[2 * k + 1]};
    const BothSums slopes = times(share, slopes_of(log_of_pole(state.logs, k), spectrum_));
    set_pair(slopes, 1.0 / length_, 2 * k, 2 * k + 1, result);
  }
  return result;
}

Eigen::MatrixXd DecayModel::information(const State& state,
                                        const Eigen::MatrixXd& pole_slopes) const {
  const Eigen::Index shares = state.basis.cols();
  Eigen::MatrixXd all{unknowns(), unknowns()};
  all.topLeftCorner(2 * poles_, 2 * poles_) = core::gram(pole_slopes);
  all.topRightCorner(2 * poles_, shares) = core::inner_products(pole_slopes, state.basis);
  all.bottomLeftCorner(shares, 2 * poles_) = all.topRightCorner(2 * poles_, shares).transpose();
  all.bottomRightCorner(shares, shares) = state.gram;
  return all;
}

Eigen::MatrixXd DecayModel::column_slopes(const State& state, Eigen::Index pole) const {
  const BothSums slopes = slopes_of(log_of_pole(state.logs, pole), spectrum_);
  Eigen::MatrixXd result{data_.size(), 4};
  set_pair(slopes, 1.0 / length_, 0, 2, result);                             // of cosine
  set_pair(times(Complex{0.0, -1.0}, slopes), 1.0 / length_, 1, 3, result);  // of sine
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
