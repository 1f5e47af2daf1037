#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>

#include "analysis/report/wording.hpp"
#include "analysis/report/writers.hpp"
namespace tapstudy::analysis {
namespace {
void write_hypotheses(std::ostream& out, const std::vector<HypothesisResult>& hypotheses) {
  for (const HypothesisResult& result : hypotheses) {
    fmt::print(out, "  {}\n    {} against {:.0f} % by chance: {} ({})\n", result.planned.statement,
               fraction(result.observed), 100.0 * result.chance, p_value(result.p), result.test);
  }
}

void write_matrix(std::ostream& out, const ConfusionMatrix& matrix) {
  std::size_t widest = std::string{"presented \\ answered"}.size();
  for (const Item& item : matrix.stimuli) {
    widest = std::max(widest, item.name.size());
  }
  fmt::print(out, "  {:<{}}", "presented \\ answered", widest);
  for (const Item& response : matrix.responses) {
    fmt::print(out, "  {:>{}}", response.name, std::max<std::size_t>(response.name.size(), 10));
  }
  fmt::print(out, "\n");
  for (std::size_t i = 0; i < matrix.stimuli.size(); ++i) {
    fmt::print(out, "  {:<{}}", matrix.stimuli[i].name, widest);
    for (std::size_t j = 0; j < matrix.responses.size(); ++j) {
      const Proportion cell{matrix.counts[i][j], matrix.row_total(i)};
      const std::string said = fmt::format("{} ({})", cell.successes, percent(cell));
      fmt::print(out, "  {:>{}}", said, std::max<std::size_t>(matrix.responses[j].name.size(), 10));
    }
    fmt::print(out, "\n");
  }
}

void write_block(std::ostream& out, const IdentificationSummary& summary) {
  write_matrix(out, summary.matrix);
  fmt::print(out, "\n  correct: {}, chance {:.0f} %\n", with_interval(summary.accuracy),
             100.0 * summary.matrix.chance());
  for (const FactorResult& result : summary.factors) {
    fmt::print(out, "  {}: {}, chance {:.0f} %\n", title_of(result), with_interval(result.accuracy),
               100.0 * result.chance);
  }
  write_hypotheses(out, summary.hypotheses);
}

void write_block(std::ostream& out, const ChoiceSummary& summary) {
  for (const AlternativeResult& result : summary.alternatives) {
    fmt::print(out, "  {:<24} {:<40} {:>4} visits {:>8.1f} s\n", result.item.name,
               with_interval(result.chosen), result.visits, result.dwell_s);
  }
  fmt::print(out, "  all equally likely: {} (exact multinomial, by probability){}\n",
             multinomial_words(summary),
             summary.has_repeated_choices
                 ? "; several choices of one participant are not independent"
                 : "");
  write_hypotheses(out, summary.hypotheses);
}
}  // namespace

void write_text(std::ostream& out, const Summary& summary) {
  fmt::print(out, "{}\n", summary.title);
  if (is_simulated(summary)) {
    fmt::print(out, "SIMULATED participants: nobody felt anything.\n");
  }
  for (const BlockSummary& block : summary.blocks) {
    std::visit(
        [&](const auto& one) {
          fmt::print(out, "\n");
          if (!one.block.empty()) {
            fmt::print(out, "{}: {}\n\n", one.block, one.question);
          }
          write_block(out, one);
        },
        block);
  }
}
}  // namespace tapstudy::analysis
