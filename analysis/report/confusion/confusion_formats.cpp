#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "analysis/report/answer_tables/counts_csv.hpp"
#include "analysis/report/confusion/confusion_summary.hpp"
#include "analysis/report/document/formats.hpp"
#include "analysis/report/document/wording.hpp"
#include "analysis/statistics/csv_rows.hpp"
#include "core/text/print.hpp"
namespace tapstudy::analysis {
namespace {
void print_matrix(std::ostream& out, const ConfusionMatrix& matrix) {
  std::size_t widest = std::string{"presented \\ answered"}.size();
  for (const Item& item : matrix.stimuli) {
    widest = std::max(widest, item.name.size());
  }
  core::print(out, "  {:<{}}", "presented \\ answered", widest);
  for (const Item& response : matrix.responses) {
    core::print(out, "  {:>{}}", response.name, std::max<std::size_t>(response.name.size(), 10));
  }
  core::print(out, "\n");
  for (std::size_t i = 0; i < matrix.stimuli.size(); ++i) {
    core::print(out, "  {:<{}}", matrix.stimuli[i].name, widest);
    for (std::size_t j = 0; j < matrix.responses.size(); ++j) {
      const Proportion cell{matrix.counts[i][j], matrix.row_total(i)};
      const std::string said = fmt::format("{} ({})", cell.successes, percent(cell));
      core::print(out, "  {:>{}}", said,
                  std::max<std::size_t>(matrix.responses[j].name.size(), 10));
    }
    core::print(out, "\n");
  }
}
}  // namespace

void IdentificationSummary::write_text(std::ostream& out) const {
  print_matrix(out, matrix);
  const auto line = [&](const std::string& title, const Proportion& share,
                        const std::optional<MeanProportion>& over, double chance) {
    out << wrapped(
        fmt::format("{}: {}, chance {:.0f} %", title, with_interval(share, over), 100.0 * chance),
        2);
  };
  out << '\n';
  line("correct", accuracy, accuracy_over_participants, matrix.chance());
  for (const FactorResult& result : factors) {
    line(title_of(result), result.accuracy, result.over_participants, result.chance);
  }
  if (!information.empty()) {
    out << wrapped(information, 2);
  }
  write_hypotheses_text(out, hypotheses);
}

namespace {
// Of a colour as sRGB has it: what contrast is made of (WCAG 2.1).
double luminance(const std::array<int, 3>& colour) {
  constexpr std::array<double, 3> weights{0.2126, 0.7152, 0.0722};
  double sum = 0.0;
  for (std::size_t i = 0; i < colour.size(); ++i) {
    const double part = colour[i] / 255.0;
    sum += weights[i] * (part <= 0.03928 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4));
  }
  return sum;
}

// White to deep blue; the text is white or black, whichever stands out more.
std::string cell_style(double share) {
  const double x = std::sqrt(share);
  const auto mix = [&](int from, int to) {
    return static_cast<int>(std::lround(from + x * (to - from)));
  };
  const std::array<int, 3> colour{mix(247, 8), mix(251, 69), mix(255, 148)};
  const double ground = luminance(colour) + 0.05;
  return fmt::format("background:rgb({},{},{});color:{}", colour[0], colour[1], colour[2],
                     1.05 / ground > ground / 0.05 ? "#fff" : "#000");
}

void write_matrix_html(std::ostream& out, const ConfusionMatrix& matrix) {
  out << "<div class=scroll tabindex=0 role=group aria-label=\"Confusion matrix\">"
         "<table class=matrix><caption>Rows: presented. Columns: answered. Each cell: count and "
         "share of its row.</caption><thead><tr><td></td>";
  for (const Item& response : matrix.responses) {
    core::print(out, "<th scope=col>{}</th>", escaped(response.label));
  }
  out << "<th class=total scope=col>n</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < matrix.stimuli.size(); ++i) {
    core::print(out, "<tr><th scope=row>{}</th>", escaped(matrix.stimuli[i].label));
    for (std::size_t j = 0; j < matrix.responses.size(); ++j) {
      const Proportion cell{matrix.counts[i][j], matrix.row_total(i)};
      const bool is_correct = matrix.stimuli[i].is_answered_by(matrix.responses[j].name);
      core::print(out, R"(<td class="{}" style="{}"><b>{}</b><span>{}</span></td>)",
                  is_correct ? "correct" : "", cell_style(cell.trials == 0 ? 0.0 : cell.value()),
                  cell.successes, percent(cell));
    }
    core::print(out, "<td class=total>{}</td></tr>\n", matrix.row_total(i));
  }
  out << "</tbody></table></div>\n";
}

void write_share_row(std::ostream& out, const FactorResult& result) {
  const std::string words = with_interval(result.accuracy, result.over_participants);
  const std::string dots =
      result.accuracy.trials == 0
          ? ""
          : dot_plot(result.accuracy.value(),
                     result.over_participants ? result.over_participants->interval
                                              : wilson_interval(result.accuracy),
                     result.chance, words);
  write_dot_row(out, title_of(result), words, dots);
}
}  // namespace

void IdentificationSummary::write_html(std::ostream& out) const {
  write_matrix_html(out, matrix);
  out << "<h3>Right answers</h3><table class=accuracy>\n";
  write_share_row(out, {"all answers", "", accuracy, matrix.chance(), accuracy_over_participants});
  for (const FactorResult& result : factors) {
    write_share_row(out, result);
  }
  out << "</table>\n";
  if (!participants.empty()) {
    out << "<h3>Participants</h3><table class=accuracy>\n";
    for (const ParticipantAccuracy& participant : participants) {
      write_accuracy_row(out, participant.participant_id, participant.accuracy, matrix.chance());
    }
    out << "</table>\n";
  }
  core::print(out, "<p class=note>Dot: share of all answers; bar: {}; dashed line: chance.</p>\n",
              accuracy_over_participants
                  ? "95 % interval over participants (of one participant: of their answers)"
                  : "score interval, if answers are independent");
  write_hypotheses_html(out, hypotheses);
  write_sections_html(out, sections, block.empty() ? "counts" : block);
}

namespace {
using Json = nlohmann::ordered_json;

Json names_of(const std::vector<Item>& items) {
  Json names = Json::array();
  for (const Item& item : items) {
    names.push_back(item.name);
  }
  return names;
}

// The interval is that over participants, null where there are not two.
Json share_json(const Proportion& pooled, const std::optional<MeanProportion>& over) {
  Json json = as_json(pooled);
  json["over_participants_95"] =
      over ? Json{over->interval.low, over->interval.high} : Json(nullptr);
  return json;
}
}  // namespace

nlohmann::ordered_json IdentificationSummary::as_json() const {
  Json json{{"block", block},
            {"task", task},
            {"stimuli", names_of(matrix.stimuli)},
            {"responses", names_of(matrix.responses)},
            {"counts", matrix.counts},
            {"chance", matrix.chance()},
            {"accuracy", share_json(accuracy, accuracy_over_participants)}};
  json["factors"] = Json::array();
  for (const FactorResult& result : factors) {
    Json factor{{"factor", result.factor}};
    factor["given"] = result.given.empty() ? Json(nullptr) : Json(result.given);
    factor["accuracy"] = share_json(result.accuracy, result.over_participants);
    factor["chance"] = result.chance;
    factor["p"] = result.p ? Json(*result.p) : Json(nullptr);
    json["factors"].push_back(factor);
  }
  json["participants"] = Json::array();
  for (const ParticipantAccuracy& participant : participants) {
    json["participants"].push_back({{"participant_id", participant.participant_id},
                                    {"accuracy", analysis::as_json(participant.accuracy)}});
  }
  add_sections(json, sections);
  json["hypotheses"] = analysis::as_json(hypotheses);
  return json;
}

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

namespace {
ReportTable matrix_table(const ConfusionMatrix& matrix) {
  ReportTable table{"matrix", "Answers to each stimulus", {column("presented", "stimulus")}};
  for (const Item& response : matrix.responses) {
    table.columns.push_back(column(response.label, response.name));
  }
  for (std::size_t i = 0; i < matrix.stimuli.size(); ++i) {
    std::vector<Cell> row{word(matrix.stimuli[i].label)};
    for (const std::int64_t counted : matrix.counts[i]) {
      const Proportion share{counted, matrix.row_total(i)};
      row.push_back({fmt::format("{} ({})", counted, percent(share)), {counted}});
    }
    table.rows.push_back(row);
  }
  return table;
}
}  // namespace

std::vector<ReportTable> IdentificationSummary::report_tables() const {
  std::vector<ReportTable> tables{matrix_table(matrix)};
  for (const ReportSection& section : sections) {
    tables.insert(tables.end(), section.tables.begin(), section.tables.end());
  }
  return tables;
}

std::vector<Chart> IdentificationSummary::figures() const {
  std::vector<Chart> charts;
  for (const ReportSection& section : sections) {
    charts.insert(charts.end(), section.charts.begin(), section.charts.end());
  }
  return charts;
}
}  // namespace tapstudy::analysis
