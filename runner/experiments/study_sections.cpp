#include "runner/experiments/study_sections.hpp"

#include <algorithm>

#include "analysis/confidence/confidence_section.hpp"
#include "analysis/course/course_section.hpp"
#include "analysis/rendered/rendered_section.hpp"
#include "results/participant_courses.hpp"
#include "runner/experiments/counted_answers.hpp"
#include "runner/experiments/given_forms.hpp"
#include "runner/experiments/rendered_study.hpp"
#include "runner/experiments/track_results.hpp"
#include "runner/session/practice_record.hpp"
namespace tapstudy::runner {
namespace {
using results::ParticipantCourseRow;

using Answers = std::vector<results::JournalledAnswer>;

// Of one block; no trials if it was not practised, or has no right answers.
analysis::Proportion right_in(const protocols::Block& block, const Answers& answers) {
  analysis::Proportion right;
  for (const results::JournalledAnswer& answer : answers) {
    const auto& is_correct = answer.response.is_correct;
    if (answer.trial.is_practice && answer.trial.block == block.name && is_correct) {
      right.add(*is_correct);
    }
  }
  return right;
}

bool is_practised(const protocols::Block& block, const Answers& answers) {
  return std::ranges::any_of(answers, [&](const results::JournalledAnswer& answer) {
    return answer.trial.is_practice && answer.trial.block == block.name;
  });
}

void add_practice(const protocols::Protocol& protocol, const std::string& participant,
                  results::Store& store, std::vector<analysis::PracticeResult>& practice) {
  const Answers answers = store.answers_as_given(participant);
  const PracticeRecord record{answers};
  for (const protocols::Block& block : protocol.blocks) {
    if (is_practised(block, answers)) {
      analysis::PracticeResult result{participant, block.name, right_in(block, answers)};
      if (block.criterion) {
        result.is_criterion_met = record.is_met(block);
      }
      practice.push_back(result);
    }
  }
}

analysis::ReportSection course(const protocols::Protocol& protocol,
                               const std::vector<StudyStore>& stores, results::Mode mode) {
  std::vector<ParticipantCourseRow> participants;
  std::vector<analysis::PracticeResult> practice;
  for (const StudyStore& each : stores) {
    for (const ParticipantCourseRow& row : results::participant_courses(*each.store)) {
      if (row.mode == mode) {
        participants.push_back(row);
        add_practice(protocol, row.participant_id, *each.store, practice);
      }
    }
  }
  return analysis::course_section(participants, practice, protocol.masking.has_value());
}

std::vector<analysis::ConfidenceScale> confidence_scales(const protocols::Protocol& protocol) {
  std::vector<analysis::ConfidenceScale> scales;
  for (const protocols::Block& block : protocol.blocks) {
    if (block.confidence) {
      const protocols::Confidence& asked = *block.confidence;
      scales.push_back({block.name, asked.steps, asked.low, asked.high});
    }
  }
  return scales;
}

// Answers are read only where confidence was asked.
analysis::ReportSection confidence(const protocols::Protocol& protocol,
                                   const std::vector<StudyStore>& stores, results::Mode mode) {
  const std::vector<analysis::ConfidenceScale> scales = confidence_scales(protocol);
  std::vector<results::AnswerRow> answers;
  for (std::size_t i = 0; i < stores.size() && !scales.empty(); ++i) {
    std::ranges::move(counted_answers(*stores[i].store, mode), std::back_inserter(answers));
  }
  return analysis::confidence_section(scales, answers);
}
}  // namespace

std::vector<analysis::ReportSection> study_sections(const protocols::Protocol& protocol,
                                                    const std::vector<StudyStore>& stores,
                                                    results::Mode mode, const DoneBlocks& done) {
  return {
      course(protocol, stores, mode), confidence(protocol, stores, mode),
      analysis::procedures_section(track_results(protocol, stores, mode)),
      analysis::questionnaires_section(questionnaires_of(protocol), given_answers(stores, mode)),
      analysis::rendered_section(rendered_study(protocol, stores, mode, done))};
}
}  // namespace tapstudy::runner
