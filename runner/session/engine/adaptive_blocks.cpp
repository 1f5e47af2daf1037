#include "runner/session/engine/adaptive_blocks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/random/rng.hpp"
#include "protocols/axes/presented_stimulus.hpp"
#include "results/store_error.hpp"
namespace tapstudy::runner {
using protocols::Alternative;
using protocols::Block;
using protocols::PlannedTrial;

namespace {
using protocols::Comparison;

// What a procedure asks for, of a comparison or of its standard.
protocols::AxisValues asked_of(const Comparison& comparison, const std::vector<double>& requested,
                               bool is_comparison) {
  protocols::AxisValues asked{{comparison.axis, is_comparison
                                                    ? comparison.value_at(requested.front())
                                                    : comparison.standard}};
  for (std::size_t i = 0; i < comparison.further_axes.size(); ++i) {
    asked[comparison.further_axes[i]] = requested.at(i + 1);
  }
  return asked;
}

// The other way round: what a procedure is told was presented.
std::vector<double> observed_of(const Comparison& comparison,
                                const protocols::AxisValues& presented) {
  std::vector<double> observed{comparison.level_of(presented.at(comparison.axis))};
  for (const std::string& axis : comparison.further_axes) {
    observed.push_back(presented.at(axis));
  }
  return observed;
}

bool has_values(const protocols::AxisValues& values, const Comparison& comparison) {
  return values.contains(comparison.axis) &&
         std::ranges::all_of(comparison.further_axes,
                             [&](const std::string& axis) { return values.contains(axis); });
}

// Throws StoreError where the answer is to no trial of the schedule.
PlannedTrial as_presented(const protocols::Schedule& schedule, const Comparison& comparison,
                          const results::JournalledAnswer& answer) {
  const auto planned = std::ranges::find(schedule, answer.trial.number, &PlannedTrial::number);
  bool is_planned = planned != schedule.end() && planned->block == answer.trial.block &&
                    planned->alternatives.size() == answer.alternatives.size();
  PlannedTrial trial = is_planned ? *planned : PlannedTrial{};
  for (std::size_t i = 0; i < trial.alternatives.size(); ++i) {
    trial.alternatives[i].values = answer.alternatives[i].axis_values;
    is_planned = is_planned && has_values(trial.alternatives[i].values, comparison);
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
      const Comparison& comparison = *protocol.block(answer.trial.block).comparison;
      observe(as_presented(schedule, comparison, answer), answer.response.response);
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
  const Comparison& comparison = *protocol_.block(trial.block).comparison;
  const std::vector<double> requested = tracks->second.next()->values;
  for (Alternative& alternative : trial.alternatives) {
    alternative.values = asked_of(comparison, requested, alternative.is_comparison);
    const protocols::AxisValues presented =
        presented_values(protocol_, protocol_.stimulus(alternative.stimulus), alternative.values);
    for (auto& [axis, value] : alternative.values) {
      value = presented.at(axis);
    }
  }
  return trial;
}

const protocols::InterleavedTracks& AdaptiveBlocks::tracks_of(const std::string& block) const {
  return tracks_.at(block);
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
    track_of_trial_[presented.number] =
        tracks->second.observe(observed_of(*block.comparison, comparison->values), *outcome);
  }
}

std::optional<std::size_t> AdaptiveBlocks::track_of(int trial_number) const {
  const auto found = track_of_trial_.find(trial_number);
  return found == track_of_trial_.end() ? std::nullopt : std::optional{found->second};
}
}  // namespace tapstudy::runner
