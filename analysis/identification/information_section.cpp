#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/identification/matrix_sections.hpp"
#include "analysis/information/information_transfer.hpp"
#include "analysis/resampling/random_table.hpp"
#include "analysis/resampling/replicates.hpp"
namespace tapstudy::analysis {
namespace {
constexpr int most_draws = 9999;
constexpr int fewest_draws = 999;
constexpr std::uint64_t information_seed = 3;

ReportTable participants_table(const MatrixOfParticipants& counted) {
  ReportTable table{"information_participants",
                    "Information transfer of each participant",
                    {column("participant", "participant_id"), column("answers", "answers"),
                     column("bits (Miller-Madow)", "miller_madow_bits")}};
  for (const ParticipantCounts& person : counted.participants) {
    const std::int64_t answers = totals_of(person.counts).all;
    const std::int64_t fewest = fewest_answers_for_information(person.counts);
    table.rows.push_back(
        {word(person.id), count(answers),
         answers < fewest
             ? nothing(table.columns.back(), fmt::format("n/a: {} answers < {}", answers, fewest))
             : number(information_transfer(person.counts).miller_madow_bits)});
  }
  return table;
}

std::vector<std::string> remarks_on(const MatrixOfParticipants& counted, int draws) {
  std::vector<std::string> remarks{fmt::format(
      "Information transfer (Miller & Nicely 1955) is biased upward; the Miller-Madow value is "
      "corrected for that, what is left of it guessing shows: {} draws with {} answers shuffled "
      "over the trials.",
      draws, counted.are_known() ? "each participant's" : "all")};
  if (counted.participants.size() > 2) {
    remarks.emplace_back(
        "The interval is the jackknife over participants of the corrected value. Pooling "
        "participants who confuse differently transfers less than each of them does.");
  }
  if (counted.are_known()) {
    remarks.emplace_back(
        "Fewer than 5 k² answers for k classes are too few for a participant's own information.");
  }
  return remarks;
}
}  // namespace

InformationSection information_section(const MatrixOfParticipants& counted) {
  const ConfusionMatrix& matrix = counted.matrix;
  const InformationTransfer transfer = information_transfer(matrix.counts);
  const std::vector<CountTable> tables = tables_of(counted.participants);
  const int draws = affordable_replicates(work_of_random_tables(tables), fewest_draws, most_draws);
  const GuessedInformation guessed = guessed_information(tables, draws, information_seed);
  const std::optional<Interval> over = information_interval(tables);
  const double most =
      std::log2(static_cast<double>(std::min(matrix.stimuli.size(), matrix.responses.size())));
  InformationSection result;
  result.section.title = "Information transfer";
  ReportTable table{
      "information",
      "Information transfer of all answers, in bits",
      {column("plug-in", "bits"), column("Miller-Madow", "miller_madow_bits"),
       interval_column("95 % CI over participants", "jackknife"), column("at most", "most_bits"),
       column("guessing: mean", "guessed_mean"), column("95th percentile", "guessed_95"),
       column("above guessing", "p"), column("identifiable classes", "classes"),
       column("", "occupied_cells"), column("", "draws")}};
  table.columns[2].keys = {"interval_low", "interval_high"};
  table.rows.push_back(
      {number(transfer.bits), number(transfer.miller_madow_bits),
       over ? Cell{fmt::format("{} to {}", rounded(over->low), rounded(over->high)),
                   {over->low, over->high}}
            : nothing(table.columns[2]),
       number(most), number(guessed.mean), number(guessed.quantile_95), probability(guessed.p),
       number(std::exp2(std::max(0.0, transfer.miller_madow_bits))), count(transfer.occupied_cells),
       count(draws)});
  result.section.tables.push_back(table);
  if (counted.are_known()) {
    result.section.tables.push_back(participants_table(counted));
  }
  result.section.remarks = remarks_on(counted, draws);
  result.sentence = fmt::format(
      "information transfer {:.2f} bit of {:.2f} (Miller-Madow {:.2f}); guessing gives {:.2f}, up "
      "to {:.2f}",
      transfer.bits, most, transfer.miller_madow_bits, guessed.mean, guessed.quantile_95);
  return result;
}
}  // namespace tapstudy::analysis
