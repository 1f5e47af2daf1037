#include "analysis/psychometric/pooling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/statistics/distributions.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
// Of weights 1 / (standard_error^2 + between).
struct WeightedMean {
  double mean{};
  double weight{};         // sum w
  double square_weight{};  // sum w^2
  double squares{};        // sum w (y - mean)^2
};

WeightedMean weighted(const std::vector<ParticipantEstimate>& participants, double between) {
  const auto weight_of = [&](const ParticipantEstimate& one) {
    return 1.0 / (one.standard_error * one.standard_error + between);
  };
  WeightedMean sums;
  for (const ParticipantEstimate& one : participants) {
    const double weight = weight_of(one);
    sums.weight += weight;
    sums.square_weight += weight * weight;
    sums.mean += weight * one.value;
  }
  sums.mean /= sums.weight;
  for (const ParticipantEstimate& one : participants) {
    sums.squares += weight_of(one) * (one.value - sums.mean) * (one.value - sums.mean);
  }
  return sums;
}

void check(const std::vector<ParticipantEstimate>& participants) {
  if (participants.size() < 2) {
    throw core::InvalidInput{
        fmt::format("a mean over participants takes two or more, not {}", participants.size())};
  }
  for (const ParticipantEstimate& one : participants) {
    if (!std::isfinite(one.value) || !(one.standard_error > 0.0) ||
        !std::isfinite(one.standard_error)) {
      throw core::InvalidInput{fmt::format(
          "an estimate is a finite number with a finite standard error above 0, not {} with {}",
          one.value, one.standard_error)};
    }
  }
}
}  // namespace

PooledEstimate pooled(const std::vector<ParticipantEstimate>& participants) {
  check(participants);
  const double degrees = static_cast<double>(participants.size()) - 1.0;
  const WeightedMean fixed = weighted(participants, 0.0);
  PooledEstimate result;
  result.heterogeneity = fixed.squares;
  result.heterogeneity_p = chi_squared_p(fixed.squares, degrees);
  result.between_variance = std::max(
      0.0, (fixed.squares - degrees) / (fixed.weight - fixed.square_weight / fixed.weight));
  const WeightedMean random = weighted(participants, result.between_variance);
  result.mean = random.mean;
  result.standard_error = std::sqrt(random.squares / (degrees * random.weight));
  const double half_width = t_quantile(0.975, degrees) * result.standard_error;
  result.interval = {result.mean - half_width, result.mean + half_width};
  return result;
}
}  // namespace tapstudy::analysis
