#include <fmt/format.h>

#include "analysis/blocks/text_parts.hpp"
#include "analysis/choice/multinomial_words.hpp"
#include "core/print.hpp"
namespace tapstudy::analysis {
void ChoiceSummary::write_text(std::ostream& out) const {
  for (const AlternativeResult& result : alternatives) {
    core::print(out, "  {:<24} {:<40} {:>4} visits {:>8.1f} s\n", result.item.name,
                with_interval(result.chosen), result.visits, result.dwell_s);
  }
  core::print(
      out, "  all equally likely: {} (exact multinomial, by probability){}\n",
      multinomial_words(*this),
      has_repeated_choices ? "; several choices of one participant are not independent" : "");
  write_hypotheses_text(out, hypotheses);
}
}  // namespace tapstudy::analysis
