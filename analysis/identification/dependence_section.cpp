#include <fmt/format.h>

#include <algorithm>

#include "analysis/agreement/independence.hpp"
#include "analysis/agreement/kappa.hpp"
#include "analysis/agreement/symmetry.hpp"
#include "analysis/identification/matrix_sections.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::uint64_t dependence_seed = 4;

void add_independence(const MatrixOfParticipants& counted, const Independence& test,
                      ReportSection& section) {
  const auto& tables = counted.randomisation.tables;
  ReportTable table{"dependence",
                    "Do answers depend on what was presented?",
                    {column("X²", "chi_squared"), column("df", "degrees_of_freedom"),
                     column("G²", "g_squared"), column("Cramér's V", "cramers_v"),
                     column("Monte-Carlo", "p"), column("", "draws"), column("", "asymptotic_p")}};
  std::vector<Cell> row{number(test.chi_squared), number(test.degrees_of_freedom),
                        number(test.g_squared), number(test.cramers_v)};
  if (tables) {
    const MonteCarloTest drawn =
        monte_carlo_independence(*tables, Draws{}.of(*tables), dependence_seed);
    row.insert(row.end(), {probability(drawn.p), count(drawn.draws)});
    section.remarks.push_back(fmt::format("X² is compared with {} {} (Hope 1968).", drawn.draws,
                                          counted.randomisation.words));
  } else {
    row.insert(row.end(), {nothing(table.columns[4]), count(0)});
    section.remarks.push_back("X² is not tested: " + counted.randomisation.words + ".");
  }
  row.push_back(probability(test.asymptotic_p));
  table.rows.push_back(row);
  section.tables.push_back(table);
}

ReportTable residuals_table(const ConfusionMatrix& matrix) {
  ReportTable table{"residuals",
                    "Adjusted residuals: beyond ±2 more or less often than without dependence",
                    {column("presented", "stimulus")}};
  for (const Item& response : matrix.responses) {
    table.columns.push_back(column(response.label, "residual_" + response.name));
  }
  const auto residuals = adjusted_residuals(matrix.counts);
  for (std::size_t i = 0; i < matrix.stimuli.size(); ++i) {
    table.rows.push_back({word(matrix.stimuli[i].name)});
    for (const double residual : residuals[i]) {
      table.rows.back().push_back({fmt::format("{:.1f}", residual), {residual}});
    }
  }
  return table;
}

void add_square(const CountTable& square, ReportSection& section) {
  ReportTable kappas{"kappa",
                     "Agreement of answers with stimuli",
                     {interval_column("Cohen's κ (95 %, answers independent)", "kappa"),
                      column("standard error", "standard_error")}};
  if (const auto kappa = cohens_kappa(square)) {
    kappas.rows.push_back({interval(kappa->kappa, kappa->interval), number(kappa->standard_error)});
  }
  ReportTable symmetry{
      "symmetry",
      "Symmetry of confusions",
      {column("test", "test"), column("χ²", "chi_squared"), column("df", "degrees_of_freedom"),
       column("p (answers independent)", "p")}};
  const auto add = [&](const std::string& name, const std::optional<ChiSquaredTest>& test) {
    if (test) {
      symmetry.rows.push_back({word(name), number(test->chi_squared),
                               number(test->degrees_of_freedom), probability(test->p)});
    } else {
      section.remarks.push_back(name + ": nothing to test.");
    }
  };
  add("i for j as often as j for i (Bowker 1948)", bowker_test(square));
  add("named as often as presented (Stuart 1955, Maxwell 1970)", stuart_maxwell_test(square));
  section.tables.push_back(kappas);
  section.tables.push_back(symmetry);
}
}  // namespace

ReportSection dependence_section(const MatrixOfParticipants& counted) {
  const ConfusionMatrix& matrix = counted.matrix;
  ReportSection section{"Dependence, agreement and symmetry"};
  const auto test = independence(matrix.counts);
  if (!test) {
    section.remarks.emplace_back("Nothing to test: fewer than two stimuli or answers occurred.");
    return section;
  }
  add_independence(counted, *test, section);
  section.tables.push_back(residuals_table(matrix));
  if (matrix.alternatives() < static_cast<std::int64_t>(matrix.responses.size())) {
    section.remarks.emplace_back(
        "Agreement and symmetry are left out: some answers are right for no stimulus.");
  } else if (const auto square =
                 by_right_response(matrix.stimuli, matrix.responses, matrix.counts)) {
    add_square(*square, section);
  }
  if (const std::string warning = independence_warning(counted); !warning.empty()) {
    section.remarks.push_back(warning);
  }
  return section;
}
}  // namespace tapstudy::analysis
