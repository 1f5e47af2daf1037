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
                         const std::vector<Item>& classes, const CountTable& counts) {
  ReportTable table{
      name,
      title,
      {column("class", "class"), d_prime_column(), interval_column("criterion c", "criterion")}};
  const auto found = one_against_rest(counts);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i]) {
      table.rows.push_back({labelled(classes[i]),
                            interval(found[i]->d_prime, found[i]->d_prime_interval),
                            interval(found[i]->criterion, found[i]->criterion_interval)});
    }
  }
  return table;
}

constexpr std::int64_t fewest_trials = 5;  // of a class, and of the others

struct PersonsSensitivity {
  std::string participant_id;
  std::vector<std::optional<YesNoSensitivity>> classes;  // unset where trials are too few
};

PersonsSensitivity sensitivity_of(const ParticipantCounts& person, const ConfusionMatrix& matrix) {
  const auto square = by_right_response(matrix.stimuli, matrix.responses, person.counts);
  const TableTotals totals = totals_of(*square);
  PersonsSensitivity of{person.id, one_against_rest(*square)};
  for (std::size_t i = 0; i < of.classes.size(); ++i) {
    if (totals.rows[i] < fewest_trials || totals.all - totals.rows[i] < fewest_trials) {
      of.classes[i].reset();
    }
  }
  return of;
}

// Of each participant with trials enough, a class told from all others. Pooled d' is smaller than
// these where participants' criteria differ.
struct SensitivityOfPeople {
  ReportTable each;
  ReportTable mean;
};
SensitivityOfPeople of_participants(const MatrixOfParticipants& counted,
                                    const std::vector<Item>& classes) {
  SensitivityOfPeople tables{{"d_prime_participants",
                              "Each participant's d'",
                              {column("participant", "participant_id"), column("class", "class"),
                               d_prime_column(), interval_column("criterion c", "criterion")}},
                             {"d_prime_means",
                              "Means of the participants' d' and criterion",
                              {column("class", "class"), column("participants", "participants"),
                               interval_column("d' (95 % CI, t)", "d_prime"),
                               interval_column("criterion c (95 % CI, t)", "criterion")}}};
  std::vector<PersonsSensitivity> people;
  for (const ParticipantCounts& person : counted.participants) {
    people.push_back(sensitivity_of(person, counted.matrix));
  }
  // of two classes the second one's d' is that of the first, its c the negative
  const std::size_t told_apart = classes.size() == 2 ? 1 : classes.size();
  for (std::size_t i = 0; i < told_apart; ++i) {
    std::vector<double> d_primes;
    std::vector<double> criteria;
    for (const PersonsSensitivity& person : people) {
      if (const auto& of = person.classes.at(i)) {
        d_primes.push_back(of->d_prime);
        criteria.push_back(of->criterion);
        tables.each.rows.push_back({word(person.participant_id), labelled(classes[i]),
                                    interval(of->d_prime, of->d_prime_interval),
                                    interval(of->criterion, of->criterion_interval)});
      }
    }
    if (d_primes.size() > 1) {
      tables.mean.rows.push_back({labelled(classes[i]), count(std::ssize(d_primes)),
                                  mean_with_interval(d_primes), mean_with_interval(criteria)});
    }
  }
  constexpr std::size_t most_rows_to_read = 60;
  tables.each.is_for_programs = tables.each.rows.size() > most_rows_to_read;
  return tables;
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
    table.rows.push_back({count(alternatives), interval_above_zero(of.d_prime, of.interval)});
  }
  return table;
}

ReportTable levels_table(const ConfusionMatrix& matrix) {
  ReportTable levels{"d_prime_levels",
                     "Each level of a factor told from its others",
                     {column("factor", "factor"), column("class", "class"), d_prime_column(),
                      interval_column("criterion c", "criterion")}};
  for (const std::string& factor : factors_of(matrix)) {
    if (const auto by = by_level(matrix, factor)) {
      std::vector<Item> levels_of_factor;
      for (const std::string& level : by->levels) {
        levels_of_factor.push_back({level, level});
      }
      for (auto row : against_rest("", "", levels_of_factor, by->counts).rows) {
        row.insert(row.begin(), word(factor));
        levels.rows.push_back(std::move(row));
      }
    }
  }
  return levels;
}
}  // namespace

ReportSection sensitivity_section(const MatrixOfParticipants& counted) {
  const ConfusionMatrix& matrix = counted.matrix;
  ReportSection section{"Sensitivity"};
  const auto square = by_right_response(matrix.stimuli, matrix.responses, matrix.counts);
  if (square) {
    section.tables.push_back(
        against_rest("d_prime", "Each class told from all others", matrix.responses, *square));
    if (counted.are_known()) {
      SensitivityOfPeople people = of_participants(counted, matrix.responses);
      if (!people.each.rows.empty()) {
        section.remarks.push_back(fmt::format(
            "Means are of participants with at least {} trials of a class and as many others. "
            "Pooled d' is smaller where participants' criteria differ.",
            fewest_trials));
      }
      section.tables.push_back(std::move(people.mean));
      section.tables.push_back(std::move(people.each));
    }
  } else {
    section.remarks.emplace_back("A stimulus has no right answer, so that classes have no d'.");
  }
  section.tables.push_back(levels_table(matrix));
  for (const std::string& factor : factors_of_one_level(matrix)) {
    section.remarks.push_back(
        fmt::format("Factor {} is left out: all stimuli have the same level of it.", factor));
  }
  section.tables.push_back(equivalent_table(matrix));
  section.remarks.emplace_back(
      "d' = z(hits) - z(false alarms) and c = -(z(hits) + z(false alarms)) / 2 with rates "
      "corrected by (k + 1/2) / (n + 1) (Hautus 1995), intervals by the variance of z (Gourevitch "
      "& Galanter 1967); c above 0: the class is named too seldom. The equivalent d' (Hacker & "
      "Ratcliff 1979) supposes an observer without preferences; its interval is that of the "
      "proportion (Wilson 1927).");
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
