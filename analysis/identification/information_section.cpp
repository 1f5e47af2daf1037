#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/identification/matrix_sections.hpp"
#include "analysis/information/information_transfer.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::uint64_t information_seed = 3;

// The entropy of what was presented, or the logarithm of the number of answers if there are fewer.
double most_bits(const ConfusionMatrix& matrix) {
  double bits = 0.0;
  for (std::size_t i = 0; i < matrix.stimuli.size(); ++i) {
    const double share =
        static_cast<double>(matrix.row_total(i)) / static_cast<double>(matrix.total());
    bits -= share > 0.0 ? share * std::log2(share) : 0.0;
  }
  return std::min(bits, std::log2(static_cast<double>(matrix.responses.size())));
}

// Empty: enough.
std::string too_few_for_information(const CountTable& counts) {
  const std::int64_t answers = totals_of(counts).all;
  const std::int64_t fewest = fewest_answers_for_information(counts);
  return answers < fewest
             ? fmt::format("n/a: {} answer{} < {}", answers, answers == 1 ? "" : "s", fewest)
             : "";
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
  const auto over = refusal.empty() ? information_interval(tables_of(counted.participants))
                                    : std::optional<Interval>{};
  ReportTable table{
      "information",
      "Information transfer of all answers, in bits",
      {column("plug-in", "bits"), column("Miller-Madow", "miller_madow_bits"),
       interval_column("95 % CI over participants", "jackknife"), column("at most", "most_bits"),
       column("guessing: mean", "guessed_mean"), column("95th percentile", "guessed_95"),
       column("above guessing", "p"), column("identifiable classes", "classes"),
       column("", "occupied_cells"), column("", "draws")}};
  std::vector<Column>& columns = table.columns;
  columns[2].keys = {"interval_low", "interval_high"};
  table.rows.push_back(
      {number(transfer.bits), corrected(columns[1], transfer.miller_madow_bits, refusal),
       over ? Cell{fmt::format("{} to {}", rounded(over->low), rounded(over->high)),
                   {over->low, over->high}}
            : nothing(columns[2]),
       number(most_bits(matrix)), guessed ? number(guessed->mean) : nothing(columns[4]),
       guessed ? number(guessed->quantile_95) : nothing(columns[5]),
       guessed ? probability(guessed->p) : nothing(columns[6]),
       corrected(columns[7], std::exp2(std::max(0.0, transfer.miller_madow_bits)), refusal),
       count(transfer.occupied_cells), count(guessed ? guessed->draws : 0)});
  return table;
}

std::vector<std::string> remarks_on(const MatrixOfParticipants& counted, const std::string& refusal,
                                    double corrected_bits,
                                    const std::optional<GuessedInformation>& guessed) {
  std::vector<std::string> remarks{
      guessed ? fmt::format(
                    "Information transfer (Miller & Nicely 1955) is biased upward; the "
                    "Miller-Madow value is corrected for that, what is left of it guessing shows: "
                    "{} {}.",
                    guessed->draws, counted.randomisation.words)
              : fmt::format(
                    "Information transfer (Miller & Nicely 1955) is biased upward; the "
                    "Miller-Madow value is corrected for that. What guessing gives is not known: "
                    "{}.",
                    counted.randomisation.words)};
  if (refusal.empty() && counted.participants.size() > 1) {
    remarks.emplace_back(
        "The interval is a jackknife (Tukey 1958) over five participants or more of the corrected "
        "value and of the logit of its share. Pooling participants who confuse differently "
        "transfers less than "
        "each of them does.");
  }
  if (refusal.empty() && corrected_bits > most_bits(counted.matrix)) {
    remarks.emplace_back(
        "The correction takes the value above the most that is possible: answers were nearly "
        "without error.");
  }
  if (counted.are_known() || !refusal.empty()) {
    remarks.emplace_back(
        "Fewer than 5 k² answers for k classes are too few for an estimate of information.");
  }
  return remarks;
}

std::string sentence_of(const InformationTransfer& transfer, double most,
                        const std::string& refusal,
                        const std::optional<GuessedInformation>& guessed) {
  std::string sentence = fmt::format(
      "information transfer {:.2f} bit of {:.2f} (Miller-Madow {})", transfer.bits, most,
      refusal.empty() ? fmt::format("{:.2f}", transfer.miller_madow_bits) : refusal);
  if (guessed) {
    sentence +=
        fmt::format("; guessing gives {:.2f}, up to {:.2f}", guessed->mean, guessed->quantile_95);
  }
  return sentence;
}
}  // namespace

InformationSection information_section(const MatrixOfParticipants& counted) {
  const CountTable& counts = counted.matrix.counts;
  const InformationTransfer transfer = information_transfer(counts);
  const std::string refusal = too_few_for_information(counts);
  std::optional<GuessedInformation> guessed;
  if (const auto& tables = counted.randomisation.tables) {
    guessed = guessed_information(*tables, Draws{}.of(*tables), information_seed);
  }
  InformationSection result;
  result.section.title = "Information transfer";
  result.section.tables.push_back(pooled_table(counted, refusal, guessed));
  if (counted.are_known()) {
    result.section.tables.push_back(participants_table(counted));
  }
  result.section.remarks = remarks_on(counted, refusal, transfer.miller_madow_bits, guessed);
  result.sentence = sentence_of(transfer, most_bits(counted.matrix), refusal, guessed);
  return result;
}
}  // namespace tapstudy::analysis
