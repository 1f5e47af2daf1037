#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "analysis/report/blocks/choices.hpp"
#include "analysis/report/document/formats.hpp"
#include "analysis/report/document/wording.hpp"
#include "analysis/statistics/csv_rows.hpp"
#include "core/text/print.hpp"
namespace tapstudy::analysis {
// The p value and its test, or why there is none.
inline std::string multinomial_words(const ChoiceSummary& summary) {
  if (!summary.untested.empty()) {
    return "not tested: " + summary.untested;
  }
  return summary.multinomial_p
             ? p_value(*summary.multinomial_p) + " (exact multinomial, outcomes by probability)"
             : "not computed, too many possible outcomes";
}

// "7/10 = 70 % (95 % CI 34–91 %)", the interval that of all alternatives at once
inline std::string chosen_words(const AlternativeResult& result) {
  return result.interval ? fraction(result.chosen) + " = " + percent(result.chosen) + " (95 % CI " +
                               percent_range(*result.interval) + ")"
                         : fraction(result.chosen);
}

inline const char* words_of(Vote vote) {
  return vote == Vote::first ? "the first choice" : "the most frequent choice, of equals the first";
}

void ChoiceSummary::write_text(std::ostream& out) const {
  for (const AlternativeResult& result : alternatives) {
    core::print(out, "  {:<24} {:<40} {:>4} visit{} {:>8.1f} s\n", result.item.label,
                chosen_words(result), result.visits, result.visits == 1 ? " " : "s",
                result.dwell_s);
  }
  core::print(out, "  all equally likely: {}\n", multinomial_words(*this));
  if (has_repeated_choices) {
    core::print(out, "  {} choices, one vote a participant: {}\n", choices.size(), words_of(vote));
  }
  write_hypotheses_text(out, hypotheses);
  write_sections_text(out, sections);
}

void ChoiceSummary::write_html(std::ostream& out) const {
  const double chance = 1.0 / static_cast<double>(alternatives.size());
  out << "<div class=scroll tabindex=0 role=group aria-label=Choices>"
         "<table class=accuracy><thead><tr><td></td><th>chosen</th><td></td><th>visits</th>"
         "<th>time tried</th></tr></thead>\n";
  for (const AlternativeResult& result : alternatives) {
    core::print(
        out, "<tr><th scope=row>{}</th><td>{}</td><td>{}</td><td>{}</td><td>{:.1f} s</td></tr>\n",
        escaped(result.item.label), chosen_words(result),
        result.interval
            ? dot_plot(result.chosen.value(), *result.interval, chance, chosen_words(result))
            : "",
        result.visits, result.dwell_s);
  }
  core::print(
      out,
      "</table></div>\n<p class=note>Intervals: 95 %, of all alternatives at once "
      "(Goodman 1965); in the tables also others (Sison & Glaz 1995).</p>\n<p>All alternatives "
      "equally likely: {}.{}</p>\n",
      escaped(multinomial_words(*this)),
      has_repeated_choices ? fmt::format(" Of {} choices each participant has one vote: {}.",
                                         choices.size(), words_of(vote))
                           : "");
  write_hypotheses_html(out, hypotheses);
  write_sections_html(out, sections, block);
}

using Json = nlohmann::ordered_json;

nlohmann::ordered_json ChoiceSummary::as_json() const {
  Json json{{"block", block}, {"task", task}};
  json["alternatives"] = Json::array();
  for (const AlternativeResult& result : alternatives) {
    json["alternatives"].push_back(
        {{"stimulus", result.item.name},
         {"chosen", analysis::as_json(result.chosen)},
         {"goodman_95",
          result.interval ? Json{result.interval->low, result.interval->high} : Json(nullptr)},
         {"sison_glaz_95", result.sison_glaz ? Json{result.sison_glaz->low, result.sison_glaz->high}
                                             : Json(nullptr)},
         {"visits", result.visits},
         {"dwell_s", result.dwell_s}});
  }
  json["choices"] = Json::array();
  for (const auto& [participant, stimulus] : choices) {
    json["choices"].push_back({{"participant_id", participant}, {"stimulus", stimulus}});
  }
  json["exact_multinomial_p"] = multinomial_p ? Json(*multinomial_p) : Json(nullptr);
  json["has_repeated_choices"] = has_repeated_choices;
  json["hypotheses"] = analysis::as_json(hypotheses);
  add_sections(json, sections);
  return json;
}

std::vector<CsvTable> ChoiceSummary::tables() const {
  std::vector<CsvTable> written = csv_of(sections);
  written.insert(
      written.begin(),
      CsvTable{"choices.csv", [this](std::ostream& out) {
                 out << "stimulus,votes,voters,goodman_low,goodman_high,sison_glaz_low,sison_glaz_"
                        "high,visits,dwell_s\n";
                 for (const AlternativeResult& result : alternatives) {
                   core::print(out, "{},{},{},{},{},{},{},{},{:.3f}\n", csv_cell(result.item.name),
                               result.chosen.successes, result.chosen.trials,
                               result.interval ? fmt::format("{}", result.interval->low) : "",
                               result.interval ? fmt::format("{}", result.interval->high) : "",
                               result.sison_glaz ? fmt::format("{}", result.sison_glaz->low) : "",
                               result.sison_glaz ? fmt::format("{}", result.sison_glaz->high) : "",
                               result.visits, result.dwell_s);
                 }
               }});
  return written;
}

std::vector<ReportTable> ChoiceSummary::report_tables() const {
  ReportTable table{"votes",
                    "Choices",
                    {column("stimulus", "stimulus"), counted_column("chosen", "chosen"),
                     interval_column("simultaneous 95 % CI (Goodman 1965)", "goodman"),
                     interval_column("(Sison & Glaz 1995)", "sison_glaz"),
                     column("visits", "visits"), column("time there, s", "dwell_s")}};
  for (const AlternativeResult& result : alternatives) {
    const Cell simultaneous = result.interval ? interval(result.chosen.value(), *result.interval)
                                              : nothing(table.columns[2]);
    const Cell other = result.sison_glaz ? interval(result.chosen.value(), *result.sison_glaz)
                                         : nothing(table.columns[3]);
    table.rows.push_back({word(result.item.label), counted(result.chosen), simultaneous, other,
                          count(result.visits), number(result.dwell_s)});
  }
  std::vector<ReportTable> tables{table};
  for (const ReportSection& section : sections) {
    tables.insert(tables.end(), section.tables.begin(), section.tables.end());
  }
  return tables;
}
}  // namespace tapstudy::analysis
