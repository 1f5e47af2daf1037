#pragma once
#include <vector>

#include "results/store.hpp"
namespace tapstudy::runner {
// The answers that a report is of, with their alternatives: of one mode, without practice, catch
// trials and excluded participants.
std::vector<results::AnswerRow> counted_answers(results::Store& store, results::Mode mode);
}  // namespace tapstudy::runner
