#pragma once
#include "analysis/blocks/wording.hpp"
#include "analysis/choice/choice_summary.hpp"
namespace tapstudy::analysis {
// The p value, or why there is none.
inline std::string multinomial_words(const ChoiceSummary& summary) {
  return summary.multinomial_p ? p_value(*summary.multinomial_p)
                               : "not computed, too many possible outcomes";
}
}  // namespace tapstudy::analysis
