#include <fmt/format.h>

#include "analysis/blocks/text_parts.hpp"
#include "analysis/choice/choice_words.hpp"
#include "core/print.hpp"
namespace tapstudy::analysis {
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
}  // namespace tapstudy::analysis
