#include <fmt/format.h>

#include "analysis/detection/decision_model.hpp"
#include "analysis/detection/one_against_rest.hpp"
#include "analysis/identification/matrix_sections.hpp"
namespace tapstudy::analysis {
namespace {
const Column& d_prime_column() {
  static const Column of_d_prime = interval_column("d' (95 %, answers independent)", "d_prime");
  return of_d_prime;
}

ReportTable against_rest(const std::string& name, const std::string& title,
                         const std::vector<std::string>& names, const CountTable& counts) {
  ReportTable table{
      name,
      title,
      {column("class", "class"), d_prime_column(), interval_column("criterion c", "criterion")}};
  const auto found = one_against_rest(counts);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i]) {
      table.rows.push_back({word(names[i]), interval(found[i]->d_prime, found[i]->d_prime_interval),
                            interval(found[i]->criterion, found[i]->criterion_interval)});
    }
  }
  return table;
}

ReportTable equivalent_table(const ConfusionMatrix& matrix) {
  const auto alternatives = static_cast<int>(matrix.alternatives());
  const DecisionModelRow& model = *find_decision_model("forced_choice");
  ReportTable table{"equivalent_d_prime",
                    "Equivalent d' of m-alternative forced choice",
                    {column("alternatives", "alternatives"), d_prime_column()}};
  const Proportion correct = overall_accuracy(matrix);
  if (correct.trials > 0 && matrix.share_of_alternatives() == 1.0 &&
      alternatives >= model.fewest_alternatives && alternatives <= model.most_alternatives) {
    const Sensitivity of = sensitivity({model.model, alternatives}, correct);
    table.rows.push_back({count(alternatives), interval(of.d_prime, of.interval)});
  }
  return table;
}
}  // namespace

ReportSection sensitivity_section(const MatrixOfParticipants& counted) {
  const ConfusionMatrix& matrix = counted.matrix;
  ReportSection section{"Sensitivity"};
  const auto square = by_right_response(matrix.stimuli, matrix.responses, matrix.counts);
  if (square) {
    std::vector<std::string> names;
    for (const Item& response : matrix.responses) {
      names.push_back(response.name);
    }
    section.tables.push_back(
        against_rest("d_prime", "Each class told from all others", names, *square));
  } else {
    section.remarks.emplace_back("A stimulus has no right answer, so that classes have no d'.");
  }
  ReportTable levels{"d_prime_levels",
                     "Each level of a factor told from its others",
                     {column("factor", "factor"), column("class", "class"), d_prime_column(),
                      interval_column("criterion c", "criterion")}};
  for (const std::string& factor : factors_of(matrix)) {
    if (const auto by = by_level(matrix, factor)) {
      for (auto row : against_rest("", "", by->levels, by->counts).rows) {
        row.insert(row.begin(), word(factor));
        levels.rows.push_back(std::move(row));
      }
    }
  }
  section.tables.push_back(levels);
  for (const std::string& factor : factors_of_one_level(matrix)) {
    section.remarks.push_back(
        fmt::format("Factor {} is left out: all stimuli have the same level of it.", factor));
  }
  section.tables.push_back(equivalent_table(matrix));
  section.remarks.emplace_back(
      "d' = z(hits) - z(false alarms) and c = -(z(hits) + z(false alarms)) / 2 with rates "
      "corrected by (k + 1/2) / (n + 1) (Hautus 1995); c above 0: the class is named too seldom. "
      "The equivalent d' supposes an observer without preferences.");
  if (matrix.share_of_alternatives() < 1.0) {
    section.remarks.emplace_back(
        "Some answers name no stimulus: the choice was not forced, and has no equivalent d'.");
  }
  if (const std::string warning = independence_warning(counted); !warning.empty()) {
    section.remarks.push_back(warning);
  }
  return section;
}
}  // namespace tapstudy::analysis
