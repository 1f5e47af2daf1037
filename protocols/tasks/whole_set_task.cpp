#include "protocols/tasks/whole_set_task.hpp"
namespace tapstudy::protocols {
std::vector<PlannedTrial> WholeSetTask::trials(const Block& block, const Draw& draw) const {
  core::Rng rng{core::derived_seed(draw.participant_seed, core::Purpose::labels, draw.block_index)};
  std::vector<PlannedTrial> all;
  for (int repetition = 1; repetition <= block.repetitions; ++repetition) {
    std::vector<Alternative> alternatives;
    for (const std::string& stimulus : block.stimuli) {
      alternatives.push_back({stimulus});
    }
    rng.shuffle(alternatives);
    all.push_back({0, block.name, this, block.is_practice, repetition, alternatives});
  }
  return all;
}
}  // namespace tapstudy::protocols
