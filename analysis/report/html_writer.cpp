#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cmath>

#include "analysis/report/html_style.hpp"
#include "analysis/report/wording.hpp"
#include "analysis/report/writers.hpp"
namespace tapstudy::analysis {
namespace {
std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

// White to deep blue; the text turns white where the cell is dark.
std::string cell_style(double share) {
  const double x = std::sqrt(share);
  const auto mix = [&](int from, int to) {
    return static_cast<int>(std::lround(from + x * (to - from)));
  };
  return fmt::format("background:rgb({},{},{});color:{}", mix(247, 8), mix(251, 69), mix(255, 148),
                     share > 0.35 ? "#fff" : "#123");
}

void write_matrix(std::ostream& out, const ConfusionMatrix& matrix) {
  out << "<table class=matrix><caption>Rows: presented. Columns: answered. Each cell: count and "
         "share of its row.</caption><thead><tr><th></th>";
  for (const Item& response : matrix.responses) {
    fmt::print(out, "<th scope=col>{}</th>", escaped(response.label));
  }
  out << "<th class=total scope=col>n</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < matrix.stimuli.size(); ++i) {
    fmt::print(out, "<tr><th scope=row>{}</th>", escaped(matrix.stimuli[i].label));
    for (std::size_t j = 0; j < matrix.responses.size(); ++j) {
      const Proportion cell{matrix.counts[i][j], matrix.row_total(i)};
      const bool is_correct = matrix.stimuli[i].name == matrix.responses[j].name;
      fmt::print(out, R"(<td class="{}" style="{}"><b>{}</b><span>{}</span></td>)",
                 is_correct ? "correct" : "", cell_style(cell.trials == 0 ? 0.0 : cell.value()),
                 cell.successes, percent(cell));
    }
    fmt::print(out, "<td class=total>{}</td></tr>\n", matrix.row_total(i));
  }
  out << "</tbody></table>\n";
}

// A dot with its interval on a scale from 0 to 100 %, chance as a line.
std::string dot_plot(const Proportion& proportion, double chance) {
  if (proportion.trials == 0) {
    return "";
  }
  const Interval interval = wilson_interval(proportion);
  return fmt::format(
      R"(<svg class=dot viewBox="0 0 200 16" role=img aria-label="{}">)"
      "<line class=axis x1=0 y1=8 x2=200 y2=8 /><line class=chance x1={:.1f} y1=0 x2={:.1f} y2=16 "
      "/>"
      "<line class=interval x1={:.1f} y1=8 x2={:.1f} y2=8 /><circle cx={:.1f} cy=8 r=4 /></svg>",
      with_interval(proportion), 200 * chance, 200 * chance, 200 * interval.low,
      200 * interval.high, 200 * proportion.value());
}

void write_accuracy_row(std::ostream& out, const std::string& title, const Proportion& proportion,
                        double chance) {
  fmt::print(out, "<tr><th scope=row>{}</th><td>{}</td><td>{}</td></tr>\n", escaped(title),
             with_interval(proportion), dot_plot(proportion, chance));
}

void write_hypotheses(std::ostream& out, const std::vector<HypothesisResult>& hypotheses) {
  if (hypotheses.empty()) {
    return;
  }
  out << "<h3>Declared before the study</h3><ul>\n";
  for (const HypothesisResult& result : hypotheses) {
    fmt::print(out, "<li>{} <b>{}</b> ({} against {:.0f} % by chance; {})</li>\n",
               escaped(result.planned.statement), escaped(p_value(result.p)),
               fraction(result.observed), 100.0 * result.chance, result.test);
  }
  out << "</ul>\n";
}

void write_block(std::ostream& out, const IdentificationSummary& summary) {
  write_matrix(out, summary.matrix);
  out << "<h3>Accuracy</h3><table class=accuracy>\n";
  write_accuracy_row(out, "all answers", summary.accuracy, summary.matrix.chance());
  for (const FactorResult& result : summary.factors) {
    write_accuracy_row(out, title_of(result), result.accuracy, result.chance);
  }
  out << "</table>\n";
  if (!summary.participants.empty()) {
    out << "<h3>Participants</h3><table class=accuracy>\n";
    for (const ParticipantAccuracy& participant : summary.participants) {
      write_accuracy_row(out, participant.participant_id, participant.accuracy,
                         summary.matrix.chance());
    }
    out << "</table>\n";
  }
  out << "<p class=note>Dot: share correct; bar: 95 % interval; dashed line: chance.</p>\n";
  write_hypotheses(out, summary.hypotheses);
}

void write_block(std::ostream& out, const ChoiceSummary& summary) {
  const double chance = 1.0 / static_cast<double>(summary.alternatives.size());
  out << "<table class=accuracy><thead><tr><th></th><th>chosen</th><th></th><th>visits</th>"
         "<th>time tried</th></tr></thead>\n";
  for (const AlternativeResult& result : summary.alternatives) {
    fmt::print(out,
               "<tr><th scope=row>{}</th><td>{}</td><td>{}</td><td>{}</td><td>{:.1f} s</td></tr>\n",
               escaped(result.item.label), with_interval(result.chosen),
               dot_plot(result.chosen, chance), result.visits, result.dwell_s);
  }
  fmt::print(out,
             "</table>\n<p>All alternatives equally likely: {} (exact multinomial test, outcomes "
             "ordered by probability).{}</p>\n",
             escaped(multinomial_words(summary)),
             summary.has_repeated_choices
                 ? " Several choices of one participant are not independent."
                 : "");
  write_hypotheses(out, summary.hypotheses);
}
}  // namespace

void write_html(std::ostream& out, const Summary& summary) {
  fmt::print(out,
             "<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8><meta name=viewport "
             "content=\"width=device-width\"><title>{}</title><style>{}</style></head><body>\n"
             "<h1>{}</h1>\n",
             escaped(summary.title), html_style, escaped(summary.title));
  if (is_simulated(summary)) {
    out << "<p class=simulated>Simulated participants: nobody felt anything. These data show what "
           "the physics and the assumed observer give.</p>\n";
  }
  for (const BlockSummary& block : summary.blocks) {
    std::visit(
        [&](const auto& one) {
          if (!one.block.empty()) {
            fmt::print(out, "<h2>{}</h2>\n<p>{}</p>\n", escaped(one.block), escaped(one.question));
          }
          write_block(out, one);
        },
        block);
  }
  fmt::print(out, "<h2>Methods</h2><p>{}</p>\n", escaped(methods(summary)));
  if (!summary.notes.empty()) {
    fmt::print(out, "<h2>Notes of the protocol</h2><p class=notes>{}</p>\n",
               escaped(summary.notes));
  }
  if (!summary.provenance.empty()) {
    out << "<h2>Provenance</h2><table class=provenance>\n";
    for (const auto& [key, value] : summary.provenance) {
      fmt::print(out, "<tr><th scope=row>{}</th><td>{}</td></tr>\n", escaped(key), escaped(value));
    }
    out << "</table>\n";
  }
  out << "</body></html>\n";
}
}  // namespace tapstudy::analysis
