#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/statistics/confusion_matrix.hpp"
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
  // The asymptotic p of g_squared; 1 without degrees of freedom. All answers count as independent.
  double p{};
};
// Refused for fewer than two classes or more than 40, for a class that was never answered right,
// and where the fit does not settle. Throws InvalidInput as totals_of_square does.
SimilarityChoice similarity_choice(const CountTable& table);

// The p of g_squared conditional on the totals of rows, columns and pairs, for counts too small for
// chi-squared: exact whatever the parameters, by a Markov chain over the tables with these totals
// (Agresti 1992), as many of them drawn before as after the observed table, at a random place
// (Besag & Clifford 1989). A step adds 1 along a cycle of classes and subtracts 1 along its
// reverse. All answers count as independent. Beyond the largest number of answers, p is that of
// chi-squared and draws is 0.
struct ConditionalFit {
  double p{};
  int draws{};
};
ConditionalFit conditional_fit(const CountTable& table, const SimilarityChoice& model,
                               std::uint64_t seed);

// A map on which the distances between points are about those given.
struct ScaledMap {
  std::vector<std::vector<double>> points;  // points[i][dimension], around the origin
  std::vector<double> eigenvalues;          // of the dimensions, descending
  double explained{};  // their share of the sum of the absolute values of all eigenvalues
};
// Classical multidimensional scaling (Torgerson 1952; Gower 1966): eigenvectors of the doubly
// centred -d^2 / 2. The largest coordinate of a dimension is positive; dimensions whose eigenvalue
// is not above 0 have all points at 0. Throws InvalidInput for distances that are not a square,
// symmetric table of finite numbers not below 0 with a diagonal of 0, and dimensions outside 1 to
// the number of points.
ScaledMap classical_scaling(const std::vector<std::vector<double>>& distances, int dimensions);

// d_ij = -ln eta_ij (Shepard 1957), 0 for similarities above 1. Throws InvalidInput for a
// similarity that is not above 0.
std::vector<std::vector<double>> distances_of(const std::vector<std::vector<double>>& similarities);
}  // namespace tapstudy::analysis
