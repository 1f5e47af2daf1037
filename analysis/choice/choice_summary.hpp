#pragma once
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/blocks/block_summary.hpp"
#include "analysis/tables/sections.hpp"
namespace tapstudy::analysis {
struct AlternativeResult {
  Item item;
  Proportion chosen;                 // votes
  std::optional<Interval> interval;  // 95 %, of all alternatives at once; unset without votes
  int visits{};
  double dwell_s{};
  std::optional<Interval> sison_glaz{};  // the same by another method
};

// Several stimuli per trial, one of which is chosen, none correct: the frequency of each choice.
// Who chose several times has one vote.
class ChoiceSummary final : public BlockSummary {
 public:
  using BlockSummary::BlockSummary;
  void write_text(std::ostream& out) const override;
  void write_html(std::ostream& out) const override;
  nlohmann::ordered_json as_json() const override;
  std::vector<CsvTable> tables() const override;
  std::vector<ReportTable> report_tables() const override;
  std::string methods() const override;
  // Of each alternative alone: a participant has one vote.
  std::vector<MainResult> main_results() const override;

  std::vector<AlternativeResult> alternatives;
  std::vector<std::pair<std::string, std::string>> choices;  // participant, stimulus
  std::optional<double> multinomial_p;  // of the votes; unset if there are too many outcomes
  Vote vote{Vote::majority};
  bool has_repeated_choices{};  // some participants chose several times
  std::string untested;         // why nothing is tested; empty: it is
  std::vector<ReportSection> sections;
};

// Missing replies, choices by label and order of visits, switches between alternatives: tables
// biases and transitions.
ReportSection choosing_section(const BlockDesign& design, const BlockRows& rows);

std::shared_ptr<BlockSummary> summarise_choice(const BlockDesign& design, const BlockRows& rows);
}  // namespace tapstudy::analysis
