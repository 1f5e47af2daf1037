#include <fmt/format.h>

#include <algorithm>

#include "analysis/identification/matrix_sections.hpp"
#include "analysis/similarity/scaling.hpp"
#include "analysis/similarity/similarity_choice.hpp"
namespace tapstudy::analysis {
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
  ReportTable table{
      "similarity_fit",
      "Fit of the similarity-choice model",
      {column("G²", "g_squared"), column("df", "degrees_of_freedom"),
       column("p (answers independent)", "p"), column("", "draws"), column("", "asymptotic_p")}};
  std::vector<Cell>& row = table.rows.emplace_back(
      std::vector{number(model.g_squared), count(model.degrees_of_freedom)});
  if (model.degrees_of_freedom > 0) {
    const ConditionalFit fit = conditional_fit(square, model, similarity_seed);
    row.insert(row.end(), {probability(fit.p), count(fit.draws), probability(model.p)});
  } else {
    row.insert(row.end(),
               {nothing(table.columns[2], "no freedom left"), count(0), nothing(table.columns[4])});
  }
  return table;
}

void add_map(const std::vector<Item>& classes, const SimilarityChoice& model,
             ReportSection& section) {
  ReportTable table{
      "map", "Map of the classes", {column("class", "class"), column("x", "x"), column("y", "y")}};
  table.is_for_programs = true;
  const bool has_distances = std::ranges::all_of(model.similarities, [](const auto& row) {
    return std::ranges::all_of(row, [](double similarity) { return similarity > 0.0; });
  });
  if (!has_distances) {
    section.remarks.emplace_back("No map: a pair that was never confused is infinitely far apart.");
  } else if (classes.size() > 2) {
    const ScaledMap map = classical_scaling(distances_of(model.similarities), 2);
    Chart chart;
    chart.caption = fmt::format(
        "Classes on a map, far apart where seldom confused: distances −ln η, classical "
        "scaling (Torgerson 1952), {:.0f} % in two dimensions.",
        100.0 * map.explained);
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
      "Similarity-choice model (Luce 1963): class i is answered with j in proportion to bias b(j) "
      "times similarity η(i, j), by maximum likelihood; biases add up to 1, η(i, i) = 1. A small p "
      "of G², of up to 5000 answers given the totals (Besag & Clifford 1989), of more by "
      "chi-squared, "
      "says that the model does not describe the answers.");
  add_map(matrix.responses, model, section);
  return section;
}
}  // namespace tapstudy::analysis
