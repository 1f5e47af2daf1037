#include "runner/trial_loop/trial_loop.hpp"
namespace tapstudy::runner {
std::optional<device::ScriptedHand> scripted_hand(const Rendered& rendered,
                                                  const device::LoopSettings& settings) {
  if (!rendered.scripted) {
    return std::nullopt;
  }
  return device::ScriptedHand{*rendered.scripted, settings.placement,
                              1e-9 * static_cast<double>(settings.period)};
}
}  // namespace tapstudy::runner
