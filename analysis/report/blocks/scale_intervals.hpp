#pragma once
#include <cstddef>

#include "core/text/citations.hpp"
namespace tapstudy::analysis {
// How intervals of scales are headed and explained: over participants, or of one of them.
inline const char* words_of_scale_interval(std::size_t participants) {
  return participants > 1 ? "95 % CI over participants" : "95 %, answers independent";
}
inline core::CitingText remark_on_scale_interval(std::size_t participants) {
  using core::operator""_source;
  return participants > 1
             ? core::citing(
                   "Intervals over participants: by leaving each of them out in one step "
                   "({}), and t; infinite where one of them alone judged a stimulus.",
                   "Lipsitz, Dear & Zhao 1994"_source)
             : "Intervals of plus or minus 1.96 standard errors take all answers as independent.";
}
}  // namespace tapstudy::analysis
