#include "analysis/ratings/friedman_table.hpp"
namespace tapstudy::analysis {
ReportTable friedman_table(const std::optional<FriedmanTest>& test, std::size_t participants) {
  ReportTable table{"friedman",
                    "Test of ranks over participants (Friedman 1937)",
                    {column("participants", "participants"), column("chi squared", "chi_squared"),
                     column("df", "degrees_of_freedom"), column("p", "p"),
                     column("W (Kendall & Babington Smith 1939)", "kendalls_w")}};
  if (test) {
    table.rows.push_back({count(static_cast<std::int64_t>(participants)), number(test->chi_squared),
                          number(test->degrees_of_freedom), probability(test->p),
                          number(test->kendalls_w)});
  }
  return table;
}
}  // namespace tapstudy::analysis
