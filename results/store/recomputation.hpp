#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/model/progress.hpp"
#include "results/store/store.hpp"
namespace tapstudy::results {
// The rule of a task for an answer: right, wrong, or (unset) neither. Not called for trials whose
// block it does not know.
struct TaskRule {
  std::function<bool(const TrialRow& trial)> knows;
  std::function<std::optional<bool>(const TrialRow& trial,
                                    const std::vector<AlternativeRow>& alternatives,
                                    const std::string& response)>
      is_correct;
};

// A trial with what it is held against.
struct StoredTrial {
  std::int64_t id{};
  std::string participant_id;
  TrialRow row;
  std::int64_t ticks{};
  std::int64_t saturated{};
  std::int64_t dropped{};
  bool has_statistics{};
};
std::vector<StoredTrial> stored_trials(Store& store);
// "trial 3 (participant P01, number 3): WHAT is STORED, recomputed RECOMPUTED"
std::string difference_in(const StoredTrial& trial, const std::string& what,
                          const std::string& stored, const std::string& recomputed);

// Recomputes what a study stores twice, and says where the two differ, a line each, naming table,
// trial and column:
//   event            contacts, impacts (with their speeds), releases, switches, from the trace, bit
//                    for bit: visits, dwell times and the fastest impact follow from them
//   trial            duration_s, from the trace's last tick
//   tick_statistics  ticks, saturated, from the trace; no saturated ones without ticks
//   trace_chunk      first_tick, from the chunks before it
//   alternative      position, from 0 without a gap
//   response         time_from_first_contact_s, from response_time_s and the first contact;
//                    is_correct, by the rule; of a correction supersedes, response_time_s and
//                    confidence, from the answer before it
//   all              that every row which another refers to is there
// Trials without a trace (real plates, simulations without traces) have nothing of the first four
// to compare; a trace that ought to be there and is not is a difference. Throws StoreError where a
// trace is damaged.
struct Recomputation {
  std::vector<std::string> differences;
  std::int64_t ticks{};  // read
  std::int64_t events{};
  std::int64_t answers{};         // held against the rule
  std::int64_t unknown_blocks{};  // answers of blocks that the rule does not know
};
Recomputation recompute(Store& store, const TaskRule& rule, const core::CountHook& count = {});
}  // namespace tapstudy::results
