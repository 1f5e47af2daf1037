#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>
namespace tapstudy::analysis {
// The words of a column's name or of a cell, in small letters: "isPracticeTrial" has three.
std::vector<std::string> words_of_name(const std::string& name);

using Words = std::span<const std::string_view>;  // in small letters
// Whether one of the name's words is known, or begins with one of the stems.
bool has_word(const std::string& name, Words known);
bool has_word_beginning(const std::string& name, Words stems);

// Whether a column of that name tells runs of one participant apart: "sessionID", "Datum", "visit".
bool tells_runs(const std::string& name);

// "2026-11-02", "02.11.26 14:05": another one with each run, whatever the column is called.
bool looks_like_date(const std::string& cell);

// Whether a row is practice, or not to be counted, by what stands in one of its columns: the word
// itself ("practice", "entraînement", "warm-up", E-Prime's "PracProc", Qualtrics' "Survey Preview",
// "catch", "excluded" …), yes in a column that is called after it, no in one that says what counts
// ("include", "valid", "finished"), a state of somebody who did not finish or was not accepted
// ("REJECTED", "returned", "live"), or the count of PsychoPy's loop of that name.
bool says_uncounted(const std::string& column, const std::string& cell);
// Whether a column is called after the state of a participant or a submission.
bool is_of_states(const std::string& column);
}  // namespace tapstudy::analysis
