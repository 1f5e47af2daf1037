#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/report/document/block_summary.hpp"
#include "analysis/report/document/cells.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// Number formatting common to all reports.
std::string fraction(const Proportion& proportion);       // "43/80"
std::string percent(const Proportion& proportion);        // "54 %", or "–" without trials
std::string percent(double share);                        // likewise
std::string with_interval(const Proportion& proportion);  // "43/80 = 54 % (95 % CI 43–64 %)"
std::string fraction_and_percent(const Proportion& proportion);  // "43/80 = 54 %"
// "43–64 %", with as many digits as its ends take to differ
std::string percent_range(const Interval& shares);
std::string p_value(double p);  // "p = .020", "p < .001"
// The same, "p ≤ 1/10000" where only a bound is known, or "not tested".
std::string p_value(const HypothesisResult& result);
// "12/16 against 25 % by chance", or its finding.
std::string finding_of(const HypothesisResult& result);
// "p = .008, p = .024 after Holm 1979"; of a single test p alone.
std::string adjusted_in_words(double p, double p_holm, bool are_several);
// ", 2 of them beyond the levels"; empty for none.
std::string among_them(std::int64_t number, std::string_view what);
// "8 participants", "7 of 8 participants, 2 of them beyond the levels"
std::string people_in_words(std::int64_t number, std::int64_t took_part, std::int64_t beyond = 0);
// "mean ratio 1.9, 95 % CI 1.2 to 3.1", of ratios from natural logarithms; "by order alone" where
// there is no mean.
std::string contrast_in_words(double mean, const std::optional<Interval>& interval, bool is_ratio);
// "accuracy 59 % (95 % CI 45–71 %, chance 25 %), of 10 participants"; took_part: in the block, 0
// where it is not known.
std::string in_words(const MainResult& result, std::int64_t took_part = 0);

// "(95 % CI over 4 participants 14–92 %)"; where the mean of participants is not the share of all
// answers together, "(mean of 4 participants 61 %, 95 % CI 14–92 %)"; without an interval it says
// why.
std::string over_participants(const Proportion& all, const MeanShare& over);

// What all participants answered, for a proportion_column: the counts together, with an interval
// over participants (mean_share), because the answers of one are not independent of one
// another. Of a single participant the score interval; without one where it takes more participants
// with answers.
Cell pooled_proportion(const std::vector<Proportion>& participants);

// Whether the text begins with a minus sign, written as a hyphen, and not with one that joins words
// or numbers. before: the character before it; a space at the beginning.
inline bool is_minus(char before, std::string_view text) {
  return text.size() > 1 && text[0] == '-' && text[1] >= '0' && text[1] <= '9' &&
         (before == ' ' || before == '(');
}
}  // namespace tapstudy::analysis
