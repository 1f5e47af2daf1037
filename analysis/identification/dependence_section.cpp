#include <fmt/format.h>

#include <algorithm>

#include "analysis/agreement/independence.hpp"
#include "analysis/agreement/kappa.hpp"
#include "analysis/agreement/symmetry.hpp"
#include "analysis/identification/matrix_sections.hpp"
#include "analysis/participants/paired_contrast.hpp"
#include "analysis/rank_tests/signed_rank.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::uint64_t dependence_seed = 4;
constexpr std::uint64_t naming_seed = 8;

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
    table.rows.push_back({labelled(matrix.stimuli[i])});
    for (const double residual : residuals[i]) {
      table.rows.back().push_back({fmt::format("{:.1f}", residual), {residual}});
    }
  }
  return table;
}

void add_square(const CountTable& square, ReportSection& section) {
  ReportTable kappas{
      "kappa",
      "Agreement of answers with stimuli",
      {interval_column("κ (Cohen 1960; 95 % by Fleiss, Cohen & Everitt 1969, answers independent)",
                       "kappa"),
       column("standard error", "standard_error")}};
  if (const auto kappa = cohens_kappa(square)) {
    // where all agree the large-sample error is 0, which is no certainty
    const bool has_error = kappa->standard_error > 0.0;
    kappas.rows.push_back(
        {interval(kappa->kappa, has_error ? std::optional{kappa->interval} : std::nullopt),
         has_error ? number(kappa->standard_error) : nothing(kappas.columns[1])});
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

// Of each class and participant: the share of answers less the share of presentations.
ReportTable naming_table(const MatrixOfParticipants& counted) {
  ReportTable table{"naming",
                    "Named more or less often than presented",
                    {column("class", "class"),
                     interval_column("share named less share presented (95 % CI, t)", "difference"),
                     column("participants", "participants"), column("permutation", "p"),
                     column("after Holm", "p_holm")}};
  const ConfusionMatrix& matrix = counted.matrix;
  std::vector<std::vector<double>> differences(matrix.responses.size());
  for (const ParticipantCounts& person : counted.participants) {
    const auto square = by_right_response(matrix.stimuli, matrix.responses, person.counts);
    const TableTotals totals = totals_of(*square);
    for (std::size_t j = 0; j < differences.size(); ++j) {
      differences[j].push_back(static_cast<double>(totals.columns[j] - totals.rows[j]) /
                               static_cast<double>(totals.all));
    }
  }
  std::vector<PairedContrast> contrasts;
  std::vector<double> p;
  for (const std::vector<double>& of_class : differences) {
    contrasts.push_back(paired_contrast(of_class, naming_seed));
    p.push_back(contrasts.back().p);
  }
  const std::vector<double> adjusted = holm_adjusted(p);
  for (std::size_t j = 0; j < contrasts.size(); ++j) {
    table.rows.push_back(
        {labelled(matrix.responses[j]), interval(contrasts[j].mean, contrasts[j].interval),
         count(contrasts[j].participants), probability(p[j]), probability(adjusted[j])});
  }
  return table;
}

void add_naming(const MatrixOfParticipants& counted, ReportSection& section) {
  section.remarks.emplace_back(
      "Bowker's and Stuart and Maxwell's variances let presentations vary as answers do: where the "
      "protocol fixes how often a stimulus is presented, these tests reject too seldom.");
  if (counted.participants.size() > 1) {
    section.tables.push_back(naming_table(counted));
    section.remarks.emplace_back(
        "A bias to name a class is tested over participants, by flipping the signs of their "
        "differences.");
  }
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
  section.remarks.emplace_back(
      "V is the strength of the dependence, 0 to 1 (Cramér 1946); residuals are adjusted (Haberman "
      "1973).");
  if (matrix.alternatives() < static_cast<std::int64_t>(matrix.responses.size())) {
    section.remarks.emplace_back(
        "Agreement and symmetry are left out: some answers are right for no stimulus.");
  } else if (const auto square =
                 by_right_response(matrix.stimuli, matrix.responses, matrix.counts)) {
    add_square(*square, section);
    add_naming(counted, section);
  }
  if (const std::string warning = independence_warning(counted); !warning.empty()) {
    section.remarks.push_back(warning);
  }
  return section;
}
}  // namespace tapstudy::analysis
