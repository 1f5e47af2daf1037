#pragma once
#include <optional>
#include <vector>

#include "analysis/detection/rates.hpp"
#include "analysis/statistics/count_table.hpp"
namespace tapstudy::analysis {
// Each class of a square confusion matrix told from all others, as yes/no with rates corrected by
// Hautus 1995: hits are its trials answered with it, false alarms other trials answered with it.
// d' and the criterion c of each class, unset for a class that was never presented or that alone
// was. Throws InvalidInput as totals_of_square does.
std::vector<std::optional<YesNoSensitivity>> one_against_rest(const CountTable& table);
}  // namespace tapstudy::analysis
