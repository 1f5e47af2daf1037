#pragma once
#include "analysis/paired/paired_counts.hpp"
#include "analysis/paired/preference_scale.hpp"
namespace tapstudy::analysis {
// Bradley & Terry 1952, Luce 1959, with ties after Davidson 1970. With values v,
//   P(i preferred to j) : P(j to i) : P(tie) = exp(v_i) : exp(v_j) : nu exp((v_i + v_j) / 2),
// so that without ties P(i to j) = 1 / (1 + exp(v_j - v_i)).
struct BradleyTerry {
  PreferenceScale scale;  // values are logarithms of the abilities
  double nu{};            // 0 without ties
};
// By maximum likelihood. Throws InvalidInput as check_comparisons does (ties do not connect: a nu
// that grows with the distance may explain them).
BradleyTerry bradley_terry(const PairedCounts& counts);
}  // namespace tapstudy::analysis
