#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "analysis/statistics/count_table.hpp"
namespace tapstudy::analysis {
// The counts of stimuli by responses, of all participants added up, and what they would be if no
// answer depended on its stimulus: a randomisation test's null distribution, table by table.
// Participants' preferences among the responses stay as they were.
struct NullTables {
  CountTable observed;
  // The same seed draws the same table; called from several threads at once.
  std::function<CountTable(std::uint64_t seed)> draw;
  std::size_t work{};  // of one draw, for affordable_replicates
};

// One participant's answers, trial by trial, as places among stimuli and responses.
struct Answers {
  std::vector<int> stimuli;
  std::vector<int> responses;
};

// The stimuli that a participant (by place in the list) would have been presented, trial by trial,
// in another draw of the study's own randomisation. All participants of one draw belong together:
// counterbalancing deals its orders out among them. Called from several threads at once.
using Redraw = std::function<std::vector<int>(std::size_t participant, std::uint64_t draw)>;

// Responses stay as they were, stimuli are drawn again by the very randomisation that the study
// used, which is what makes a test valid (Fisher 1935; Edgington 1980), whatever answers have to do
// with one another. Throws InvalidInput if a participant has not as many stimuli as responses.
NullTables redrawn_tables(std::vector<Answers> participants, Redraw redraw, std::size_t stimuli,
                          std::size_t responses);

// Each table's answers shuffled over its trials, totals kept: one table a participant, or one of
// all. Valid where each participant had the stimuli in one random order: not where the order was
// drawn within repetitions and answers avoid or follow one another. Throws InvalidInput for no
// tables and for different shapes.
NullTables shuffled_tables(const std::vector<CountTable>& participants);
}  // namespace tapstudy::analysis
