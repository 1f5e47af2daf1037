#include "analysis/participants/random_effects.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/distributions.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
struct Weighted {
  double mean{};
  double weights{};  // their sum
  double squares{};  // of the weighted residuals
};

Weighted weighted(const std::vector<double>& values, const std::vector<double>& errors,
                  double between_variance) {
  const auto weight = [&](std::size_t i) {
    return 1.0 / (errors[i] * errors[i] + between_variance);
  };
  Weighted of;
  for (std::size_t i = 0; i < values.size(); ++i) {
    of.weights += weight(i);
    of.mean += weight(i) * values[i];
  }
  of.mean /= of.weights;
  for (std::size_t i = 0; i < values.size(); ++i) {
    of.squares += weight(i) * (values[i] - of.mean) * (values[i] - of.mean);
  }
  return of;
}

// The weighted squares fall as the variance between people grows: by bisection.
double between_variance(const std::vector<double>& values, const std::vector<double>& errors) {
  constexpr int halvings = 200;
  const double expected = static_cast<double>(values.size()) - 1.0;
  const auto [least, most] = std::ranges::minmax(values);
  double low = 0.0;
  double high =
      (most - least) * (most - least);  // weights of at most 1 / high: squares below n / 4
  if (weighted(values, errors, low).squares <= expected) {
    return 0.0;
  }
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (weighted(values, errors, middle).squares > expected ? low : high) = middle;
  }
  return low;
}
}  // namespace

RandomEffects random_effects(const std::vector<double>& values, const std::vector<double>& errors) {
  const auto is_error = [](double error) { return error > 0.0 && std::isfinite(error); };
  if (values.size() < 2 || errors.size() != values.size() ||
      !std::ranges::all_of(errors, is_error)) {
    throw core::InvalidInput{"random effects take two values or more, each with its error"};
  }
  const double between = between_variance(values, errors);
  const Weighted of = weighted(values, errors, between);
  const double freedom = static_cast<double>(values.size()) - 1.0;
  const double half = t_quantile(0.975, freedom) / std::sqrt(of.weights);
  return {of.mean, std::sqrt(between), {of.mean - half, of.mean + half}};
}
}  // namespace tapstudy::analysis
