#include "analysis/blocks/text_parts.hpp"

#include <fmt/format.h>

#include "analysis/blocks/wording.hpp"
#include "core/print.hpp"
namespace tapstudy::analysis {
void write_hypotheses_text(std::ostream& out, const std::vector<HypothesisResult>& hypotheses) {
  for (const HypothesisResult& result : hypotheses) {
    if (result.p) {
      core::print(out, "  {}\n    {} against {:.0f} % by chance: {} ({})\n",
                  result.planned.statement, fraction(result.observed), 100.0 * result.chance,
                  p_value(result), result.test);
    } else {
      core::print(out, "  {}\n    not tested: {}\n", result.planned.statement, result.test);
    }
  }
}
}  // namespace tapstudy::analysis
