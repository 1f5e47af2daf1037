#pragma once
#include <string>
#include <vector>

#include "analysis/report/document/sections.hpp"
#include "results/rows.hpp"
namespace tapstudy::analysis {
// A block in which participants say how sure they are, from 1 to steps.
struct ConfidenceScale {
  std::string block;
  int steps{};
  std::string low;   // what 1 means
  std::string high;  // what `steps` means
};

// How often each step was given and, where answers are right or wrong, how many of these were right
// (table confidence, a row a step). Without tables where confidence was not asked.
ReportSection confidence_section(const std::vector<ConfidenceScale>& scales,
                                 const std::vector<results::AnswerRow>& answers);
}  // namespace tapstudy::analysis
