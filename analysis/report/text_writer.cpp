#include <fmt/format.h>

#include "analysis/report/writers.hpp"
#include "core/print.hpp"
namespace tapstudy::analysis {
void write_text(std::ostream& out, const Summary& summary) {
  core::print(out, "{}\n", summary.title);
  if (const std::string warning = banner(summary); !warning.empty()) {
    core::print(out, "{}\n", warning);
  }
  for (const std::string& session : summary.unfinished) {
    core::print(out, "unfinished: {}\n", session);
  }
  for (const std::string& participant : summary.excluded) {
    core::print(out, "excluded by the operator: {}\n", participant);
  }
  for (const std::string& deviation : summary.deviations) {
    core::print(out, "note: {}\n", deviation);
  }
  for (const auto& block : summary.blocks) {
    core::print(out, "\n");
    if (!block->block.empty()) {
      core::print(out, "{}: {}\n\n", block->block, block->question);
    }
    block->write_text(out);
  }
  std::vector<ReportSection> shown = summary.sections;
  if (!summary.blocks.empty()) {
    std::erase_if(shown, [](const ReportSection& section) { return section.is_detail; });
  }
  write_sections_text(out, shown);
}
}  // namespace tapstudy::analysis
