#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/statistics/confusion_matrix.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/resampling/null_tables.hpp"
namespace tapstudy::analysis {
// Cohen's kappa (1960): agreement beyond that of the totals, (p_o - p_e) / (1 - p_e), with its
// large-sample standard error (Fleiss, Cohen & Everitt 1969) and the 95 % normal interval, not
// outside [-1, 1]. All answers count as independent.
struct Kappa {
  double kappa{};
  double standard_error{};
  Interval interval;
};
// Throws InvalidInput as totals_of_square does; unset without answers, and where all answers and
// stimuli are of one class.
std::optional<Kappa> cohens_kappa(const CountTable& table);

// A statistic with its chi-squared probability; all answers count as independent.
struct ChiSquaredTest {
  double chi_squared{};
  double degrees_of_freedom{};
  double p{};
};
// Both are tests of linear functions of the rates of answers, r_ij = n_ij / n_i., whose rows are
// independent multinomials, for a protocol fixes how often a stimulus is presented: d' V^+ d with
// as many degrees of freedom as V has rank (Grizzle, Starmer & Koch 1969). V is that of rates which
// are symmetric, (n_ij + n_ji) / (n_i. + n_j.), which of two classes gives Pearson's test of equal
// proportions (1900). Unset where nothing was confused. They throw InvalidInput as totals_of_square
// does.
//
// Is i answered with j as often as j with i? d_ij = r_ij - r_ji of each pair that was presented and
// confused at all.
std::optional<ChiSquaredTest> symmetry_test(const CountTable& table);
// Is every class named as often as it would be presented if all were presented equally often?
// d_j = sum over i of r_ij - 1, where j was presented at all, else without the 1.
std::optional<ChiSquaredTest> homogeneity_test(const CountTable& table);

// Do answers depend on what was presented? Pearson's X^2 and the likelihood ratio G^2 = 2 sum n_ij
// ln(n_ij / e_ij) with e_ij = n_i. n_.j / N; lines without answers are left out.
struct Independence {
  double chi_squared{};
  double g_squared{};
  double degrees_of_freedom{};
  double asymptotic_p{};  // of X^2; answers count as independent
  double cramers_v{};     // sqrt(X^2 / (N min(rows - 1, columns - 1)))
};
// Unset unless two rows and two columns have answers. Throws InvalidInput as totals_of does.
std::optional<Independence> independence(const CountTable& table);

// (n_ij - e_ij) / sqrt(e_ij (1 - n_i./N) (1 - n_.j/N)) (Haberman 1973), about standard normal where
// nothing depends on anything; 0 in lines that are empty or hold everything.
std::vector<std::vector<double>> adjusted_residuals(const CountTable& table);

struct MonteCarloTest {
  double p{};  // monte_carlo_p of X^2
  int draws{};
};
// X^2 against that of drawn tables (Hope 1968). Throws InvalidInput for draws below 1.
MonteCarloTest monte_carlo_independence(const NullTables& tables, int draws, std::uint64_t seed,
                                        unsigned threads = 0);
}  // namespace tapstudy::analysis
