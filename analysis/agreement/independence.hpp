#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/resampling/null_tables.hpp"
#include "analysis/statistics/count_table.hpp"
namespace tapstudy::analysis {
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
