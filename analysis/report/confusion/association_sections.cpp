#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/report/confusion/confusion_sections.hpp"
#include "analysis/statistics/contingency/agreement.hpp"
#include "analysis/statistics/contingency/information_transfer.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/rank_tests.hpp"
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
    section.remarks.push_back(core::citing("X² is compared with {} {} ({}).", drawn.draws,
                                           counted.randomisation.words, "Hope 1968"_source));
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
      {interval_column(core::citing("κ ({}; 95 % by {}, answers independent)", "Cohen 1960"_source,
                                    "Fleiss, Cohen & Everitt 1969"_source),
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
  const auto add = [&](const char* name, const std::optional<ChiSquaredTest>& test) {
    if (test) {
      symmetry.rows.push_back({word(name), number(test->chi_squared),
                               number(test->degrees_of_freedom), probability(test->p)});
    } else {
      section.remarks.push_back(fmt::format("{}: nothing to test.", name));
    }
  };
  add("i for j as often as j for i", symmetry_test(square));
  add("named as often as presented", homogeneity_test(square));
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
  // Of two classes one is named more often by as much as the other less: one test.
  const std::vector<double> adjusted = p.size() == 2 ? p : holm_adjusted(p);
  for (std::size_t j = 0; j < contrasts.size(); ++j) {
    table.rows.push_back(
        {labelled(matrix.responses[j]), interval(contrasts[j].mean, contrasts[j].interval),
         count(contrasts[j].participants), probability(p[j]), probability(adjusted[j])});
  }
  return table;
}

void add_naming(const MatrixOfParticipants& counted, ReportSection& section) {
  section.remarks.push_back(core::citing(
      "Symmetry is tested by rates of answers to each class ({}), so that it does not matter how "
      "often each was presented.",
      "Grizzle, Starmer & Koch 1969"_source));
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
      core::citing("V is the strength of the dependence, 0 to 1 ({}); residuals are adjusted ({}).",
                   "Cramér 1946"_source, "Haberman 1973"_source));
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

namespace {
constexpr std::uint64_t information_seed = 3;

double entropy_bits(const CountTable& counts) {
  const TableTotals totals = totals_of(counts);
  double bits = 0.0;
  for (const std::int64_t row : totals.rows) {
    const double share = static_cast<double>(row) / static_cast<double>(totals.all);
    bits -= share > 0.0 ? share * std::log2(share) : 0.0;
  }
  return bits;
}

// What right answers would transfer: the entropy of what is right; where that is not known, of what
// was presented, or the logarithm of the number of answers if there are fewer.
double most_bits(const ConfusionMatrix& matrix) {
  if (const auto right = by_right_response(matrix.stimuli, matrix.responses, matrix.counts)) {
    return entropy_bits(*right);
  }
  return std::min(entropy_bits(matrix.counts),
                  std::log2(static_cast<double>(matrix.responses.size())));
}

// The correction for bias may lead above the most that is possible.
double corrected_bits(const ConfusionMatrix& matrix) {
  return std::min(information_transfer(matrix.counts).miller_madow_bits, most_bits(matrix));
}

// Empty: enough.
std::string too_few_for_information(const CountTable& counts) {
  const std::int64_t answers = totals_of(counts).all;
  const std::int64_t fewest = fewest_answers_for_information(counts);
  return answers < fewest
             ? fmt::format("n/a: {} answer{} < {}", answers, answers == 1 ? "" : "s", fewest)
             : "";
}

std::optional<Interval> interval_up_to(double most, const MatrixOfParticipants& counted) {
  const auto over = information_interval(tables_of(counted.participants));
  return over ? std::optional{Interval{std::min(over->low, most), std::min(over->high, most)}}
              : std::nullopt;
}

ReportTable participants_table(const MatrixOfParticipants& counted) {
  ReportTable table{"information_participants",
                    "Information transfer of each participant",
                    {column("participant", "participant_id"), column("answers", "answers"),
                     column("bits (Miller-Madow)", "miller_madow_bits")}};
  for (const ParticipantCounts& person : counted.participants) {
    const std::string refusal = too_few_for_information(person.counts);
    table.rows.push_back({word(person.id), count(totals_of(person.counts).all),
                          refusal.empty()
                              ? number(information_transfer(person.counts).miller_madow_bits)
                              : nothing(table.columns.back(), refusal)});
  }
  return table;
}

// n/a where answers are too few to be corrected for bias.
Cell corrected(const Column& of, double value, const std::string& refusal) {
  return refusal.empty() ? number(value) : nothing(of, refusal);
}

ReportTable pooled_table(const MatrixOfParticipants& counted, const std::string& refusal,
                         const std::optional<GuessedInformation>& guessed) {
  const ConfusionMatrix& matrix = counted.matrix;
  const InformationTransfer transfer = information_transfer(matrix.counts);
  const double most = most_bits(matrix);
  const double bits = corrected_bits(matrix);
  const auto over = refusal.empty() ? interval_up_to(most, counted) : std::optional<Interval>{};
  ReportTable table{
      "information",
      "Information transfer of all answers, in bits",
      {column("plug-in", "bits"), column("Miller-Madow", "miller_madow_bits"),
       interval_column("95 % CI over participants", "jackknife"),
       column("all answers right", "most_bits"), column("guessing: mean", "guessed_mean"),
       column("95th percentile", "guessed_95"), column("above guessing", "p"),
       column("identifiable classes", "classes"), column("", "occupied_cells"),
       column("", "draws")}};
  std::vector<Column>& columns = table.columns;
  columns[2].keys = {"interval_low", "interval_high"};
  table.rows.push_back({number(transfer.bits), corrected(columns[1], bits, refusal),
                        over
                            ? Cell{fmt::format("{} to {}", rounded(over->low), rounded(over->high)),
                                   {over->low, over->high}}
                            : nothing(columns[2]),
                        number(most), guessed ? number(guessed->mean) : nothing(columns[4]),
                        guessed ? number(guessed->quantile_95) : nothing(columns[5]),
                        guessed ? probability(guessed->p) : nothing(columns[6]),
                        corrected(columns[7], std::exp2(std::max(0.0, bits)), refusal),
                        count(transfer.occupied_cells), count(guessed ? guessed->draws : 0)});
  return table;
}

std::vector<CitingText> remarks_on(const MatrixOfParticipants& counted, const std::string& refusal,
                                   const std::optional<GuessedInformation>& guessed) {
  std::vector<CitingText> remarks{
      guessed ? core::citing("Information transfer ({}) is biased upward; the Miller-Madow value "
                             "({}) is corrected for that; what guessing would give shows what is "
                             "left of the bias: {} {}.",
                             "Miller & Nicely 1955"_source, "Miller 1955"_source, guessed->draws,
                             counted.randomisation.words)
              : core::citing("Information transfer ({}) is biased upward; the Miller-Madow value "
                             "({}) is corrected for that. What guessing gives is not known: {}.",
                             "Miller & Nicely 1955"_source, "Miller 1955"_source,
                             counted.randomisation.words)};
  if (refusal.empty() && counted.participants.size() > 1) {
    remarks.emplace_back(
        core::citing("The interval is a jackknife ({}) over five participants or more of the "
                     "corrected value and of the logit of its share. The answers of participants "
                     "who confuse differently transfer less together than they do on average.",
                     "Tukey 1958"_source));
  }
  if (refusal.empty() &&
      information_transfer(counted.matrix.counts).miller_madow_bits > most_bits(counted.matrix)) {
    remarks.emplace_back(
        "The correction for bias leads above what right answers transfer, which is given instead: "
        "answers were nearly without error.");
  }
  if (counted.are_known() || !refusal.empty()) {
    remarks.emplace_back(
        "Fewer than 5 k² answers for k classes are too few for an estimate of information, of all "
        "or of one participant.");
  }
  return remarks;
}

std::string sentence_of(const ConfusionMatrix& matrix, const std::string& refusal,
                        const std::optional<GuessedInformation>& guessed) {
  std::string sentence =
      fmt::format("information transfer {:.2f} bit of {:.2f} (Miller-Madow {})",
                  information_transfer(matrix.counts).bits, most_bits(matrix),
                  refusal.empty() ? fmt::format("{:.2f}", corrected_bits(matrix)) : refusal);
  if (guessed) {
    sentence +=
        fmt::format("; guessing gives {:.2f}, up to {:.2f}", guessed->mean, guessed->quantile_95);
  }
  return sentence;
}

// Empty: it can be estimated, of all answers at least.
std::string why_left_out(const MatrixOfParticipants& counted, const std::string& refusal) {
  const auto occurred = [](const std::vector<std::int64_t>& totals) {
    return std::ranges::count_if(totals, [](std::int64_t total) { return total > 0; });
  };
  const TableTotals totals = totals_of(counted.matrix.counts);
  if (occurred(totals.rows) < 2 || occurred(totals.columns) < 2) {
    return "Nothing was transferred: fewer than two stimuli or answers occurred.";
  }
  return counted.are_known() && counted.participants.size() == 1 && !refusal.empty()
             ? "Not estimated of one participant: fewer than 5 k² answers for k classes."
             : "";
}
}  // namespace

InformationSection information_section(const MatrixOfParticipants& counted) {
  const CountTable& counts = counted.matrix.counts;
  const std::string refusal = too_few_for_information(counts);
  if (const std::string why = why_left_out(counted, refusal); !why.empty()) {
    InformationSection left_out;
    left_out.section.title = "Information transfer";
    left_out.section.tables.push_back(pooled_table(counted, refusal, std::nullopt));
    left_out.section.tables.back().rows.clear();
    left_out.section.remarks.push_back(why);
    return left_out;
  }
  std::optional<GuessedInformation> guessed;
  if (const auto& tables = counted.randomisation.tables) {
    guessed = guessed_information(*tables, Draws{}.of(*tables), information_seed);
  }
  InformationSection result;
  result.section.title = "Information transfer";
  result.section.tables.push_back(pooled_table(counted, refusal, guessed));
  const bool has_enough = std::ranges::any_of(counted.participants, [](const auto& person) {
    return too_few_for_information(person.counts).empty();
  });
  if (counted.are_known()) {
    result.section.tables.push_back(participants_table(counted));
    result.section.tables.back().shown_in = !has_enough ? programs_only : ShownIn{};
  }
  result.section.remarks = remarks_on(counted, refusal, guessed);
  result.sentence = sentence_of(counted.matrix, refusal, guessed);
  return result;
}
}  // namespace tapstudy::analysis
