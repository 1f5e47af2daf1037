#pragma once
#include <functional>
#include <string_view>
namespace tapstudy::core {
// Called between the steps of a long computation with its current stage; may throw to cancel it.
// May be empty.
using ProgressHook = std::function<void(std::string_view stage)>;

inline void tell(const ProgressHook& progress, std::string_view stage) {
  if (progress) {
    progress(stage);
  }
}
}  // namespace tapstudy::core
