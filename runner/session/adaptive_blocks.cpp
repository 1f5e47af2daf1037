#include "runner/session/adaptive_blocks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/rng.hpp"
#include "protocols/axes/presented_stimulus.hpp"
#include "results/store_error.hpp"
namespace tapstudy::runner {
using protocols::Alternative;
using protocols::Block;
using protocols::PlannedTrial;

namespace {
// Throws StoreError where the answer is to no trial of the schedule.
PlannedTrial as_presented(const protocols::Schedule& schedule,
                          const results::JournalledAnswer& answer) {
  const auto planned = std::ranges::find(schedule, answer.trial.number, &PlannedTrial::number);
  bool is_planned = planned != schedule.end() && planned->block == answer.trial.block &&
                    planned->alternatives.size() == answer.alternatives.size();
  PlannedTrial trial = is_planned ? *planned : PlannedTrial{};
  for (std::size_t i = 0; i < trial.alternatives.size(); ++i) {
    trial.alternatives[i].values = answer.alternatives[i].axis_values;
    is_planned = is_planned && !trial.alternatives[i].values.empty();
  }
  if (!is_planned) {
    throw results::StoreError{
        fmt::format("trial {} is not stored as it was planned (tapstudy verify says more)",
                    answer.trial.number)};
  }
  return trial;
}
}  // namespace

AdaptiveBlocks::AdaptiveBlocks(const protocols::Protocol& protocol, std::uint64_t seed,
                               const protocols::Schedule& schedule,
                               const std::vector<results::JournalledAnswer>& earlier)
    : protocol_{protocol} {
  for (std::size_t i = 0; i < protocol.blocks.size(); ++i) {
    const Block& block = protocol.blocks[i];
    if (block.comparison) {
      tracks_.emplace(block.name, protocols::InterleavedTracks{
                                      block.comparison->tracks,
                                      core::derived_seed(seed, core::Purpose::interleaving, i)});
    }
  }
  for (const results::JournalledAnswer& answer : earlier) {
    if (tracks_.contains(answer.trial.block)) {
      observe(as_presented(schedule, answer), answer.response.response);
    }
  }
}

bool AdaptiveBlocks::is_over(const PlannedTrial& trial) const {
  const auto tracks = tracks_.find(trial.block);
  return tracks != tracks_.end() && tracks->second.are_finished();
}

PlannedTrial AdaptiveBlocks::with_values(PlannedTrial trial) const {
  const auto tracks = tracks_.find(trial.block);
  if (tracks == tracks_.end()) {
    return trial;
  }
  const protocols::Comparison& comparison = *protocol_.block(trial.block).comparison;
  const double asked = comparison.value_at(tracks->second.next()->values.front());
  for (Alternative& alternative : trial.alternatives) {
    if (alternative.is_comparison) {
      const protocols::AxisValues presented = presented_values(
          protocol_, protocol_.stimulus(alternative.stimulus), {{comparison.axis, asked}});
      alternative.values = {{comparison.axis, presented.at(comparison.axis)}};
    }
  }
  return trial;
}

void AdaptiveBlocks::observe(const PlannedTrial& presented, const std::string& response) {
  const auto tracks = tracks_.find(presented.block);
  if (tracks == tracks_.end()) {
    return;
  }
  const Block& block = protocol_.block(presented.block);
  const auto outcome = presented.task->outcome(presented, block, response);
  const auto comparison =
      std::ranges::find(presented.alternatives, true, &Alternative::is_comparison);
  if (outcome && comparison != presented.alternatives.end()) {
    const double level = block.comparison->level_of(comparison->values.at(block.comparison->axis));
    tracks->second.observe({level}, *outcome);
  }
}
}  // namespace tapstudy::runner
