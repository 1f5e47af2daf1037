#include <fmt/format.h>

#include <array>
#include <cmath>

#include "analysis/blocks/html_parts.hpp"
#include "analysis/blocks/wording.hpp"
#include "analysis/identification/identification_summary.hpp"
#include "analysis/identification/identification_words.hpp"
#include "core/print.hpp"
namespace tapstudy::analysis {
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
}  // namespace tapstudy::analysis
