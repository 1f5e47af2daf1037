#include "runner/session/trial_progress.hpp"
namespace tapstudy::runner {
TrialProgress progress_at(const protocols::PlannedTrial& trial, const protocols::Schedule& schedule,
                          const std::set<int>& done, const protocols::Protocol& protocol) {
  const auto is_practice = [&](const protocols::PlannedTrial& of) {
    return protocol.block(of.block).is_practice;
  };
  TrialProgress progress{0, 0, is_practice(trial)};
  for (const protocols::PlannedTrial& other : schedule) {
    const bool is_of_it = is_practice(other) == progress.is_practice;
    progress.total += is_of_it ? 1 : 0;
    progress.done += is_of_it && done.contains(other.number) ? 1 : 0;
    progress.is_open_ended |= is_of_it && may_procedures_end_early(protocol.block(other.block));
  }
  return progress;
}
}  // namespace tapstudy::runner
