#include "analysis/modal/decay/pole_estimation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "analysis/statistics/quantiles.hpp"
#include "core/algebra/blas.hpp"
#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr Eigen::Index max_pencil = 400;
constexpr Eigen::Index min_pencil = 8;
constexpr int further_orders = 20;  // weak modes hide among the noise's singular values
constexpr double max_damping_ratio = 0.7;

// Y' Y of the Hankel matrix Y(r, c) = y(r + c) with so many columns.
Eigen::MatrixXd hankel_gram(const Eigen::VectorXd& y, Eigen::Index columns) {
  const Eigen::Index rows = y.size() - columns + 1;
  Eigen::MatrixXd gram{columns, columns};
  for (Eigen::Index c = 0; c < columns; ++c) {
    gram(c, 0) = y.segment(c, rows).dot(y.head(rows));
  }
  for (Eigen::Index j = 1; j < columns; ++j) {
    for (Eigen::Index i = j; i < columns; ++i) {
      gram(i, j) = gram(i - 1, j - 1) - y[i - 1] * y[j - 1] + y[i - 1 + rows] * y[j - 1 + rows];
    }
  }
  return gram;
}

// Phi = V1^+ V2 of the last columns of V, where V1' V1 = I - v v' with v the last row of V
// (Sherman-Morrison).
class ShiftMatrices {
 public:
  explicit ShiftMatrices(const Eigen::MatrixXd& singular_vectors)
      : products_{core::inner_products(singular_vectors.topRows(singular_vectors.rows() - 1),
                                       singular_vectors.bottomRows(singular_vectors.rows() - 1))},
        last_row_{singular_vectors.bottomRows(1).transpose()} {}

  Eigen::MatrixXd of_order(Eigen::Index order) const {
    const Eigen::MatrixXd product = products_.bottomRightCorner(order, order);
    const Eigen::VectorXd last = last_row_.tail(order);
    return product +
           last * (last.transpose() * product) / std::max(1.0 - last.squaredNorm(), 1e-12);
  }

 private:
  Eigen::MatrixXd products_;
  Eigen::VectorXd last_row_;
};

std::vector<Pole> poles_in(const Eigen::VectorXcd& eigenvalues, double rate_hz, const Band& band) {
  std::vector<Pole> poles;
  for (const std::complex<double>& z : eigenvalues) {
    if (z.imag() > 0.0) {
      const Pole pole = pole_of(std::log(z), rate_hz);
      if (band.holds(pole.frequency_hz) && std::abs(pole.damping_ratio) < max_damping_ratio) {
        poles.push_back(pole);
      }
    }
  }
  std::ranges::sort(poles, {}, &Pole::frequency_hz);
  return poles;
}

// Counts the singular values above the noise. Most of them are the noise's, whose largest lies
// below three times the lower quartile of all.
int count_above_noise(const Eigen::VectorXd& singular_values) {
  const Eigen::Index half = singular_values.size() / 2;
  const double limit = std::max(3.0 * singular_values[half + half / 2], 1e-7 * singular_values[0]);
  return static_cast<int>((singular_values.array() > limit).count());
}

MatrixPencil read_gram(Eigen::MatrixXd gram, double rate_hz, const Band& band, int max_order) {
  const Eigen::Index pencil = gram.cols() - 1;
  const Eigen::Index most = std::clamp<Eigen::Index>(max_order, 0, pencil - 2);
  const core::EigenPairs pairs = core::largest_eigenpairs(std::move(gram), most);
  MatrixPencil result;
  result.singular_values = pairs.values.reverse().cwiseMax(0.0).cwiseSqrt();
  result.significant_order = count_above_noise(result.singular_values);
  const int last = std::min(result.significant_order + further_orders, static_cast<int>(most));
  const ShiftMatrices shifts{pairs.vectors};
  for (int order = 2; order <= last; order += 2) {
    const Eigen::VectorXcd z = core::eigenvalues(shifts.of_order(order));
    result.orders.push_back({order, poles_in(z, rate_hz, band)});
  }
  return result;
}
}  // namespace

MatrixPencil matrix_pencil(const FreeDecay& decay, const Band& band, int max_order) {
  const FreeDecay slow = decimated(decay, band.high_hz);
  const Eigen::Index pencil = std::min(slow.samples.size() / 3, max_pencil);
  if (pencil < min_pencil) {
    throw core::InvalidInput{
        fmt::format("{:.3g} s are too short to find modes up to {:g} Hz (at least {:.3g} s)",
                    decay.duration_s(), band.high_hz,
                    decay.duration_s() - slow.duration_s() + 3.0 * min_pencil / slow.rate_hz)};
  }
  return read_gram(hankel_gram(slow.samples, pencil + 1), slow.rate_hz, band, max_order);
}

MatrixPencil matrix_pencil(const std::vector<FreeDecay>& decays, const std::vector<double>& noise,
                           const Band& band, int max_order) {
  std::vector<FreeDecay> slow;
  std::vector<Eigen::Index> lengths;
  for (const FreeDecay& decay : decays) {
    slow.push_back(decimated(decay, band.high_hz));
    lengths.push_back(slow.back().samples.size());
  }
  std::ranges::nth_element(lengths, lengths.begin() + std::ssize(lengths) / 2);
  const Eigen::Index pencil = std::min(lengths[lengths.size() / 2] / 3, max_pencil);
  if (pencil < min_pencil) {
    return {};
  }
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(pencil + 1, pencil + 1);
  for (std::size_t i = 0; i < decays.size(); ++i) {
    if (slow[i].samples.size() >= 2 * pencil) {
      gram += hankel_gram(slow[i].samples, pencil + 1) / (noise[i] * noise[i]);
    }
  }
  return read_gram(std::move(gram), slow.front().rate_hz, band, max_order);
}

namespace {
struct Chain {
  int last_order{};
  std::vector<double> frequencies_hz;
  std::vector<double> ratios;
  Pole last() const { return {frequencies_hz.back(), ratios.back()}; }
};

// The chain that ends at the order before and nearest to the pole.
Chain* continued_by(std::vector<Chain>& chains, const Pole& pole, int order) {
  Chain* nearest = nullptr;
  double least = 0.0;
  for (Chain& chain : chains) {
    const double distance = std::abs(chain.last().frequency_hz - pole.frequency_hz);
    if (chain.last_order == order - 2 && continues(chain.last(), pole) &&
        (nearest == nullptr || distance < least)) {
      nearest = &chain;
      least = distance;
    }
  }
  return nearest;
}

std::vector<Chain> chains_of(const std::vector<PolesOfOrder>& orders) {
  std::vector<Chain> chains;
  for (const PolesOfOrder& one : orders) {
    for (const Pole& pole : one.poles) {
      Chain* chain = continued_by(chains, pole, one.order);
      if (chain == nullptr) {
        chain = &chains.emplace_back();
      }
      chain->last_order = one.order;
      chain->frequencies_hz.push_back(pole.frequency_hz);
      chain->ratios.push_back(pole.damping_ratio);
    }
  }
  return chains;
}
}  // namespace

bool continues(const Pole& from, const Pole& to) {
  const double ratio_tolerance = std::max(0.003, 0.1 * std::abs(from.damping_ratio));
  return std::abs(to.frequency_hz - from.frequency_hz) <= frequency_tolerance_hz(from, 0.01) &&
         std::abs(to.damping_ratio - from.damping_ratio) <= ratio_tolerance;
}

std::vector<StablePole> stable_poles(const std::vector<PolesOfOrder>& orders) {
  std::vector<StablePole> found;
  for (const Chain& chain : chains_of(orders)) {
    const auto length = static_cast<int>(chain.ratios.size());
    if (length >= min_stable_orders) {
      found.push_back({{quantile(chain.frequencies_hz, 0.5), quantile(chain.ratios, 0.5)}, length});
    }
  }
  std::ranges::stable_sort(found, std::ranges::greater{}, &StablePole::orders);
  std::vector<StablePole> distinct;
  for (const StablePole& one : found) {
    if (std::ranges::none_of(
            distinct, [&](const StablePole& longer) { return continues(longer.pole, one.pole); })) {
      distinct.push_back(one);
    }
  }
  std::ranges::sort(distinct, {}, [](const StablePole& one) { return one.pole.frequency_hz; });
  return distinct;
}

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
  const Eigen::ArrayXcd z = spectrum.delay.conjugate();
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
