#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "analysis/report/answer_tables/counts_csv.hpp"
#include "analysis/report/confusion/confusion_summary.hpp"
#include "analysis/report/document/formats.hpp"
#include "analysis/report/document/wording.hpp"
namespace tapstudy::analysis {
namespace {
// Its CSV has the form that read_counts takes.
ReportTable matrix_table(const ConfusionMatrix& matrix) {
  const std::vector<std::string> factors = factors_of(matrix);
  ReportTable table{"confusion", "Answers to each stimulus", {column("presented", "stimulus")}};
  table.is_matrix = true;
  table.shown_in.json = false;  // which has them as `counts`
  for (const std::string& factor : factors) {
    table.columns.push_back(column("", factor_mark + factor));
  }
  for (const Item& response : matrix.responses) {
    table.columns.push_back(column(response.label, response.name));
  }
  for (std::size_t i = 0; i < matrix.stimuli.size(); ++i) {
    std::vector<Cell> row{labelled(matrix.stimuli[i])};
    for (const std::string& factor : factors) {
      row.push_back(word(matrix.stimuli[i].factors.at(factor)));
    }
    for (std::size_t j = 0; j < matrix.responses.size(); ++j) {
      const Proportion share{matrix.counts[i][j], matrix.row_total(i)};
      row.push_back({fmt::format("{} ({})", share.successes, percent(share)), {share.successes}});
      row.back().style =
          matrix.stimuli[i].is_answered_by(matrix.responses[j].name) ? "correct" : "";
    }
    table.rows.push_back(row);
  }
  return table;
}

ReportTable shares_table(const std::string& title, const std::string& of_what) {
  ReportTable table{"shares", title, {{of_what, {}}, {"right answers", {}}}};
  table.shown_in = page_only;
  return table;
}

// The interval is that over participants, none of two; of one that of the answers if they are
// independent.
std::vector<Cell> share_row(const FactorResult& result, const std::string& words) {
  Cell cell{words, {}};
  if (result.accuracy.trials > 0) {
    const auto& over = result.over_participants;
    const Interval of_answers = over ? Interval{result.accuracy.value(), result.accuracy.value()}
                                     : wilson_interval(result.accuracy);
    cell.dot = Dot{result.accuracy.value(), over && over->interval ? *over->interval : of_answers,
                   result.chance};
  }
  return {word(title_of(result)), cell};
}

ReportTable right_answers_table(const std::vector<FactorResult>& results) {
  ReportTable table = shares_table("Right answers", "of");
  for (const FactorResult& result : results) {
    table.rows.push_back(
        share_row(result, with_interval(result.accuracy, result.over_participants)));
  }
  return table;
}

ReportTable participant_shares_table(const IdentificationSummary& summary) {
  ReportTable table = shares_table("Participants", "participant");
  for (const ParticipantAccuracy& one : summary.participants) {
    table.rows.push_back(share_row({one.participant_id, "", one.accuracy, summary.matrix.chance()},
                                   with_interval(one.accuracy)));
  }
  return table;
}

std::string accuracy_sentence(const std::string& title, const FactorResult& result) {
  return fmt::format("{}: {}, chance {:.0f} %", title,
                     with_interval(result.accuracy, result.over_participants),
                     100.0 * result.chance);
}

using Json = nlohmann::ordered_json;

Json names_of(const std::vector<Item>& items) {
  Json names = Json::array();
  for (const Item& item : items) {
    names.push_back(item.name);
  }
  return names;
}

// The interval is that over participants, null where there are not three.
Json share_json(const Proportion& pooled, const std::optional<MeanProportion>& over) {
  Json json = as_json(pooled);
  json["over_participants_95"] =
      over && over->interval ? Json{over->interval->low, over->interval->high} : Json(nullptr);
  return json;
}

Json values_of(const IdentificationSummary& summary) {
  const ConfusionMatrix& matrix = summary.matrix;
  Json json{{"stimuli", names_of(matrix.stimuli)},
            {"responses", names_of(matrix.responses)},
            {"counts", matrix.counts},
            {"chance", matrix.chance()},
            {"accuracy", share_json(summary.accuracy, summary.accuracy_over_participants)}};
  json["factors"] = Json::array();
  for (const FactorResult& result : summary.factors) {
    Json factor{{"factor", result.factor}};
    factor["given"] = result.given.empty() ? Json(nullptr) : Json(result.given);
    factor["accuracy"] = share_json(result.accuracy, result.over_participants);
    factor["chance"] = result.chance;
    factor["p"] = result.p ? Json(*result.p) : Json(nullptr);
    json["factors"].push_back(factor);
  }
  json["participants"] = Json::array();
  for (const ParticipantAccuracy& participant : summary.participants) {
    json["participants"].push_back({{"participant_id", participant.participant_id},
                                    {"accuracy", as_json(participant.accuracy)}});
  }
  return json;
}
}  // namespace

void IdentificationSummary::add_results() {
  std::vector<FactorResult> shares{
      {"all answers", "", accuracy, matrix.chance(), accuracy_over_participants}};
  results().terminal_lines.push_back(accuracy_sentence("correct", shares.front()));
  for (const FactorResult& result : factors) {
    results().terminal_lines.push_back(accuracy_sentence(title_of(result), result));
    shares.push_back(result);
  }
  if (!information.empty()) {
    results().terminal_lines.push_back(information);
  }
  results().tables = {matrix_table(matrix), right_answers_table(shares),
                      participant_shares_table(*this)};
  results().tables.at(participants.empty() ? 1 : 2).note =
      fmt::format("Dot: share of all answers; bar: {}; dashed line: chance.",
                  accuracy_over_participants
                      ? "95 % interval over participants (of one participant: of their answers)"
                      : "score interval, if answers are independent");
  for (ReportSection& section : sections) {
    section.is_detail = true;
  }
  values = std::make_shared<const Json>(values_of(*this));
}
}  // namespace tapstudy::analysis
