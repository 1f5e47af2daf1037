#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/document/block_summary.hpp"
#include "analysis/statistics/scaling/preference_scales.hpp"
namespace tapstudy::analysis {
// Answers to pairs of a block's stimuli: which of the two is preferred, or neither ("tie", where
// the block allows it).

struct ParticipantPreferences {
  std::string participant_id;
  PairedCounts counts;                     // in the order of the block's stimuli
  Proportion first_position;               // preferred what stood at position 0; without ties
  std::optional<Consistency> consistency;  // by the more frequent answer to each pair
  std::string no_consistency;              // why there is none; empty: there is
};

struct PreferenceResults {
  std::vector<ParticipantPreferences> participants;  // by name
  PairedCounts counts;                               // of all
  std::optional<PreferenceScale> bradley_terry;
  double nu{};  // of ties, as in BradleyTerry
  std::optional<PreferenceScale> thurstone;
  std::string no_scale;  // why one of them is missing; empty: neither is
};

// How often an item was preferred, of its comparisons with a preference.
Proportion preferred(const PairedCounts& counts, Eigen::Index item);
// How often neither was preferred, of all comparisons.
Proportion tied(const PairedCounts& counts);

// Throws InvalidInput for trials without two different stimuli of the block, and answers that are
// neither of them.
PreferenceResults preference_results(const BlockDesign& design,
                                     const std::vector<results::AnswerRow>& answers);

// All pairs of a block's stimuli, of which one is preferred: the matrix of preferences, scales by
// Bradley & Terry and by Thurstone, each participant's consistency, the share of the first
// position. Throws InvalidInput as preference_results does, and for a hypothesis about no stimulus
// of the block.
std::shared_ptr<BlockSummary> summarise_preferences(const BlockDesign& design,
                                                    const BlockRows& rows);
}  // namespace tapstudy::analysis
