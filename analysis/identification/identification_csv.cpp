#include <utility>

#include "analysis/identification/identification_summary.hpp"
#include "analysis/statistics/counts_csv.hpp"
#include "analysis/statistics/csv_rows.hpp"
namespace tapstudy::analysis {
namespace {
// Rows are stimuli, columns responses, cells counts: the form that read_counts takes.
void write_matrix_csv(std::ostream& out, const ConfusionMatrix& matrix) {
  const std::vector<std::string> factors = factors_of(matrix);
  out << "stimulus";
  for (const std::string& factor : factors) {
    out << ',' << csv_cell(factor_mark + factor);
  }
  for (const Item& response : matrix.responses) {
    out << ',' << csv_cell(response.name);
  }
  out << '\n';
  for (std::size_t i = 0; i < matrix.stimuli.size(); ++i) {
    out << csv_cell(matrix.stimuli[i].name);
    for (const std::string& factor : factors) {
      out << ',' << csv_cell(matrix.stimuli[i].factors.at(factor));
    }
    for (const std::int64_t count : matrix.counts[i]) {
      out << ',' << count;
    }
    out << '\n';
  }
}
}  // namespace

std::vector<CsvTable> IdentificationSummary::tables() const {
  std::vector<CsvTable> tables{
      {"confusion.csv", [this](std::ostream& out) { write_matrix_csv(out, matrix); }}};
  for (CsvTable& table : csv_of(sections)) {
    tables.push_back(std::move(table));
  }
  return tables;
}
}  // namespace tapstudy::analysis
