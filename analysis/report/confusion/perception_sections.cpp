#include <fmt/format.h>

#include <algorithm>

#include "analysis/report/confusion/confusion_sections.hpp"
#include "analysis/statistics/contingency/similarity.hpp"
#include "analysis/statistics/detection/decision_model.hpp"
#include "analysis/statistics/detection/rates.hpp"
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
  tables.each.shown_in = tables.each.rows.size() > most_rows_to_read ? programs_only : ShownIn{};
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
  section.remarks.emplace_back(core::citing(
      "d' = z(hits) - z(false alarms) and c = -(z(hits) + z(false alarms)) / 2 with rates "
      "corrected by (k + 1/2) / (n + 1) ({}), intervals by the variance of z ({}); c above 0: the "
      "class is named too seldom. The equivalent d' ({}) supposes an observer without preferences; "
      "its interval is that of the proportion ({}).",
      "Hautus 1995"_source, "Gourevitch & Galanter 1967"_source, "Hacker & Ratcliff 1979"_source,
      "Wilson 1927"_source));
  if (matrix.share_of_alternatives() < 1.0) {
    section.remarks.emplace_back(
        "Some answers name no stimulus: the choice was not forced, and has no equivalent d'.");
  }
  if (const std::string warning = independence_warning(counted); !warning.empty()) {
    section.remarks.push_back(warning);
  }
  return section;
}

namespace {
constexpr std::uint64_t similarity_seed = 5;

ReportTable biases_table(const std::vector<Item>& classes, const SimilarityChoice& model) {
  ReportTable table{"biases",
                    "Response biases of the similarity-choice model",
                    {column("class", "class"), column("bias", "bias")}};
  for (std::size_t i = 0; i < classes.size(); ++i) {
    table.rows.push_back({labelled(classes[i]), number(model.biases[i])});
  }
  return table;
}

ReportTable similarities_table(const std::vector<Item>& classes, const SimilarityChoice& model) {
  ReportTable table{
      "similarities",
      "Similarities of the similarity-choice model",
      {column("class", "first"), column("and", "second"), column("similarity η", "similarity")}};
  for (std::size_t i = 0; i < classes.size(); ++i) {
    for (std::size_t j = i + 1; j < classes.size(); ++j) {
      table.rows.push_back(
          {labelled(classes[i]), labelled(classes[j]), number(model.similarities[i][j])});
    }
  }
  return table;
}

ReportTable fit_table(const CountTable& square, const SimilarityChoice& model) {
  ReportTable table{"similarity_fit",
                    "Fit of the similarity-choice model",
                    {column("G²", "g_squared"), column("df", "degrees_of_freedom"),
                     column("p (answers independent)", "p"), column("", "draws")}};
  std::vector<Cell>& row = table.rows.emplace_back(
      std::vector{number(model.g_squared), count(model.degrees_of_freedom)});
  if (model.degrees_of_freedom > 0) {
    const ConditionalFit fit = conditional_fit(square, model, similarity_seed);
    row.insert(row.end(), {probability(fit.p), count(fit.draws)});
  } else {
    row.insert(row.end(), {nothing(table.columns[2], "no freedom left"), count(0)});
  }
  return table;
}

void add_map(const std::vector<Item>& classes, const SimilarityChoice& model,
             ReportSection& section) {
  ReportTable table{
      "map", "Map of the classes", {column("class", "class"), column("x", "x"), column("y", "y")}};
  table.shown_in = programs_only;
  const bool has_distances = std::ranges::all_of(model.similarities, [](const auto& row) {
    return std::ranges::all_of(row, [](double similarity) { return similarity > 0.0; });
  });
  if (!has_distances) {
    section.remarks.emplace_back("No map: a pair that was never confused is infinitely far apart.");
  } else if (classes.size() > 2) {
    const ScaledMap map = classical_scaling(distances_of(model.similarities), 2);
    Chart chart;
    chart.caption = core::citing(
        "Classes on a map, far apart where seldom confused: distances −ln η, classical "
        "scaling ({}), {:.0f} % in two dimensions.",
        "Torgerson 1952"_source, 100.0 * map.explained);
    chart.alternative = "Map of the classes";
    std::vector<double> all_x;
    std::vector<double> all_y;
    for (std::size_t i = 0; i < classes.size(); ++i) {
      const double x = map.points[i][0];
      const double y = map.points[i][1];
      table.rows.push_back({labelled(classes[i]), number(x), number(y)});
      chart.points.push_back({x, y, 0.4, false, fmt::format("{}", i + 1)});
      chart.caption += fmt::format("{} {} {}", i == 0 ? "" : ",", i + 1, classes[i].label);
      all_x.push_back(x);
      all_y.push_back(y);
    }
    chart.x_range = range_of(all_x, false);
    chart.y_range = range_of(all_y, false);
    make_axes_equal(chart);
    section.charts.push_back(chart);
  }
  section.tables.push_back(table);
}
}  // namespace

std::string independence_warning(const MatrixOfParticipants& counted) {
  return counted.participants.size() > 1 || !counted.are_known()
             ? "Intervals and probabilities marked so treat all answers as independent of one "
               "another, which those of one participant are not: they are too narrow and too small."
             : "";
}

ReportSection similarity_section(const MatrixOfParticipants& counted) {
  const ConfusionMatrix& matrix = counted.matrix;
  ReportSection section{"Similarity and bias"};
  const auto square = by_right_response(matrix.stimuli, matrix.responses, matrix.counts);
  const SimilarityChoice model =
      square ? similarity_choice(*square)
             : SimilarityChoice{"a stimulus has no right answer", {}, {}, 0.0, 0, 0.0};
  if (!model.refusal.empty()) {
    section.remarks.push_back("No similarity-choice model: " + model.refusal + ".");
    return section;
  }
  section.tables = {biases_table(matrix.responses, model),
                    similarities_table(matrix.responses, model), fit_table(*square, model)};
  section.remarks.emplace_back(
      core::citing("Similarity-choice model ({}): class i is answered with j in proportion to bias "
                   "b(j) times similarity η(i, j), by maximum likelihood; biases add up to 1, η(i, "
                   "i) = 1. A small p of G², of up to 5000 answers given the totals ({}), of more "
                   "by chi-squared, says that the model does not describe the answers.",
                   "Luce 1963"_source, "Besag & Clifford 1989"_source));
  add_map(matrix.responses, model, section);
  return section;
}
}  // namespace tapstudy::analysis
