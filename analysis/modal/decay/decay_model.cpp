#include "analysis/modal/decay/decay_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/algebra/lapack.hpp"
namespace tapstudy::analysis {
namespace {
using Complex = std::complex<double>;

// sum of e^(n u), n = 0 ... N - 1, and its derivative by u. Near u = 0, where the quotient loses
// its digits, the series.
struct GeometricSum {
  Complex value;
  Complex slope;
};
GeometricSum geometric_sum(const Complex& u, const Complex& z_to_length, double length) {
  if (std::abs(u) * length < 1e-3) {
    const double first = length * (length - 1.0) / 2.0;
    const double second = first * (2.0 * length - 1.0) / 3.0;
    const double third = first * first;
    return {length + u * (first + u * (second / 2.0 + u * third / 6.0)),
            first + u * (second + u * third / 2.0)};
  }
  const Complex x = std::exp(u);
  const Complex below = 1.0 - x;
  const Complex inverse = std::conj(below) / std::norm(below);  // quicker than complex division
  const Complex value = (1.0 - z_to_length) * inverse;
  return {value, (value * x - length * z_to_length) * inverse};
}

struct Transforms {
  Eigen::VectorXcd value;
  Eigen::VectorXcd slope;
};
Transforms transforms_of(const Complex& log_z, const BandSpectrum& spectrum) {
  const Eigen::Index bins = spectrum.values.size();
  const auto length = static_cast<double>(spectrum.length);
  const Complex z_to_length = std::exp(log_z * length);  // q^N = 1 at every bin
  Transforms result{Eigen::VectorXcd(bins), Eigen::VectorXcd(bins)};
  for (Eigen::Index k = 0; k < bins; ++k) {
    const GeometricSum sum =
        geometric_sum(log_z - Complex{0.0, spectrum.rad_per_sample[k]}, z_to_length, length);
    result.value[k] = sum.value;
    result.slope[k] = sum.slope;
  }
  return result;
}
}  // namespace

CutExponential cut_exponential(const std::complex<double>& log_z, const BandSpectrum& spectrum) {
  const Transforms of_z = transforms_of(log_z, spectrum);
  const Transforms of_conjugate = transforms_of(std::conj(log_z), spectrum);
  return {(of_z.value + of_conjugate.value) / 2.0, (of_z.value - of_conjugate.value) / 2.0};
}

CutExponential cut_exponential_slope(const std::complex<double>& c,
                                     const std::complex<double>& log_z,
                                     const BandSpectrum& spectrum) {
  const Transforms of_z = transforms_of(log_z, spectrum);
  const Transforms of_conjugate = transforms_of(std::conj(log_z), spectrum);
  const Complex conjugate = std::conj(c);
  return {(c * of_z.slope + conjugate * of_conjugate.slope) / 2.0,
          (c * of_z.slope - conjugate * of_conjugate.slope) / 2.0};
}

namespace {
using Complex = std::complex<double>;
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
  const Eigen::ArrayXcd q = (Complex{0.0, -1.0} * spectrum.rad_per_sample.cast<Complex>()).exp();
  const auto lines = static_cast<Eigen::Index>(lines_hz.size());
  nuisance_ = Eigen::MatrixXd{data_.size(), smooth_terms + 2 * lines};
  nuisance_.col(0) = stacked((1.0 / (1.0 - q)).matrix());
  for (int power = 0; power < smooth_terms - 1; ++power) {
    nuisance_.col(power + 1) = stacked(q.pow(power).matrix());
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

Eigen::VectorXd DecayModel::logs_of(const std::vector<Pole>& poles) const {
  Eigen::VectorXd logs{2 * std::ssize(poles)};
  for (Eigen::Index k = 0; k < std::ssize(poles); ++k) {
    const Complex log_z = log_of(poles[static_cast<std::size_t>(k)], spectrum_.rate_hz);
    logs.segment<2>(2 * k) << std::min(log_z.real() * length_, max_growth), log_z.imag() * length_;
  }
  return logs;
}
}  // namespace tapstudy::analysis
