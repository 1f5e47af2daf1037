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
// Bowker 1948: is i answered with j as often as j with i? Sum over pairs of (n_ij - n_ji)^2 /
// (n_ij + n_ji); one degree of freedom for each pair that was confused at all. Unset if none was.
// Both functions throw InvalidInput as totals_of_square does.
std::optional<ChiSquaredTest> bowker_test(const CountTable& table);

// Stuart 1955 and Maxwell 1970: is every class answered as often as it was presented? d' V^-1 d
// with d_i = n_i. - n_.i and V_ii = n_i. + n_.i - 2 n_ii, V_ij = -(n_ij + n_ji), without one class;
// as many degrees of freedom as the rank of V. Unset if that is 0.
std::optional<ChiSquaredTest> stuart_maxwell_test(const CountTable& table);

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
