#include "runner/experiments/study_design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "core/rng.hpp"
#include "protocols/axes/axis.hpp"
#include "protocols/catch_trials.hpp"
#include "protocols/ordering.hpp"
#include "protocols/schedule.hpp"
namespace tapstudy::runner {
namespace {
// Participants may read one label for several stimuli; a reader of the report must not.
std::vector<analysis::Item> told_apart(std::vector<analysis::Item> items) {
  std::map<std::string, int> times;
  for (const analysis::Item& item : items) {
    ++times[item.label];
  }
  for (analysis::Item& item : items) {
    if (times[item.label] > 1) {
      item.label += " (" + item.name + ")";
    }
  }
  return items;
}

std::vector<analysis::Item> presented_items(const protocols::Protocol& protocol,
                                            const protocols::Block& block) {
  std::vector<analysis::Item> items;
  for (const std::string& name : block.stimuli) {
    const protocols::Stimulus& stimulus = protocol.stimulus(name);
    const auto right = block.right_response.find(name);
    items.push_back({stimulus.name, stimulus.label, stimulus.factors,
                     right == block.right_response.end() ? std::string{} : right->second,
                     block.presented == protocols::Presented::real_plates
                         ? std::string{}
                         : std::string{stimulus.technique->name}});
  }
  return told_apart(std::move(items));
}

// An answer that names a level says nothing about other factors.
std::vector<analysis::Item> answered_items(const protocols::Protocol& protocol,
                                           const protocols::Block& block) {
  std::vector<analysis::Item> items;
  for (const std::string& name : block.responses) {
    if (block.response_factor.empty()) {
      const protocols::Stimulus& stimulus = protocol.stimulus(name);
      items.push_back({stimulus.name, stimulus.label, stimulus.factors});
    } else {
      items.push_back({name, name, {{block.response_factor, name}}});
    }
  }
  return told_apart(std::move(items));
}

constexpr int not_counted = -1;

// All participants of one draw share its counterbalancing. Catch trials stay in their places.
analysis::BlockDesign::Redraw redraw_of(const protocols::Protocol& protocol,
                                        std::size_t block_index) {
  const protocols::Block& block = protocol.blocks[block_index];
  const std::uint64_t study_seed = protocol.counterbalancing_seed;
  return [block, block_index, study_seed](const analysis::Place& place, std::uint64_t draw) {
    const std::uint64_t seed = core::derived_seed(
        draw, core::Purpose::participant, static_cast<std::uint64_t>(place.participant_index));
    protocols::Draw redrawn = protocols::draw_of(study_seed, block_index, seed, place.order_index);
    redrawn.counterbalancing_seed = draw;
    std::vector<int> stimuli;
    for (const auto& next : protocols::ordered_conditions(block, redrawn)) {
      stimuli.push_back(static_cast<int>(protocols::stimulus_of(block, next.condition)));
    }
    for (const std::size_t at : protocols::catch_places(block, redrawn, stimuli.size())) {
      stimuli.insert(stimuli.begin() + static_cast<std::ptrdiff_t>(at), not_counted);
    }
    return stimuli;
  };
}

// Where the order is random.
void add_redraw(const protocols::Protocol& protocol, std::size_t block_index,
                analysis::BlockDesign& design) {
  constexpr std::size_t constrained_cost = 20;
  const protocols::Block& block = protocol.blocks[block_index];
  if (block.task->uses_order() && block.order != protocols::Order::listed) {
    design.redraw = redraw_of(protocol, block_index);
    design.redraw_cost = block.constraints.are_any() ? constrained_cost : 1;
  }
}

// Of one that the protocol's reader has accepted.
analysis::AxisName name_of(const std::string& axis) {
  const protocols::Axis& row = *protocols::find_axis(axis);
  return {axis, std::string{row.quantity}, std::string{row.unit}};
}

void add_task_settings(const protocols::Block& block, const protocols::Protocol& protocol,
                       analysis::BlockDesign& part) {
  part.decision_model = block.task->decision_model(block);
  part.guess_rate = block.task->guess_rate(block, protocol);
  part.has_own_guess_rate = block.task->has_own_guess_rate();
  part.alternatives = block.alternatives > 0 ? block.alternatives : 2;
  part.steps =
      block.rating && block.rating->kind == protocols::ScaleKind::likert ? block.rating->steps : 0;
  part.has_ties = !block.tie.empty();
  if (block.adjustment) {
    const protocols::Adjustment& of = *block.adjustment;
    part.adjusted = analysis::AdjustedAxis{name_of(of.axis), of.spacing == protocols::Spacing::log,
                                           of.middle(), of.standard};
  }
  if (block.on_axis) {
    part.axis = analysis::VariedAxis{name_of(block.on_axis->axis), 0.0, false, false};
  }
  if (block.comparison) {
    const protocols::Comparison& comparison = *block.comparison;
    part.axis = analysis::VariedAxis{
        name_of(comparison.axis), comparison.standard, comparison.is_fraction,
        comparison.side == protocols::Side::below, comparison.is_standard_right};
    std::ranges::transform(comparison.further_axes, std::back_inserter(part.further_axes), name_of);
    part.shape = comparison.shape;
  }
}

std::string question_of(const protocols::Block& block) {
  return block.presented == protocols::Presented::real_plates ? block.question + " (real plates)"
                                                              : block.question;
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
  for (std::size_t i = 0; i < protocol.blocks.size(); ++i) {
    const protocols::Block& block = protocol.blocks[i];
    if (block.is_practice) {
      continue;
    }
    analysis::BlockDesign part{block.name,
                               std::string{block.task->name()},
                               question_of(block),
                               std::string{block.task->statistic(block)},
                               presented_items(protocol, block),
                               answered_items(protocol, block),
                               {},
                               {},
                               {},
                               vote_of(block)};
    add_task_settings(block, protocol, part);
    add_redraw(protocol, i, part);
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
