#include "analysis/modal_identification/vector_fitting.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using Complex = std::complex<double>;
constexpr int max_relocations = 40;
constexpr double start_ratio = 0.01;
constexpr int further_terms = 3;

struct Poles {
  std::vector<Complex> upper;  // of each pair the one above the real axis
  std::vector<double> real;
  Eigen::Index count() const { return static_cast<Eigen::Index>(2 * upper.size() + real.size()); }
};

Poles spread_over(const BandSpectrum& spectrum, int pairs) {
  const double low = spectrum.rad_per_sample[0];
  const double high = spectrum.rad_per_sample[spectrum.rad_per_sample.size() - 1];
  Poles poles;
  for (int i = 0; i < pairs; ++i) {
    const double omega = low + (high - low) * (i + 0.5) / pairs;
    poles.upper.push_back(std::exp(Complex{-start_ratio * omega, omega}));
  }
  return poles;
}

// Partial fractions with real coefficients: of a pair 1/(z-p) + 1/(z-p*) and j/(z-p) - j/(z-p*).
Eigen::MatrixXcd partial_fractions(const Poles& poles, const Eigen::ArrayXcd& z) {
  Eigen::MatrixXcd columns{z.size(), poles.count()};
  Eigen::Index column = 0;
  for (const Complex& p : poles.upper) {
    const Eigen::ArrayXcd of_p = (z - p).inverse();
    const Eigen::ArrayXcd of_conjugate = (z - std::conj(p)).inverse();
    columns.col(column++) = of_p + of_conjugate;
    columns.col(column++) = Complex{0.0, 1.0} * (of_p - of_conjugate);
  }
  for (const double p : poles.real) {
    columns.col(column++) = (z - p).inverse();
  }
  return columns;
}

// The zeros of 1 + sum c / (z - p): eigenvalues of A - b c' in real form.
Poles zeros_of(const Poles& poles, const Eigen::VectorXd& c) {
  const Eigen::Index n = poles.count();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
  Eigen::Index row = 0;
  for (const Complex& p : poles.upper) {
    A.block<2, 2>(row, row) << p.real(), p.imag(), -p.imag(), p.real();
    b[row] = 2.0;
    row += 2;
  }
  for (const double p : poles.real) {
    A(row, row) = p;
    b[row++] = 1.0;
  }
  Poles zeros;
  for (Complex z : core::eigenvalues(A - b * c.transpose())) {
    if (std::abs(z) > 1.0) {
      z = 1.0 / std::conj(z);
    }
    if (z.imag() > 0.0) {
      zeros.upper.push_back(z);
    } else if (z.imag() == 0.0) {
      zeros.real.push_back(z.real());
    }
  }
  return zeros;
}

Poles relocated(const Poles& poles, const Eigen::ArrayXcd& z, const Eigen::VectorXcd& values) {
  const Eigen::Index n = poles.count();
  const Eigen::MatrixXcd fractions = partial_fractions(poles, z);
  Eigen::MatrixXcd system{z.size(), 2 * n + further_terms};
  system.leftCols(n) = fractions;
  system.col(n).setOnes();
  system.col(n + 1) = z;
  system.col(n + 2) = z / (z - 1.0);
  system.rightCols(n) = -(values.asDiagonal() * fractions);
  const Eigen::MatrixXd real = stacked(system);
  if (!real.allFinite()) {  // a pole on a frequency of the spectrum: there is nothing to relocate
    return {};
  }
  const Eigen::VectorXd size = real.colwise().norm().cwiseMax(1e-300).transpose();
  const Eigen::VectorXd solution =
      core::least_squares(real * size.cwiseInverse().asDiagonal(), stacked(values))
          .solution.cwiseQuotient(size);
  return zeros_of(poles, solution.tail(n));
}

std::vector<Pole> poles_inside(const Poles& poles, const BandSpectrum& spectrum) {
  std::vector<Pole> inside;
  for (const Complex& z : poles.upper) {
    const double omega = std::abs(std::log(z));
    if (omega >= spectrum.rad_per_sample[0] &&
        omega <= spectrum.rad_per_sample[spectrum.rad_per_sample.size() - 1]) {
      inside.push_back(pole_of(std::log(z), spectrum.rate_hz));
    }
  }
  std::ranges::sort(inside, {}, &Pole::frequency_hz);
  return inside;
}

bool has_settled(const std::vector<Pole>& before, const std::vector<Pole>& after) {
  return std::ranges::equal(before, after, [](const Pole& a, const Pole& b) {
    return std::abs(a.frequency_hz - b.frequency_hz) < 1e-7 * b.frequency_hz &&
           std::abs(a.damping_ratio - b.damping_ratio) < 1e-7;
  });
}
}  // namespace

std::vector<Pole> vector_fitting(const BandSpectrum& spectrum, int pairs) {
  if (4 * pairs + further_terms >= 2 * spectrum.values.size()) {
    throw core::InvalidInput{"a decay is too short for a rational fit of so many modes"};
  }
  const Eigen::ArrayXcd z = (Complex{0.0, 1.0} * spectrum.rad_per_sample.cast<Complex>()).exp();
  Poles poles = spread_over(spectrum, pairs);
  std::vector<Pole> found;
  for (int round = 0; round < max_relocations; ++round) {
    poles = relocated(poles, z, spectrum.values);
    std::vector<Pole> next = poles_inside(poles, spectrum);
    const bool is_done = has_settled(found, next);
    found = std::move(next);
    if (is_done) {
      break;
    }
  }
  return found;
}
}  // namespace tapstudy::analysis
