#include "runner/session/interruption.hpp"

#include <fmt/format.h>

#include "device/device.hpp"
namespace tapstudy::runner {
std::string to_text(const Interruption& interruption) {
  return fmt::format(
      "trial {}: {}; {}, {}", interruption.trial, core::to_text(interruption.fault),
      interruption.is_force_off
          ? "force is off"
          : fmt::format("{} (the device did not confirm zero force)", device::force_may_be_on),
      interruption.is_answered ? "the answer is stored" : "the trial is stored as interrupted");
}
}  // namespace tapstudy::runner
