#pragma once
#include <span>
#include <vector>

#include "protocols/procedures/likelihood_table.hpp"
#include "protocols/procedures/procedure.hpp"
namespace tapstudy::protocols {
// The posterior updated by Bayes' rule: prior times likelihood of one outcome, normalised. Throws
// InvalidInput if that is 0 everywhere.
std::vector<double> updated(std::span<const double> posterior, std::span<const double> likelihoods);

// Entropy of the posterior that is to be expected after a trial of each stimulus, in nats (Watson
// 2017, eq. 3 to 6), nuisances summed over (Prins 2013).
std::vector<double> expected_entropies(const LikelihoodTable& table,
                                       std::span<const double> posterior);

// The stimulus of least expected entropy. Of those within `entropy_tie` nats of the least, the
// first in the order of the table, so that rounding, which differs between machines, decides
// nothing.
inline constexpr double entropy_tie = 1e-10;
std::size_t most_informative(std::span<const double> entropies);

// Marginal posterior of each parameter.
std::vector<ParameterPosterior> marginals(const LikelihoodTable& table,
                                          std::span<const double> posterior);
double standard_deviation(const LikelihoodTable& table, std::span<const double> posterior,
                          std::size_t parameter);
}  // namespace tapstudy::protocols
