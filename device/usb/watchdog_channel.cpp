#include "device/usb/watchdog_channel.hpp"

#include <ctime>
namespace tapstudy::device {
bool is_guardian_alive(const WatchdogChannel& channel) noexcept {
  constexpr timespec pause{0, 2'000'000};
  constexpr int max_pauses = 50;
  const std::uint64_t rounds = channel.rounds();
  for (int i = 0; i < max_pauses && channel.rounds() == rounds; ++i) {
    nanosleep(&pause, nullptr);
  }
  return channel.rounds() != rounds;
}
}  // namespace tapstudy::device
