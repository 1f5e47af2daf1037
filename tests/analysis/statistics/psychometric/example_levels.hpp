#pragma once
#include <string>
#include <vector>

#include "analysis/statistics/psychometric/likelihood.hpp"
#include "support/reference_programs.hpp"
namespace tapstudy::testing {
// Answers in a yes/no task, and right answers in a choice between two.
inline const std::vector<analysis::Level> yes_no_levels{{1.0, {1, 40}},  {2.0, {6, 40}},
                                                        {3.0, {17, 40}}, {4.0, {27, 40}},
                                                        {5.5, {36, 40}}, {7.0, {39, 40}}};
inline const std::vector<analysis::Level> choice_levels{{0.5, {22, 40}}, {1.0, {25, 40}},
                                                        {2.0, {29, 40}}, {3.0, {34, 40}},
                                                        {4.5, {38, 40}}, {6.0, {39, 40}}};

// x, k and n of R.
inline std::string r_levels(const std::vector<analysis::Level>& levels) {
  std::vector<double> x;
  std::vector<std::int64_t> k;
  std::vector<std::int64_t> n;
  for (const auto& level : levels) {
    x.push_back(level.value);
    k.push_back(level.answers.successes);
    n.push_back(level.answers.trials);
  }
  return "x <- " + r_vector(x) + "; k <- " + r_vector(k) + "; n <- " + r_vector(n) + "\n";
}
}  // namespace tapstudy::testing
