#pragma once
#include <optional>

#include "analysis/statistics/count_table.hpp"
#include "analysis/statistics/proportion.hpp"
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
}  // namespace tapstudy::analysis
