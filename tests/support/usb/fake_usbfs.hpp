#pragma once
#include <chrono>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>
namespace tapstudy::testing {
using Bytes = std::vector<std::uint8_t>;

inline constexpr std::uint8_t out_endpoint = 0x02;
inline constexpr std::uint8_t in_endpoint = 0x86;

// What a device of high speed with one interface and two bulk endpoints of 512 bytes says of
// itself: its device descriptor, then its configuration.
inline Bytes descriptors_of(std::uint16_t vendor, std::uint16_t product) {
  const auto low = [](std::uint16_t word) { return static_cast<std::uint8_t>(word & 0xFFU); };
  const auto high = [](std::uint16_t word) { return static_cast<std::uint8_t>(word >> 8U); };
  const Bytes device{
      18, 1, 0, 2, 0xFF, 0, 0xFF, 64, low(vendor), high(vendor), low(product), high(product),
      0,  1, 0, 0, 0,    1};
  const Bytes configuration{9, 2, 32, 0, 1, 1, 0, 0x80, 250};
  const Bytes interface { 9, 4, 0, 0, 2, 0xFF, 0, 0, 0 };
  const Bytes out{7, 5, out_endpoint, 2, 0, 2, 0};
  const Bytes in{7, 5, in_endpoint, 2, 0, 2, 0};
  Bytes all;
  for (const Bytes& part : {device, configuration, interface, out, in}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}
}  // namespace tapstudy::testing

struct usbdevfs_bulktransfer;
struct usbdevfs_urb;
namespace tapstudy::testing {
// A board of one request and one reply, seen from its two bulk endpoints.
class UsbBoard {
 public:
  virtual ~UsbBoard() = default;
  // Empty: no reply is due.
  virtual Bytes answer(std::span<const std::uint8_t> request) = 0;
};

// Time since some fixed moment.
using Now = std::chrono::nanoseconds (*)();
inline std::chrono::nanoseconds real_now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

// What usbfs does with the descriptor of a board's node, however its ioctls get here. Every
// transfer lies in this process's memory, with its buffer. One thread at a time.
class FakeUsbfs {
 public:
  // What becomes of one exchange.
  enum class Trouble {
    none,
    late,          // the reply comes after `delay`
    missing,       // there is no reply
    every_other,   // likewise, to every second request
    short_reply,   // half of one
    stalled,       // -EPIPE
    protocol,      // -EPROTO
    overflow,      // -EOVERFLOW
    stale,         // the reply before once more
    unplugged,     // while the reply is waited for
    not_accepted,  // the kernel has no memory for the request
    out_nak,       // the board takes no request: it stays with the kernel until it is cancelled
    out_lost,      // the request is taken, and never reaches the board
  };

  FakeUsbfs(UsbBoard& board, unsigned address, Now now = real_now)
      : board_{board}, address_{address}, now_{now} {}

  // As inside the kernel: a result, or a negative errno; -ENOTTY for what it does not know.
  int ioctl(unsigned long request, void* argument);
  // Trouble with the next request, or with the one after so many more.
  void plan(Trouble trouble, int after, std::chrono::milliseconds delay);
  // Trouble with every request that none is planned for.
  void persist_in(Trouble trouble) { lasting_ = trouble; }
  // Every reply comes so late.
  void reply_after(std::chrono::nanoseconds delay) { usual_delay_ = delay; }
  // Requests stall until the halt was cleared so many times, of both endpoints.
  void halt_out(int clears) { clears_needed_ = 2 * clears; }
  void unplug();
  void deliver_what_is_due();

  bool is_gone() const { return is_gone_; }
  // What a program is woken for.
  bool has_news() const { return !done_.empty() || is_gone_; }
  bool is_waited_for() const { return !waiting_.empty(); }
  bool has_reply_under_way() const { return !replies_.empty() && !waiting_.empty(); }
  // Where one is under way.
  std::chrono::nanoseconds next_reply_due() const { return replies_.front().due; }

 private:
  int submit(usbdevfs_urb* urb);
  int take_request(usbdevfs_urb* urb);
  bool is_held_up(usbdevfs_urb* urb, Trouble trouble);
  int clear_halt();
  void send_back(Bytes reply, Trouble trouble);
  void complete(usbdevfs_urb* urb, int status, int length);
  int reap(void** urb);
  int discard(const void* urb);
  void forget_transfers();
  int bulk(const usbdevfs_bulktransfer& transfer);
  int bulk_in(const usbdevfs_bulktransfer& transfer);
  Trouble trouble_now();

  UsbBoard& board_;
  unsigned address_;
  Now now_;
  bool is_gone_{false};
  std::deque<usbdevfs_urb*> waiting_;    // for a reply
  std::deque<usbdevfs_urb*> not_taken_;  // requests that the board does not take
  std::deque<usbdevfs_urb*> done_;
  int clears_needed_{0};
  struct Reply {
    Bytes bytes;
    int status{0};
    std::chrono::nanoseconds due{};
  };
  std::deque<Reply> replies_;
  Bytes last_reply_;
  int asked_{0};  // in Trouble::every_other
  Trouble planned_{Trouble::none};
  Trouble lasting_{Trouble::none};
  int exchanges_until_trouble_{0};
  std::chrono::milliseconds delay_{0};
  std::chrono::nanoseconds usual_delay_{0};
};
}  // namespace tapstudy::testing
