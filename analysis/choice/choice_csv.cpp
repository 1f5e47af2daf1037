#include <fmt/format.h>

#include "analysis/choice/choice_summary.hpp"
#include "analysis/statistics/csv_rows.hpp"
#include "core/print.hpp"
namespace tapstudy::analysis {
std::vector<CsvTable> ChoiceSummary::tables() const {
  std::vector<CsvTable> written = csv_of(sections);
  written.insert(
      written.begin(),
      CsvTable{"choices.csv", [this](std::ostream& out) {
                 out << "stimulus,votes,voters,goodman_low,goodman_high,sison_glaz_low,sison_glaz_"
                        "high,visits,dwell_s\n";
                 for (const AlternativeResult& result : alternatives) {
                   core::print(out, "{},{},{},{},{},{},{},{},{:.3f}\n", csv_cell(result.item.name),
                               result.chosen.successes, result.chosen.trials,
                               result.interval ? fmt::format("{}", result.interval->low) : "",
                               result.interval ? fmt::format("{}", result.interval->high) : "",
                               result.sison_glaz ? fmt::format("{}", result.sison_glaz->low) : "",
                               result.sison_glaz ? fmt::format("{}", result.sison_glaz->high) : "",
                               result.visits, result.dwell_s);
                 }
               }});
  return written;
}
}  // namespace tapstudy::analysis
