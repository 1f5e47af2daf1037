#pragma once
#include <string>
#include <vector>

#include "analysis/report/summary.hpp"
namespace tapstudy::analysis {
struct TableFile {
  std::string name;
  std::string text;  // CSV
};
// The tables of a report; one that leaves it still says whose answers it holds.
std::vector<TableFile> table_files(const Summary& summary);
}  // namespace tapstudy::analysis
