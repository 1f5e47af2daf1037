#include "runner/experiments/study_design.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/rng.hpp"
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

// All participants of one draw share its counterbalancing.
analysis::BlockDesign::Redraw redraw_of(const protocols::Block& block, std::size_t block_index) {
  return [block, block_index](const analysis::Place& place, std::uint64_t draw) {
    const std::uint64_t seed = core::derived_seed(
        draw, core::Purpose::participant, static_cast<std::uint64_t>(place.participant_index));
    std::vector<int> stimuli;
    for (const protocols::PlannedTrial& trial :
         block.task->trials(block, {seed, place.order_index, block_index, draw})) {
      const auto found = std::ranges::find(block.stimuli, trial.stimuli.front());
      stimuli.push_back(static_cast<int>(found - block.stimuli.begin()));
    }
    return stimuli;
  };
}

analysis::Vote vote_of(const protocols::Block& block) {
  return block.vote == protocols::Vote::first ? analysis::Vote::first : analysis::Vote::majority;
}

std::string premise_of(const protocols::Protocol& protocol) {
  const protocols::SimulatedObserverSettings& observer = protocol.simulation.observer;
  return fmt::format(
      "simulated participants take the body of '{}', vibrating as by technique '{}', for the real "
      "one; what they choose follows from that",
      observer.reference, observer.reality->name);
}
}  // namespace

analysis::StudyDesign design_of(const protocols::Protocol& protocol, results::Mode mode) {
  analysis::StudyDesign design{protocol.title, protocol.notes, {}};
  int first_trial = 1;
  for (std::size_t i = 0; i < protocol.blocks.size(); ++i) {
    const protocols::Block& block = protocol.blocks[i];
    const int begins_at = first_trial;
    first_trial += block.repetitions * static_cast<int>(block.task->trials_per_repetition(block));
    if (block.is_practice) {
      continue;
    }
    analysis::BlockDesign part{block.name,
                               std::string{block.task->name()},
                               block.question,
                               std::string{block.task->statistic()},
                               items(protocol, block.stimuli),
                               items(protocol, block.responses),
                               {},
                               {},
                               begins_at,
                               {},
                               vote_of(block)};
    if (block.task->is_random(block)) {
      part.redraw = redraw_of(block, i);
    }
    if (mode == results::Mode::simulated && block.task->needs_reference()) {
      part.premise = premise_of(protocol);
    }
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
