#pragma once
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/document/sections.hpp"
#include "results/rows.hpp"
namespace tapstudy::analysis {
// A participant's answers to the trials of a practice block, as first given.
struct PracticeResult {
  std::string participant_id;
  std::string block;
  Proportion right;                        // of the answers that are right or wrong
  std::optional<bool> is_criterion_met{};  // unset: the block has none
};

// How the sessions went: tables course, exclusions, attention, practice, loop_quality or, in
// virtual time, saturation, and masking, a row a participant, in the order of the rows. Only counts
// and extremes of what is stored. has_masking: the protocol asks for masking noise.
ReportSection course_section(const std::vector<results::ParticipantCourseRow>& participants,
                             const std::vector<PracticeResult>& practice, bool has_masking);
}  // namespace tapstudy::analysis
