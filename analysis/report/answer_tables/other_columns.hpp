#pragma once
#include <string>
#include <vector>

#include "analysis/report/answer_tables/answer_weights.hpp"
namespace tapstudy::analysis {
// What columns say by their values, whatever they are called, so that to leave them aside would
// change a number. Throws InvalidInput that says which option decides:
// - two values of which one stands at one answer to each stimulus, as if these were right, and at
//   others than the names say; for each stimulus an answer that is not its name;
// - where participants are not known, few values, each in many rows one after the other;
// - the same answers once for each value; trials of one participant with the same number, or rows
//   that are the same to the letter;
// - several values of a column that is called after tasks;
// - a text at the first few answers of every participant, and never later: as practice has it.
void check_other_columns(const std::vector<OtherColumns>& files,
                         const std::vector<results::AnswerRow>& answers,
                         const AnswerOrigins& origins, const AnswerReading& reading,
                         bool are_participants_known);
}  // namespace tapstudy::analysis
