#pragma once
#include <cstdint>
#include <vector>

#include "core/model/progress_hook.hpp"
#include "runner/accuracy/trade.hpp"
#include "runner/reproduction/routes.hpp"
#include "runner/stimuli/model_library.hpp"
namespace tapstudy::runner {
// What all claims are measured with.
struct Bench {
  Effort effort{Effort::full};  // quick: fewer simulated participants, fewer thicknesses
  std::uint64_t seed{1};
  core::ProgressHook progress{};
  ModelLibrary models{};
  std::vector<Route> plates{routes()};  // of Figures 4 and 5
  bool is_quick() const { return effort == Effort::quick; }
};
}  // namespace tapstudy::runner
