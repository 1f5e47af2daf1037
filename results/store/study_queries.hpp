#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "results/store/store.hpp"
// Queries for reports. All throw StoreError.
namespace tapstudy::results {
// The answers that hold, of all participants and modes, including practice: the caller filters.
// Sorted by mode, participant index and trial number. Who a participant is, the id says; an index
// is unique only within a mode.
std::vector<AnswerRow> stored_answers(Store& store);
// Visits to the alternatives of trials that have several.
std::vector<VisitRow> stored_visits(Store& store);

// One visit after the other, of answered trials with several alternatives. Settings of an adjusted
// alternative are not told apart.
struct VisitedPosition {
  std::int64_t trial_id{};
  int position{};
};
std::vector<VisitedPosition> visited_positions(Store& store);

// Answers to questionnaires in the order given, as corrected.
std::vector<FormAnswerRow> stored_form_answers(Store& store);
// The text of the rig that each trial was presented with.
void each_rig_of_trial(Store& store,
                       const std::function<void(std::int64_t trial_id, std::string rig)>& take);

// The course of the sessions of each participant; sorted by mode and index. Throws StoreError.
std::vector<ParticipantCourseRow> participant_courses(Store& store);
// The course of each block with an answer, by name. Throws StoreError.
std::map<std::string, BlockCourseRow> block_courses(Store& store, Mode mode);

using TakeChunk = std::function<void(std::int64_t trial_id, std::span<const core::TraceSample>)>;

// Every trace of a study in one pass, by session, number and attempt, each in order of time: one
// chunk (4096 ticks) is held at a time. Ids follow the order of storing, which differs from run to
// run where sessions are simulated at once. Throws StoreError if a chunk cannot be decoded.
void each_trace_chunk(Store& store, const TakeChunk& take);

// Throws StoreError, naming `what` is encoded so, unless that is known.
void check_codec(const std::string& codec, const char* known, const std::string& what);
// The samples of a row of trace_chunk, whose columns from this one on are codec, ticks and bytes.
// Throws StoreError, naming `what` they are, if they are of another codec or cannot be decoded.
std::vector<core::TraceSample> decoded_chunk(Statement& row, int column, const std::string& what);
}  // namespace tapstudy::results
