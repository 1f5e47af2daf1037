#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "analysis/statistics/confusion_matrix.hpp"
#include "core/random/rng.hpp"
namespace tapstudy::analysis {
// A hypergeometric variate: the marked ones among `drawn` without replacement from a population
// with `marked` marked ones, by inversion outward from the mode or, where that takes many steps, by
// a ratio of uniforms. marked and drawn in [0, population].
std::int64_t random_hypergeometric(std::int64_t marked, std::int64_t drawn, std::int64_t population,
                                   core::Rng& rng);

// A table with the same totals of rows and columns, as shuffling the answers over the trials would
// give it (the distribution that Patefield 1981 draws from): cell by cell, each hypergeometric
// given those before it.
CountTable random_table(const TableTotals& totals, core::Rng& rng);

// One random table of each of these, of one shape, added up. Throws InvalidInput if there is none.
CountTable sum_of_random_tables(const std::vector<TableTotals>& totals, core::Rng& rng);

// About how much work such a sum is, for affordable_replicates: cells, and the steps of each.
std::size_t work_of_random_tables(const std::vector<CountTable>& tables);

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

struct PermutationResult {
  double p{};     // (1 + draws at least as accurate) / (draws + 1) (Hope 1968)
  int as_good{};  // draws at least as accurate; if none, p is only known to be no larger
  int draws{};
};

// is_right[stimulus][response].
using RightAnswers = std::vector<std::vector<bool>>;

// Randomisation tests of accuracy against chance, for several notions of right at once, on the same
// draws. They make no assumption of independence between participants. The same seed gives the same
// p, on any number of threads.
std::vector<PermutationResult> permutation_tests(const NullTables& tables,
                                                 const std::vector<RightAnswers>& notions,
                                                 int draws, std::uint64_t seed);
}  // namespace tapstudy::analysis
