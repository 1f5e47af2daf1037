#pragma once
#include <functional>
#include <string_view>
namespace tapstudy::core {
// Told what a long computation has come to, between its steps; may throw to stop it. Empty: nobody
// wants to know.
using ProgressHook = std::function<void(std::string_view stage)>;

inline void tell(const ProgressHook& progress, std::string_view stage) {
  if (progress) {
    progress(stage);
  }
}
}  // namespace tapstudy::core
