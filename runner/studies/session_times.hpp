#pragma once
#include <string>
#include <vector>

#include "results/store/store.hpp"
namespace tapstudy::runner {
struct CheckedTimes {
  std::vector<std::string> wrong;     // no times
  std::vector<std::string> unlikely;  // unless the clock was set
};
// When people's sessions began. Within a session times are of a monotonic clock; between two of one
// participant there are only their order and the wall clock, which may be set back at any time. So
// a session that began before the one before it was over is told, and is no damage.
CheckedTimes checked_session_times(results::Store& store);
}  // namespace tapstudy::runner
