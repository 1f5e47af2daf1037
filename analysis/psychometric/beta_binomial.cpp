#include "analysis/psychometric/beta_binomial.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/psychometric/binomial_likelihood.hpp"
namespace tapstudy::analysis {
double beta_binomial_log_likelihood(const Proportion& answers, double p, double eta) {
  constexpr double smallest_p = 1e-12;   // beta distributions have no mean of 0 or 1
  constexpr double smallest_eta = 1e-4;  // below, rounding exceeds the difference from binomial
  const double mean = std::clamp(p, smallest_p, 1.0 - smallest_p);
  if (eta < smallest_eta) {
    return binomial_log_likelihood(answers, mean);
  }
  const double nu = 1.0 / (eta * eta) - 1.0;
  const auto n = static_cast<double>(answers.trials);
  const auto k = static_cast<double>(answers.successes);
  const double a = nu * mean;
  const double b = nu * (1.0 - mean);
  return std::lgamma(k + a) - std::lgamma(a) + std::lgamma(n - k + b) - std::lgamma(b) +
         std::lgamma(nu) - std::lgamma(n + nu);
}
}  // namespace tapstudy::analysis
