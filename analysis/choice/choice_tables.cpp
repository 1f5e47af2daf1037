#include "analysis/blocks/wording.hpp"
#include "analysis/choice/choice_summary.hpp"
namespace tapstudy::analysis {
std::vector<ReportTable> ChoiceSummary::report_tables() const {
  ReportTable table{"votes",
                    "Choices",
                    {column("stimulus", "stimulus"), counted_column("chosen", "chosen"),
                     interval_column("simultaneous 95 % CI (Goodman 1965)", "goodman"),
                     interval_column("(Sison & Glaz 1995)", "sison_glaz"),
                     column("visits", "visits"), column("time there, s", "dwell_s")}};
  for (const AlternativeResult& result : alternatives) {
    const Cell simultaneous = result.interval ? interval(result.chosen.value(), *result.interval)
                                              : nothing(table.columns[2]);
    const Cell other = result.sison_glaz ? interval(result.chosen.value(), *result.sison_glaz)
                                         : nothing(table.columns[3]);
    table.rows.push_back({word(result.item.label), counted(result.chosen), simultaneous, other,
                          count(result.visits), number(result.dwell_s)});
  }
  std::vector<ReportTable> tables{table};
  for (const ReportSection& section : sections) {
    tables.insert(tables.end(), section.tables.begin(), section.tables.end());
  }
  return tables;
}
}  // namespace tapstudy::analysis
