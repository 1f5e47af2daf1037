#include "analysis/report/figure_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
namespace tapstudy::analysis {
namespace {
std::string file_word(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return c > 127 || (std::isalnum(c) == 0 && c != '-'); }, '_');
  return text;
}

class Namer {
 public:
  // With a number where figures would share a name.
  std::string operator()(const std::string& wanted) {
    std::string name = file_word(wanted);
    for (int number = 2; !taken_.insert(name).second; ++number) {
      name = fmt::format("{}_{}", file_word(wanted), number);
    }
    return name;
  }

 private:
  std::set<std::string> taken_;
};
}  // namespace

std::vector<FigureFile> figure_files(const Summary& summary) {
  const std::string mark = banner(summary).empty() ? "" : words_of_modes(summary);
  std::vector<FigureFile> files;
  Namer named;
  const auto add = [&](const std::string& where, const std::vector<Chart>& charts) {
    for (std::size_t i = 0; i < charts.size(); ++i) {
      const std::string own =
          charts[i].name.empty() ? fmt::format("figure_{}", i + 1) : charts[i].name;
      files.push_back(
          {named(where.empty() ? own : where + "_" + own), standalone_svg(charts[i], mark)});
    }
  };
  for (const auto& block : summary.blocks) {
    add(block->block, block->figures());
  }
  for (const ReportSection& section : summary.sections) {
    add(section.name, section.charts);
    add(section.name, section.folded_charts);
  }
  return files;
}
}  // namespace tapstudy::analysis
