#pragma once
#include <fmt/format.h>

#include "analysis/identification/identification_summary.hpp"
namespace tapstudy::analysis {
// "material, given structure is right"
inline std::string title_of(const FactorResult& result) {
  return result.given.empty() ? result.factor
                              : fmt::format("{}, given {} is right", result.factor, result.given);
}
}  // namespace tapstudy::analysis
