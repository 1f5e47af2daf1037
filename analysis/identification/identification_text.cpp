#include <fmt/format.h>

#include <algorithm>

#include "analysis/blocks/text_parts.hpp"
#include "analysis/blocks/wording.hpp"
#include "analysis/identification/identification_summary.hpp"
#include "analysis/identification/identification_words.hpp"
#include "core/print.hpp"
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
}  // namespace tapstudy::analysis
