#include "runner/experiments/study_design.hpp"
namespace tapstudy::runner {
namespace {
std::vector<analysis::Item> items(const protocols::Protocol& protocol,
                                  const std::vector<std::string>& names) {
  std::vector<analysis::Item> found;
  for (const std::string& name : names) {
    const protocols::Stimulus& stimulus = protocol.stimulus(name);
    found.push_back({stimulus.name, stimulus.label, stimulus.factors});
  }
  return found;
}
}  // namespace

analysis::StudyDesign design_of(const protocols::Protocol& protocol) {
  analysis::StudyDesign design{protocol.title, protocol.notes, {}};
  for (const protocols::Block& block : protocol.blocks) {
    if (block.is_practice) {
      continue;
    }
    analysis::BlockDesign part{block.name,
                               std::string{block.task->name()},
                               block.question,
                               std::string{block.task->statistic()},
                               items(protocol, block.stimuli),
                               items(protocol, block.responses),
                               {}};
    for (const protocols::Hypothesis& hypothesis : protocol.hypotheses) {
      if (hypothesis.block == block.name) {
        part.hypotheses.push_back({hypothesis.name, hypothesis.statement, hypothesis.stimulus});
      }
    }
    design.blocks.push_back(part);
  }
  return design;
}
}  // namespace tapstudy::runner
