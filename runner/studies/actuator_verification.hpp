#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "results/store/store.hpp"
namespace tapstudy::runner {
// What actuators were given, held against what is rendered from the traces again: the contact
// follows from the hand, the modes' weights from the contact, what passed the device's limits from
// the forces, and when a tick is heard from the times of the card's periods. Two programs of one
// version agree to single precision; what another version renders otherwise is a remark.
struct ActuatorVerification {
  std::vector<std::string> differences;
  std::vector<std::string> remarks;
  std::int64_t samples{};  // that were compared
};
// Without a protocol, what is stored is decoded and no more.
ActuatorVerification checked_actuators(results::Store& store,
                                       const std::optional<protocols::Protocol>& protocol);
}  // namespace tapstudy::runner
