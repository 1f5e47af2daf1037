#include "analysis/modal_identification/cut_exponential.hpp"

#include <cmath>
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
  const Complex above = 1.0 - z_to_length;
  return {above / below, -length * z_to_length / below + above * x / (below * below)};
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
}  // namespace tapstudy::analysis
