#include "analysis/report/selection.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
std::vector<std::string> names_in(const Summary& summary) {
  std::vector<std::string> names;
  for (const auto& block : summary.blocks) {
    names.push_back(block->block);
    if (std::ranges::find(names, block->part_of) == names.end()) {
      names.push_back(block->part_of);
    }
  }
  for (const ReportSection& section : summary.sections) {
    names.push_back(section.name);
  }
  std::erase(names, "");
  return names;
}
}  // namespace

void keep_only(Summary& summary, const std::vector<std::string>& names) {
  const std::vector<std::string> known = names_in(summary);
  for (const std::string& name : names) {
    if (std::ranges::find(known, name) == known.end()) {
      throw core::InvalidInput{fmt::format("--only {}: is not part of this report (one of: {})",
                                           name, fmt::join(known, ", "))};
    }
  }
  const auto is_left_out = [&](const std::string& name) {
    return std::ranges::find(names, name) == names.end();
  };
  std::erase_if(summary.blocks, [&](const auto& block) {
    return is_left_out(block->block) && (block->part_of.empty() || is_left_out(block->part_of));
  });
  std::erase_if(summary.sections, [&](const auto& part) { return is_left_out(part.name); });
}
}  // namespace tapstudy::analysis
