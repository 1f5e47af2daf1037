#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// A difference between two conditions, one value a participant (NaN and infinity are refused).
struct PairedContrast {
  double mean{};
  std::optional<Interval> interval;  // 95 %, by t; unset for one participant or equal differences
  double p{};                        // two-sided, by sign_flip_p
  int participants{};
  bool is_exact{};  // p is of all sign patterns
};

// The permutation test of paired differences (Fisher 1935): if the conditions do not matter, each
// participant's difference might as well have had the other sign. p is the share of sign patterns
// whose sum is at least as far from 0; of all patterns for up to 16 differences that are not 0,
// else monte_carlo_p of 9999 random patterns. It is valid however participants differ. Throws
// InvalidInput for no differences, and for differences that are not finite.
struct SignFlipTest {
  double p{};
  bool is_exact{};
};
SignFlipTest sign_flip_test(const std::vector<double>& differences, std::uint64_t seed);

PairedContrast paired_contrast(const std::vector<double>& differences, std::uint64_t seed);
}  // namespace tapstudy::analysis
