#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/report/document/block_summary.hpp"
namespace tapstudy::analysis {
// A way to summarise a block. To add one: a folder with its BlockSummary, and a row in
// statistic.cpp; each task names its own.
struct Statistic {
  std::string_view name;
  std::shared_ptr<BlockSummary> (*summarise)(const BlockDesign& design, const BlockRows& rows){};
};
const std::vector<Statistic>& statistics();
// Throws InvalidInput if there is none of that name.
const Statistic& find_statistic(const std::string& name);
}  // namespace tapstudy::analysis
