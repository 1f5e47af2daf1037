#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "results/store.hpp"
// What reports are made of. All throw StoreError.
namespace tapstudy::results {
// The answers that hold, of all participants and modes, including practice: the caller filters.
// Sorted by mode, participant index and trial number. Who a participant is, the id says; an index
// is unique only within a mode.
std::vector<AnswerRow> stored_answers(Store& store);
// To the alternatives of trials with several.
std::vector<VisitRow> stored_visits(Store& store);

// One visit after the other, of answered trials with several alternatives. Settings of an adjusted
// alternative are not told apart.
struct VisitedPosition {
  std::int64_t trial_id{};
  int position{};
};
std::vector<VisitedPosition> visited_positions(Store& store);

// In the order given.
std::vector<FormAnswerRow> stored_form_answers(Store& store);
// The text of the rig that each trial was presented with.
void each_rig_of_trial(Store& store,
                       const std::function<void(std::int64_t trial_id, std::string rig)>& take);
}  // namespace tapstudy::results
