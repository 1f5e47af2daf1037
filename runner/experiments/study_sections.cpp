#include "runner/experiments/study_sections.hpp"

#include <algorithm>

#include "analysis/course/course_section.hpp"
#include "runner/experiments/given_forms.hpp"
#include "runner/session/practice_record.hpp"
namespace tapstudy::runner {
namespace {
using results::ParticipantCourseRow;

void add_practice(const protocols::Protocol& protocol, const std::string& participant,
                  results::Store& store, std::vector<analysis::PracticeResult>& practice) {
  const auto answers = store.answers_as_given(participant);
  const PracticeRecord record{answers};
  for (const protocols::Block& block : protocol.blocks) {
    analysis::PracticeResult result{participant, block.name, {}};
    bool has_answers = false;
    for (const results::JournalledAnswer& answer : answers) {
      if (answer.trial.is_practice && answer.trial.block == block.name) {
        has_answers = true;
        const auto& is_correct = answer.response.is_correct;
        result.right.trials += is_correct ? 1 : 0;
        result.right.successes += is_correct.value_or(false) ? 1 : 0;
      }
    }
    if (block.criterion) {
      result.is_criterion_met = record.is_met(block);
    }
    if (has_answers) {
      practice.push_back(result);
    }
  }
}

analysis::ReportSection course(const protocols::Protocol& protocol,
                               const std::vector<StudyStore>& stores, results::Mode mode) {
  std::vector<ParticipantCourseRow> participants;
  std::vector<analysis::PracticeResult> practice;
  for (const StudyStore& each : stores) {
    for (const ParticipantCourseRow& row : each.store->participant_courses()) {
      if (row.mode == mode) {
        participants.push_back(row);
        add_practice(protocol, row.participant_id, *each.store, practice);
      }
    }
  }
  return analysis::course_section(participants, practice);
}
}  // namespace

std::vector<analysis::ReportSection> study_sections(const protocols::Protocol& protocol,
                                                    const std::vector<StudyStore>& stores,
                                                    results::Mode mode) {
  return {
      course(protocol, stores, mode),
      analysis::questionnaires_section(questionnaires_of(protocol), given_answers(stores, mode))};
}
}  // namespace tapstudy::runner
