#include "analysis/recordings/innovation.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
namespace tapstudy::analysis {
namespace {
constexpr double predicted_rate_hz = 4000.0;
constexpr Eigen::Index order = 32;

Eigen::VectorXd averaged(const std::vector<double>& samples, std::size_t factor) {
  Eigen::VectorXd means(static_cast<Eigen::Index>(samples.size() / factor));
  for (Eigen::Index i = 0; i < means.size(); ++i) {
    const auto first = samples.begin() + i * static_cast<std::ptrdiff_t>(factor);
    double sum = 0.0;
    for (auto sample = first; sample != first + static_cast<std::ptrdiff_t>(factor); ++sample) {
      sum += *sample;
    }
    means[i] = sum / static_cast<double>(factor);
  }
  return means;
}

// x[n] is about the sum of coefficients[k] x[n - 1 - k]: the equations of Yule and Walker.
Eigen::VectorXd prediction_of(const Eigen::VectorXd& samples) {
  Eigen::VectorXd covariance(order + 1);
  for (Eigen::Index lag = 0; lag <= order; ++lag) {
    const Eigen::Index count = samples.size() - lag;
    covariance[lag] = samples.head(count).dot(samples.tail(count));
  }
  Eigen::MatrixXd toeplitz(order, order);
  for (Eigen::Index i = 0; i < order; ++i) {
    for (Eigen::Index j = 0; j < order; ++j) {
      toeplitz(i, j) = covariance[std::abs(i - j)];
    }
  }
  constexpr double load = 1e-9;  // of a recording without noise
  toeplitz.diagonal().array() += load * covariance[0];
  return toeplitz.ldlt().solve(covariance.tail(order));
}
}  // namespace

std::vector<double> innovation_energies(const std::vector<double>& samples, double rate_hz,
                                        std::size_t frame) {
  const auto factor =
      std::max<std::size_t>(1, static_cast<std::size_t>(rate_hz / predicted_rate_hz));
  const Eigen::VectorXd means = averaged(samples, factor);
  const std::size_t frames = samples.size() / frame;
  std::vector<double> energies(frames, 0.0);
  if (means.size() <= 2 * order) {
    return energies;
  }
  const Eigen::VectorXd backward = prediction_of(means).reverse();
  std::vector<int> counts(frames, 0);
  for (Eigen::Index i = order; i < means.size(); ++i) {
    const std::size_t of = static_cast<std::size_t>(i) * factor / frame;
    if (of < frames) {
      const double error = means[i] - backward.dot(means.segment(i - order, order));
      energies[of] += error * error;
      ++counts[of];
    }
  }
  for (std::size_t i = 0; i < frames; ++i) {
    energies[i] /= std::max(1, counts[i]);
  }
  return energies;
}
}  // namespace tapstudy::analysis
