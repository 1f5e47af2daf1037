#include <fmt/format.h>
#include <fmt/ostream.h>

#include "analysis/report/writers.hpp"
namespace tapstudy::analysis {
void write_text(std::ostream& out, const Summary& summary) {
  fmt::print(out, "{}\n", summary.title);
  if (is_simulated(summary)) {
    fmt::print(out, "SIMULATED participants: nobody felt anything.\n");
  }
  for (const auto& block : summary.blocks) {
    fmt::print(out, "\n");
    if (!block->block.empty()) {
      fmt::print(out, "{}: {}\n\n", block->block, block->question);
    }
    block->write_text(out);
  }
}
}  // namespace tapstudy::analysis
