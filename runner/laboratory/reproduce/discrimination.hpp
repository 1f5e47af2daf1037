#pragma once
#include <cstdint>
#include <vector>

#include "analysis/statistics/confusion_matrix.hpp"
namespace tapstudy::runner {
// Answers as multinomial draws, a row for each stimulus.
using Rows = std::vector<std::size_t>;
using Probabilities = std::vector<std::vector<double>>;  // each above 0, each row sums to 1

// Response probabilities estimated from answers; half an answer is added to each cell, so that none
// is impossible.
Probabilities probabilities_of(const analysis::CountTable& answers);

// The log-likelihood of these rows: the sum of counts times logarithms of probabilities, without
// the terms that do not depend on the probabilities.
double log_likelihood(const analysis::CountTable& counts, const Rows& rows,
                      const Probabilities& probabilities);

// The multinomial test by drawing: of 4000 tables drawn with the row totals of the counts, the
// share that is no more probable than these, both increased by one (Davison & Hinkley 1997).
double multinomial_p(const analysis::CountTable& counts, const Rows& rows,
                     const Probabilities& probabilities, std::uint64_t seed);

// The same where the probabilities are known from so many answers only: each table is drawn from
// probabilities that are drawn before, of their posterior, Dirichlet with the answers and a half
// added to each.
double predictive_p(const analysis::CountTable& counts, const Rows& rows,
                    const analysis::CountTable& answers, std::uint64_t seed);
}  // namespace tapstudy::runner
