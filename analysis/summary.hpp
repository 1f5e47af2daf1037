#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "analysis/confusion_matrix.hpp"
#include "results/rows.hpp"
namespace tapstudy::analysis {
// The design of a study as far as its report needs it.
struct PlannedHypothesis {
  std::string name;
  std::string statement;
  std::string stimulus;  // choice: expected to be chosen; identification: empty
};
struct BlockDesign {
  std::string name;
  std::string question;
  bool is_choice{};
  std::vector<Item> stimuli;
  std::vector<Item> responses;  // identification
  std::vector<PlannedHypothesis> hypotheses;
};
struct StudyDesign {
  std::string title;
  std::string notes;
  std::vector<BlockDesign> blocks;  // practice left out
};

struct HypothesisResult {
  PlannedHypothesis planned;
  std::string test;
  Proportion observed;
  double chance{};
  double p{};
};

struct FactorResult {
  std::string factor;
  std::string given;  // empty: among all answers
  Proportion accuracy;
  double chance{};  // of agreeing by guessing, for the stimuli that were presented
};
struct ParticipantAccuracy {
  std::string participant_id;
  Proportion accuracy;
};
struct IdentificationSummary {
  std::string block;
  std::string question;
  ConfusionMatrix matrix;
  Proportion accuracy;
  std::vector<FactorResult> factors;
  std::vector<ParticipantAccuracy> participants;  // none when only counts are known
  std::vector<HypothesisResult> hypotheses;
};

struct AlternativeResult {
  Item item;
  Proportion chosen;
  int visits{};
  double dwell_s{};
};
struct ChoiceSummary {
  std::string block;
  std::string question;
  std::vector<AlternativeResult> alternatives;
  std::vector<std::pair<std::string, std::string>> choices;  // participant, stimulus
  std::optional<double> multinomial_p;  // nothing if there are too many outcomes to enumerate
  bool has_repeated_choices{};          // several by one participant: not independent
  std::vector<HypothesisResult> hypotheses;
};
using BlockSummary = std::variant<IdentificationSummary, ChoiceSummary>;

struct LoopQuality {
  std::int64_t ticks{};
  std::int64_t late{};
  std::int64_t skipped{};
  std::int64_t dropped_samples{};
};

struct Summary {
  std::string title;
  std::string notes;
  std::string modes;  // "simulated", "real", "real, pilot", or "counts" if only a table was given
  int participants{};
  std::vector<BlockSummary> blocks;
  std::optional<LoopQuality> loop;
  std::vector<std::pair<std::string, std::string>> provenance;
};

// Everything a report says, from the rows it says it about.
Summary summarise(const StudyDesign& design, const std::vector<results::AnswerRow>& answers,
                  const std::vector<results::VisitRow>& visits);
// From a matrix alone, participants unknown.
Summary summarise(const ConfusionMatrix& matrix, const std::string& title);
}  // namespace tapstudy::analysis
