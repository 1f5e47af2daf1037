#include "runner/experiments/done_blocks.hpp"

#include "results/participant_courses.hpp"
namespace tapstudy::runner {
DoneBlocks done_blocks(const std::vector<StudyStore>& stores, results::Mode mode) {
  DoneBlocks all;
  for (const StudyStore& each : stores) {
    for (const auto& [block, done] : results::block_courses(*each.store, mode)) {
      results::BlockCourseRow& total = all[block];
      total.participants.insert(done.participants.begin(), done.participants.end());
      total.answered += done.answered;
      total.masked += done.masked;
    }
  }
  return all;
}

std::set<std::string> rendered_stimuli(const protocols::Protocol& protocol,
                                       const DoneBlocks& done) {
  std::set<std::string> names;
  for (const protocols::Block& block : protocol.blocks) {
    if (done.contains(block.name) && block.presented == protocols::Presented::virtual_plates) {
      for (const std::string& name : all_presented(block)) {
        names.insert(name);
      }
    }
  }
  return names;
}
}  // namespace tapstudy::runner
