#pragma once
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/report/document/block_summary.hpp"
#include "analysis/report/document/sections.hpp"
namespace tapstudy::analysis {
// Choices by what has nothing to do with the stimuli. All trials count: where labels were drawn
// anew for each, the choices of one participant are as independent of them as anybody's.
struct ChoiceBiases {
  std::vector<std::string> labels;  // by position
  std::vector<int> chosen;          // how often each was
  std::optional<double> labels_p;   // all equally likely, exact multinomial; unset: too many
                                    // outcomes, or no answers
  Proportion first_visited;         // chosen what was visited first, of trials where all were
  Proportion last_visited;          // ... and last
  double chance{};                  // of either
};

// Throws InvalidInput if trials of the block differ in their number of alternatives.
ChoiceBiases choice_biases(const BlockRows& rows);

// counts[i][j]: how often stimulus j was visited directly after stimulus i, in all trials.
std::vector<std::vector<std::int64_t>> transitions(const std::vector<Item>& stimuli,
                                                   const BlockRows& rows);

// The two-sided exact probability of a binomial count: of all outcomes no likelier than it
// (Sterne 1954). trials > 0, chance in (0, 1).
double binomial_two_sided_p(const Proportion& observed, double chance);

struct AlternativeResult {
  Item item;
  Proportion chosen;                 // votes
  std::optional<Interval> interval;  // 95 %, of all alternatives at once; unset without votes
  int visits{};
  double dwell_s{};
};

// Several stimuli per trial, one of which is chosen, none correct: the frequency of each choice.
// Who chose several times has one vote.
class ChoiceSummary final : public BlockSummary {
 public:
  using BlockSummary::BlockSummary;

  std::vector<AlternativeResult> alternatives;
  std::vector<std::pair<std::string, std::string>> choices;  // participant, stimulus
  std::optional<double> multinomial_p;  // of the votes; unset if there are too many outcomes
  Vote vote{Vote::majority};
  bool has_repeated_choices{};  // some participants chose several times
  std::string untested;         // why nothing is tested; empty: it is
};

// Missing replies, choices by label and order of visits, switches between alternatives: tables
// biases and transitions.
ReportSection choosing_section(const BlockDesign& design, const BlockRows& rows);

std::shared_ptr<BlockSummary> summarise_choice(const BlockDesign& design, const BlockRows& rows);
}  // namespace tapstudy::analysis
