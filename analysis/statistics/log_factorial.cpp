#include "analysis/statistics/log_factorial.hpp"

#include <array>
#include <cmath>
#include <numbers>
namespace tapstudy::analysis {
namespace {
constexpr std::size_t tabulated = 1024;

std::array<double, tabulated> table_of_log_factorials() {
  std::array<double, tabulated> table{};
  for (std::size_t n = 1; n < tabulated; ++n) {
    table[n] = table[n - 1] + std::log(static_cast<double>(n));
  }
  return table;
}
}  // namespace

double log_factorial(std::int64_t n) {
  static const std::array<double, tabulated> table = table_of_log_factorials();
  if (n < static_cast<std::int64_t>(tabulated)) {
    return table[static_cast<std::size_t>(n)];
  }
  const auto x = static_cast<double>(n);
  return (x + 0.5) * std::log(x) - x + 0.5 * std::log(2.0 * std::numbers::pi) + 1.0 / (12.0 * x) -
         1.0 / (360.0 * x * x * x);
}
}  // namespace tapstudy::analysis
