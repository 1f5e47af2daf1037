#pragma once
#include <string>
#include <vector>

#include "analysis/identification/chance_tests.hpp"
#include "analysis/identification/identification_data.hpp"
#include "analysis/tables/sections.hpp"
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
}  // namespace tapstudy::analysis
