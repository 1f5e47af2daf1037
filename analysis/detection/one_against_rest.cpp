#include "analysis/detection/one_against_rest.hpp"
namespace tapstudy::analysis {
std::vector<std::optional<YesNoSensitivity>> one_against_rest(const CountTable& table) {
  const TableTotals totals = totals_of_square(table);
  std::vector<std::optional<YesNoSensitivity>> found;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::int64_t others = totals.all - totals.rows[i];
    if (totals.rows[i] == 0 || others == 0) {
      found.emplace_back();
      continue;
    }
    found.emplace_back(yes_no_sensitivity({table[i][i], totals.rows[i]},
                                          {totals.columns[i] - table[i][i], others}));
  }
  return found;
}
}  // namespace tapstudy::analysis
