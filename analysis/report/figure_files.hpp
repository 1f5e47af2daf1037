#pragma once
#include <string>
#include <vector>

#include "analysis/report/summary.hpp"
namespace tapstudy::analysis {
struct FigureFile {
  std::string name;  // letters, digits, - and _; unlike all others
  std::string svg;
};
// Every figure of a report as a file of its own, those behind "More figures" too. Marks within
// tables are no figures. Where participants are not those of a study, each says so.
std::vector<FigureFile> figure_files(const Summary& summary);
}  // namespace tapstudy::analysis
