#pragma once
#include <functional>
#include <string>
#include <vector>

#include "analysis/report/study/mixed_models.hpp"
#include "results/export/table.hpp"
namespace tapstudy::runner {
// Of a table of mixed_models_data(); what is not fitted has a row that says why.
using FitMixedModels =
    std::function<std::vector<analysis::MixedModelRow>(const results::Table& data)>;

// The script of R that fits them: it reads mixed_models_data.csv and writes mixed_models.csv.
std::string mixed_models_script();
// Runs the script in a directory of its own, for so long at most; what it has done by then is kept.
// Without Rscript there is one row, which says how to get it.
inline constexpr int most_seconds_of_r = 120;
std::vector<analysis::MixedModelRow> fit_mixed_models_in_r(const results::Table& data);
// Those of the CSV file of a report that was made before; none where there is no such file.
std::vector<analysis::MixedModelRow> mixed_models_of_report(const std::string& directory);
}  // namespace tapstudy::runner
