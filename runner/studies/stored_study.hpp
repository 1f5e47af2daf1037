#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include "analysis/report/study/questionnaires.hpp"
#include "protocols/protocol.hpp"
#include "protocols/reader/earlier_defaults.hpp"
#include "protocols/schedule/schedule.hpp"
#include "results/rows.hpp"
#include "results/store/store.hpp"
namespace tapstudy::runner {
// A store of a study: of one rig, where there were several.
struct StudyStore {
  std::string directory;  // in messages
  results::Store* store;
};

// Whether a version of tapstudy, "0.2.0", is an earlier one; false of what is no version.
bool is_before(const std::string& version, int major, int minor);
// What a study of sessions run by these versions of tapstudy leaves out: begun before 0.3, it keeps
// the linear elements of that time.
protocols::EarlierDefaults defaults_of(const std::set<std::string>& program_versions);
protocols::EarlierDefaults defaults_of(results::Store& store);

// The protocol of a study, from its store alone: the files named by it may no longer exist. Throws
// InvalidInput where it cannot be read.
protocols::Protocol stored_protocol(results::Store& store);
// The same where its rows are read by it: throws StoreError as check_names (stored_names.hpp).
protocols::Protocol checked_protocol(results::Store& store);
// The protocol of a file, as the study in this directory is to go on with it, if one has begun.
protocols::Protocol protocol_to_go_on_with(const std::string& file, const std::string& language,
                                           const std::string& directory);

// A trial as it was presented, as its task sees it.
protocols::PlannedTrial stored_trial(const results::TrialRow& row,
                                     const std::vector<results::AlternativeRow>& alternatives,
                                     const protocols::Block& block);

inline constexpr const char* unfinished_beginning =
    "is the unfinished beginning of a study, without a session (its program was ended before the "
    "first one; another with the same --out goes on with it)";

// The course of each block over participants of a mode, of all stores together.
using DoneBlocks = std::map<std::string, results::BlockCourseRow>;
DoneBlocks done_blocks(const std::vector<StudyStore>& stores, results::Mode mode);
// Names of the stimuli that the device rendered in these blocks.
std::set<std::string> rendered_stimuli(const protocols::Protocol& protocol, const DoneBlocks& done);

// Whom a report is of where nobody says it: real participants; without any those there are.
results::Mode mode_to_report(const std::vector<results::SessionRow>& sessions);

// The answers that a report is of, with their alternatives: of one mode, without practice, catch
// trials and excluded participants.
std::vector<results::AnswerRow> counted_answers(results::Store& store, results::Mode mode);

// The forms of a protocol that are asked somewhere, by name, with the places in a session's order.
std::vector<analysis::Questionnaire> questionnaires_of(const protocols::Protocol& protocol);
// Answers of participants of the mode to questionnaires; not of those who were excluded.
std::vector<analysis::GivenAnswer> given_answers(const std::vector<StudyStore>& stores,
                                                 results::Mode mode);
}  // namespace tapstudy::runner
