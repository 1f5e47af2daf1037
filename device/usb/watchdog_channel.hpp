#pragma once
#include <atomic>
#include <cstdint>
namespace tapstudy::device {
// Shared memory between the program that renders force and its guardian. Lock-free.
class WatchdogChannel {
 public:
  // Used by the program: between begin and end force may be on, with one heartbeat per tick.
  void begin() noexcept { is_on_.store(true); }
  void end() noexcept { is_on_.store(false); }
  void beat() noexcept { beats_.fetch_add(1); }
  std::uint64_t rounds() const noexcept { return rounds_.load(); }
  // The guardian has zeroed the force because the program stalled.
  bool has_acted() const noexcept { return has_acted_.load(); }

  // Used by the guardian, once per polling cycle.
  bool is_on() const noexcept { return is_on_.load(); }
  std::uint64_t beats() const noexcept { return beats_.load(); }
  void complete_round() noexcept { rounds_.fetch_add(1); }
  void act() noexcept { has_acted_.store(true); }

 private:
  std::atomic<bool> is_on_{false};
  std::atomic<bool> has_acted_{false};
  std::atomic<std::uint64_t> beats_{0};
  std::atomic<std::uint64_t> rounds_{0};
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
};
}  // namespace tapstudy::device
