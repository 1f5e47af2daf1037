#include "analysis/modal_identification/matrix_pencil.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

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

// Phi = V1^+ V2, where V1' V1 = I - v v' with v the last row of V (Sherman-Morrison).
Eigen::MatrixXd shift_matrix(const Eigen::MatrixXd& singular_vectors) {
  const Eigen::Index rows = singular_vectors.rows() - 1;
  const Eigen::MatrixXd product =
      singular_vectors.topRows(rows).transpose() * singular_vectors.bottomRows(rows);
  const Eigen::VectorXd last = singular_vectors.row(rows).transpose();
  return product + last * (last.transpose() * product) / std::max(1.0 - last.squaredNorm(), 1e-12);
}

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

// Most singular values are noise's; its largest is below three times what three quarters of all
// exceed.
int count_above_noise(const Eigen::VectorXd& singular_values) {
  const Eigen::Index half = singular_values.size() / 2;
  const double limit = std::max(3.0 * singular_values[half + half / 2], 1e-7 * singular_values[0]);
  return static_cast<int>((singular_values.array() > limit).count());
}

MatrixPencil read_gram(Eigen::MatrixXd gram, double rate_hz, const Band& band, int max_order) {
  const Eigen::Index pencil = gram.cols() - 1;
  const core::EigenPairs pairs = core::symmetric_eigenpairs(std::move(gram));
  MatrixPencil result;
  result.singular_values = pairs.values.reverse().cwiseMax(0.0).cwiseSqrt();
  result.significant_order = count_above_noise(result.singular_values);
  const int last = std::min(
      {max_order, result.significant_order + further_orders, static_cast<int>(pencil) - 2});
  for (int order = 2; order <= last; order += 2) {
    const Eigen::VectorXcd z = core::eigenvalues(shift_matrix(pairs.vectors.rightCols(order)));
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
}  // namespace tapstudy::analysis
