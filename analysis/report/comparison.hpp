#pragma once
#include <string>

#include "analysis/report/summary.hpp"
namespace tapstudy::analysis {
struct NamedSummary {
  std::string name;
  const Summary* summary{};
};
// Two studies side by side: the main results of each block that both have, and their difference,
// second less first, with its interval. Their participants are taken for different people. Blocks
// that cannot be compared are named. Throws InvalidInput if there is nothing to compare.
Summary compare(const NamedSummary& first, const NamedSummary& second);
}  // namespace tapstudy::analysis
