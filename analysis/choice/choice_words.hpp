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

inline const char* words_of(Vote vote) {
  return vote == Vote::first ? "the first choice" : "the most frequent choice, of equals the first";
}
}  // namespace tapstudy::analysis
