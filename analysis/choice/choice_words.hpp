#pragma once
#include "analysis/blocks/wording.hpp"
#include "analysis/choice/choice_summary.hpp"
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
}  // namespace tapstudy::analysis
