#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/statistics/confusion_matrix.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/resampling/null_tables.hpp"
namespace tapstudy::analysis {
// Information transfer of a confusion matrix in bits: IT = sum n_ij / N log2(n_ij N / (n_i. n_.j))
// (Miller & Nicely 1955). It is biased upward; Miller-Madow adds (K_rows + K_columns - K_cells - 1)
// / (2 N ln 2), with K the numbers of lines and cells that are not empty (Miller 1955). Both
// are 0 to log2 of the number of classes but for the correction, which may fall below 0.
struct InformationTransfer {
  double bits{};               // plug-in
  double miller_madow_bits{};  // corrected
  std::int64_t answers{};
  int occupied_cells{};
};
// Throws InvalidInput as totals_of does, and for a table without answers.
InformationTransfer information_transfer(const CountTable& table);

// Fewer answers than 5 k^2, for k classes, are too few (a habit of the field, after Miller 1955).
std::int64_t fewest_answers_for_information(const CountTable& table);

// The plug-in information that guessers with the same answers would give.
struct GuessedInformation {
  double mean{};
  double median{};
  double quantile_95{};
  double p{};  // that guessing gives as much as was observed; monte_carlo_p
  int draws{};
};
// Throws InvalidInput for tables without answers and for draws below 1.
GuessedInformation guessed_information(const NullTables& tables, int draws, std::uint64_t seed,
                                       unsigned threads = 0);

// The 95 % interval of the pooled Miller-Madow information: the union of two jackknives over
// participants (Tukey 1958; t with participants - 1 degrees of freedom), of the bits and of the
// logit of their share of the most possible, back in bits. The first alone is too short near the
// most, the second near 0. Unset for fewer than five participants, and where leaving one out makes
// no difference. Throws InvalidInput for tables without answers or of different shapes.
std::optional<Interval> information_interval(const std::vector<CountTable>& participants);
}  // namespace tapstudy::analysis
