#pragma once
#include <cstddef>
#include <functional>
#include <string>
namespace tapstudy::core {
struct ChildLimits {
  int processor_s{60};
  std::size_t memory_bytes{4'000'000'000};  // more than this process has now
};

// Runs foreign code that may crash or hang on bad input in a process of its own, with limits on
// time and memory, and returns the bytes that it made. `act` must not start threads; an Error that
// it throws arrives here as the same type. Throws ModelError, beginning with `what`, if the process
// was killed, whatever it was killed by.
std::string in_bounded_child(const std::string& what, const std::function<std::string()>& act,
                             const ChildLimits& limits = {});
}  // namespace tapstudy::core
