#pragma once
#include <string>
#include <vector>

#include "analysis/report/confusion/chance_tests.hpp"
#include "analysis/report/confusion/confusion_data.hpp"
#include "analysis/report/confusion/confusion_summary.hpp"
#include "analysis/report/document/sections.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/population/serial_dependence.hpp"
namespace tapstudy::analysis {
// What a confusion matrix says, with the counts of each participant, or all as one's whose id is
// empty. What cannot be said is left out with a remark.
struct MatrixOfParticipants {
  ConfusionMatrix matrix;
  std::vector<ParticipantCounts> participants;  // with answers
  Randomisation randomisation;
  bool are_known() const { return participants.size() > 1 || !participants.at(0).id.empty(); }
};

struct InformationSection {
  ReportSection section;
  std::string sentence;  // the same in one line
};
InformationSection information_section(const MatrixOfParticipants& counted);
ReportSection sensitivity_section(const MatrixOfParticipants& counted);
ReportSection similarity_section(const MatrixOfParticipants& counted);
ReportSection dependence_section(const MatrixOfParticipants& counted);

// A remark on what treats all answers as independent; empty where participants are not several.
std::string independence_warning(const MatrixOfParticipants& counted);

// What the participants' answers say, beyond their sum.
ReportSection accuracy_section(const IdentificationSummary& summary);
// Of a matrix whose participants are not known.
ReportSection independent_accuracy_section(const IdentificationSummary& summary);
// Counts and shares of rows: pooled, by participant, technique, repetition and level.
ReportSection counts_section(const IdentificationData& data);
// Techniques and levels of factors against one another, within participants.
ReportSection contrasts_section(const IdentificationData& data);
// Learning over presentations; what the trial before does to an answer.
ReportSection order_section(const IdentificationData& data);
// Each participant's slope of right answers on presentations, against 0; unset unless two
// participants were presented a stimulus twice.
std::optional<PairedContrast> learning_of(const IdentificationData& data);
// The participants' trials, for what one does to the next.
std::vector<AnswerSequence> sequences_of(const IdentificationData& data);
ReportSection times_section(const IdentificationData& data);
// Taps, speed and contact: what the participants did.
ReportSection exploration_section(const IdentificationData& data);

// Ways to group trials: of each the name, and the level of a trial.
struct Grouping {
  std::string name;
  std::vector<std::string> levels;
  std::vector<std::size_t> level_of_stimulus;  // place in levels; empty: by repetition
  int repetitions_a_level{1};
  std::size_t level_of(const IdentifiedTrial& trial) const {
    return level_of_stimulus.empty()
               ? static_cast<std::size_t>((trial.repetition - 1) / repetitions_a_level)
               : level_of_stimulus[trial.stimulus];
  }
};
// By technique and by the factors of the stimuli; those with one level are left out.
std::vector<Grouping> groupings_of_stimuli(const IdentificationData& data);
// By the presentations of a stimulus, more than twenty in ten parts; none if there was one.
std::optional<Grouping> grouping_by_repetition(const IdentificationData& data);
}  // namespace tapstudy::analysis
