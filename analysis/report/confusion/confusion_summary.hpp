#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/confusion/confusion_data.hpp"
#include "analysis/report/document/block_summary.hpp"
#include "analysis/report/document/sections.hpp"
#include "analysis/statistics/population/means.hpp"
namespace tapstudy::analysis {
// A share of right answers: of all answers, and over participants who differ (unset for fewer than
// two).
struct FactorResult {
  std::string factor;  // empty: the answer itself
  std::string given;   // empty: among all answers
  Proportion accuracy;
  double chance{};  // chance level, for the stimuli that were presented
  std::optional<MeanProportion> over_participants{};
  std::optional<double> p{};  // against chance; unset where it is not tested
};
struct ParticipantAccuracy {
  std::string participant_id;
  Proportion accuracy;
  std::optional<double> p;  // against chance, one-sided; unset where it is not tested
};

// One stimulus per trial, answers correct or not: the confusion matrix with its accuracies, and in
// sections what else can be said of it.
class IdentificationSummary final : public BlockSummary {
 public:
  // From a matrix alone, participants unknown.
  IdentificationSummary(const BlockDesign& design, ConfusionMatrix counted);
  // From every answer.
  IdentificationSummary(const BlockDesign& design, const IdentificationData& data);

  ConfusionMatrix matrix;
  Proportion accuracy;
  std::optional<MeanProportion> accuracy_over_participants;
  std::vector<FactorResult> factors;
  std::vector<ParticipantAccuracy> participants;  // none when only counts are known
  std::string chance_test;         // how accuracy was tested against chance, or why not
  std::optional<double> chance_p;  // its probability
  double smallest_p_of_one{};      // of a participant's own test, if all answers are right
  std::string information;         // a sentence on information transfer

 private:
  // The tables, sentences and values of the results; the last step of either constructor.
  void add_results();
};

// Throws InvalidInput if an answer does not fit the design.
std::shared_ptr<BlockSummary> summarise_identification(const BlockDesign& design,
                                                       const BlockRows& rows);

// "material, given structure is right"
std::string title_of(const FactorResult& result);
// "43/80 = 54 % (95 % CI over 10 participants 46–62 %)", or where there are not two participants
// "43/80 = 54 % (43–64 % if answers are independent)".
std::string with_interval(const Proportion& pooled, const std::optional<MeanProportion>& over);
}  // namespace tapstudy::analysis
