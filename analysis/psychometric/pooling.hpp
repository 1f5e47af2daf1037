#pragma once
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// One participant's estimate (a threshold, or its logarithm) and its standard error.
struct ParticipantEstimate {
  double value{};
  double standard_error{};
};

// The mean over participants who differ: value_i ~ N(mean, tau^2 + standard_error_i^2).
struct PooledEstimate {
  double mean{};
  double standard_error{};    // by Hartung & Knapp 2001
  Interval interval;          // 95 %, by t with participants - 1 degrees of freedom
  double between_variance{};  // tau^2, by the moments of DerSimonian & Laird 1986; 0 if negative
  double heterogeneity{};     // Cochran's Q
  double heterogeneity_p{};   // by chi-squared with participants - 1 degrees of freedom
};
// Random-effects mean. Q = sum w_i (y_i - y_w)^2 with w_i = 1 / s_i^2; tau^2 = (Q - (k - 1)) /
// (sum w - sum w^2 / sum w); mean = sum v_i y_i / sum v with v_i = 1 / (s_i^2 + tau^2); its
// variance is sum v_i (y_i - mean)^2 / ((k - 1) sum v), which keeps its level with few participants
// (IntHout et al. 2014). Throws InvalidInput for fewer than two participants, standard errors that
// are not above 0, and values that are not finite.
PooledEstimate pooled(const std::vector<ParticipantEstimate>& participants);
}  // namespace tapstudy::analysis
