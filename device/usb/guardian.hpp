#pragma once
#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "device/usb/usb_node.hpp"
namespace tapstudy::device {
// What sets all outputs of a board to zero, and the reply by which the board says that it has: the
// kernel takes a packet for a board whose firmware has hung as well.
struct ZeroForcePacket {
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint8_t> request;  // of the reply; empty: the packet itself is replied to
  std::size_t reply_bytes{};          // at most max_reply_bytes
  std::size_t echo_bytes{};           // so many at the beginning are zero; 0: nothing is echoed
};
inline constexpr std::size_t max_reply_bytes = 512;

// Shared memory between the program that renders force and its guardian. Lock-free.
//
// Who may send is a claim: the program claims the output for each exchange and releases it after.
// The guardian takes the output over for good, so a program that stalled between its check and its
// packet learns of it when it releases, and sends zero force in the same tick.
class WatchdogChannel {
 public:
  // Used by the program: between begin and end force may be on, with one heartbeat per tick.
  void begin() noexcept { is_on_.store(true); }
  // Only after zero force was confirmed.
  void end() noexcept {
    must_repeat_.store(false);
    is_on_.store(false);
  }
  // Zero force has been confirmed since the device was opened: a relay may close.
  void allow_power() noexcept { is_power_allowed_.store(true); }
  void beat() noexcept { beats_.fetch_add(1); }
  std::uint64_t rounds() const noexcept { return rounds_.load(); }
  // False: the guardian has taken the output over; nothing but zero force may be sent.
  bool claim_output() noexcept { return hand_over(Output::free, Output::claimed); }
  bool release_output() noexcept { return hand_over(Output::claimed, Output::free); }
  // Zero force could not be confirmed: the guardian shall repeat it until end().
  void repeat_zero_force() noexcept {
    is_zero_confirmed_.store(false);
    must_repeat_.store(true);
  }
  // While the program itself stops the board, the guardian repeats nothing unless the program
  // stands still: of two that read replies each might get the other's.
  void pause_repeating(bool is_paused) noexcept { is_paused_.store(is_paused); }
  // The board has replied to the guardian's zero force since the request to repeat it.
  bool is_zero_confirmed() const noexcept { return is_zero_confirmed_.load(); }
  // The guardian has zeroed the force because the program stalled.
  bool has_acted() const noexcept { return output_.load() == Output::taken_over; }

  // Used by the guardian, once per polling cycle.
  bool is_on() const noexcept { return is_on_.load(); }
  bool must_repeat() const noexcept { return must_repeat_.load(); }
  bool is_paused() const noexcept { return is_paused_.load(); }
  bool is_power_allowed() const noexcept { return is_power_allowed_.load(); }
  bool may_close_relay() const noexcept {
    return is_power_allowed() && !must_repeat() && !has_acted();
  }
  std::uint64_t beats() const noexcept { return beats_.load(); }
  void complete_round() noexcept { rounds_.fetch_add(1); }
  void take_output_over() noexcept { output_.store(Output::taken_over); }
  void note_zero_confirmed() noexcept { is_zero_confirmed_.store(true); }

 private:
  enum class Output : std::uint32_t { free, claimed, taken_over };
  bool hand_over(Output from, Output to) noexcept {
    return output_.compare_exchange_strong(from, to);
  }

  std::atomic<bool> is_on_{false};
  std::atomic<bool> is_power_allowed_{false};
  std::atomic<bool> must_repeat_{false};
  std::atomic<bool> is_paused_{false};
  std::atomic<bool> is_zero_confirmed_{false};
  std::atomic<Output> output_{Output::free};
  std::atomic<std::uint64_t> beats_{0};
  std::atomic<std::uint64_t> rounds_{0};
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
};

// Waits for a fresh round of the guardian, up to 0.1 s.
bool is_guardian_alive(const WatchdogChannel& channel) noexcept;

// Closes all files but these, and the sockets that listen or are bound to a name of their own. A
// forked child without exec inherits them: the lock of a study's journal, the name of a session's
// lock and the port of its pages would stay taken for as long as the child lives. Only
// async-signal-safe functions are used.
void close_files_and_named_sockets(std::span<const int> kept) noexcept;

inline constexpr int guardian_round_ms = 2;

struct GuardianSettings {
  std::uint8_t out_endpoint{};
  std::uint8_t in_endpoint{};
  ZeroForcePacket zero_force_packet;
  double max_stall_s{0.02};  // the program is considered stalled after this time without heartbeat
  int fifo_priority{0};      // asked for; 0: none
  int relay{-1};             // descriptor of a dead-man relay's port; -1: there is none
};

// A watchdog process that outlives this one. The boards are not known to have a watchdog: should
// tapstudy die with force on, for any reason including SIGKILL, the strings would keep pulling. So
// a child process holds the device's open node and waits on a pipe whose other end only tapstudy
// has; when that closes, it sends the zero-force packet three times, and where force may have been
// on until the board replies to it, for a minute at most, and exits. It looks in
// rounds of guardian_round_ms, and sends it every 5 ms and keeps running as long as tapstudy is
// stalled with force on (suspended or starved of CPU time), and where tapstudy could not confirm
// zero force itself: a halted endpoint is cleared first, and the board's reply is read, which alone
// confirms it. It asks for a priority above the loop's and for locked memory of its own, and
// tapstudy offers itself to the kernel's out-of-memory killer first. It also gives the sign of life
// to a dead-man relay (device/relay), from the first confirmed zero force on and unless it has
// taken over or repeats zero force. Why not a library: none outlives the process that it is linked
// into. A supervisor such as systemd does, but would start a program that opens the device anew,
// where this child holds it already.
class Guardian {
 public:
  // May be called with other threads running: the child uses no locks they could hold. Throws
  // DeviceError if it cannot be started.
  Guardian(const UsbNode& node, GuardianSettings settings);
  // The zero-force packet is sent on normal termination, too.
  ~Guardian();
  Guardian(const Guardian& other) = delete;
  Guardian& operator=(const Guardian& other) = delete;
  Guardian(Guardian&& other) = delete;
  Guardian& operator=(Guardian&& other) = delete;
  WatchdogChannel& channel() noexcept { return *channel_; }

 private:
  struct Unmap {
    void operator()(WatchdogChannel* channel) const noexcept;
  };
  static std::unique_ptr<WatchdogChannel, Unmap> shared_channel();

  std::unique_ptr<WatchdogChannel, Unmap> channel_;  // in memory shared with the child
  pid_t child_{-1};
  int life_{-1};  // closed by the kernel when this process ends
};
}  // namespace tapstudy::device
