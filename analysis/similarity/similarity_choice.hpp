#pragma once
#include <string>
#include <vector>

#include "analysis/statistics/count_table.hpp"
namespace tapstudy::analysis {
// The similarity-choice model of a confusion matrix (Luce 1963; Shepard 1957): class i is answered
// with j with probability b_j eta_ij / sum_m b_m eta_im, with biases b that add up to 1 and
// similarities eta_ij = eta_ji, eta_ii = 1. As a model of counts it is quasi-symmetry
// (Caussinus 1965), whose maximum likelihood is found by iterative proportional fitting to
// the totals of rows, columns and pairs n_ij + n_ji (Townsend & Landon 1982).
struct SimilarityChoice {
  std::string refusal;                            // why there is no fit; empty: there is
  std::vector<double> biases;                     // b_j
  std::vector<std::vector<double>> similarities;  // eta_ij; 0 where a pair was never confused
  double g_squared{};                             // 2 sum n_ij ln(n_ij / fitted)
  // (k - 1)(k - 2) / 2 less the pairs that were never confused, not below 0
  int degrees_of_freedom{};
  double p{};  // of g_squared; 1 without degrees of freedom; all answers count as independent
};
// Refused for fewer than two classes or more than 40, for a class that was never answered right,
// and where the fit does not settle. Throws InvalidInput as totals_of_square does.
SimilarityChoice similarity_choice(const CountTable& table);
}  // namespace tapstudy::analysis
