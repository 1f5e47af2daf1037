#pragma once
#include <memory>
#include <string>
#include <vector>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
struct FactorResult {
  std::string factor;
  std::string given;  // empty: among all answers
  Proportion accuracy;
  double chance{};  // chance level, for the stimuli that were presented
};
struct ParticipantAccuracy {
  std::string participant_id;
  Proportion accuracy;
};

// One stimulus per trial, answers correct or not: the confusion matrix with its accuracies.
class IdentificationSummary final : public BlockSummary {
 public:
  // From a matrix alone, participants unknown.
  IdentificationSummary(const BlockDesign& design, ConfusionMatrix counted);

  void write_text(std::ostream& out) const override;
  void write_html(std::ostream& out) const override;
  nlohmann::ordered_json as_json() const override;
  std::vector<CsvTable> tables() const override;

  ConfusionMatrix matrix;
  Proportion accuracy;
  std::vector<FactorResult> factors;
  std::vector<ParticipantAccuracy> participants;  // none when only counts are known
  std::vector<HypothesisResult> hypotheses;
};

// Throws InvalidInput if an answer does not fit the design.
std::shared_ptr<const BlockSummary> summarise_identification(const BlockDesign& design,
                                                             const BlockRows& rows);
}  // namespace tapstudy::analysis
