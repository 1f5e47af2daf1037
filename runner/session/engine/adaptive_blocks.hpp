#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "protocols/procedures/interleaved_tracks.hpp"
#include "protocols/protocol.hpp"
#include "protocols/schedule/schedule.hpp"
#include "results/journal/journal.hpp"
namespace tapstudy::runner {
// The blocks in which procedures choose what is presented. Their state is that which follows from
// the session's seed and the answers as they were given, corrections aside: a session that is
// resumed goes on with the same next stimulus, and nothing of it is stored.
class AdaptiveBlocks {
 public:
  // earlier: the participant's answers so far, in the order given.
  AdaptiveBlocks(const protocols::Protocol& protocol, std::uint64_t seed,
                 const protocols::Schedule& schedule,
                 const std::vector<results::JournalledAnswer>& earlier);
  // Whether the trial is not needed: the procedures of its block are finished.
  bool is_over(const protocols::PlannedTrial& trial) const;
  // With the values that the procedures ask for, as they can be presented.
  protocols::PlannedTrial with_values(protocols::PlannedTrial trial) const;
  // Of a block with procedures.
  const protocols::InterleavedTracks& tracks_of(const std::string& block) const;
  void observe(const protocols::PlannedTrial& presented, const std::string& response);
  // Which of its block's procedures observed the answer to a trial, from 0; unset: none.
  std::optional<std::size_t> track_of(int trial_number) const;

 private:
  const protocols::Protocol& protocol_;
  std::map<std::string, protocols::InterleavedTracks> tracks_;  // by block
  std::map<int, std::size_t> track_of_trial_;
};
}  // namespace tapstudy::runner
