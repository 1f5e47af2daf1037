#pragma once
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
namespace tapstudy::runner {
struct ScreenGroup {
  std::string shown;  // in words
  int count{};
  double seconds{};  // that all of them take, roughly; of trials without the tapping
};
// What one participant sees, in this order: the most that there can be, if no trial is repeated.
std::vector<ScreenGroup> screens_of(const protocols::Protocol& protocol);
}  // namespace tapstudy::runner
