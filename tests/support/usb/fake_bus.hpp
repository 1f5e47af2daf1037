#pragma once
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "support/usb/descriptors.hpp"

struct usbdevfs_urb;
struct pollfd;
namespace tapstudy::testing {
// A USB device of one request and one reply, behind the kernel's interface to user space. The test
// program's own ioctl, read and poll answer for its descriptor; libusb above them is the real one.
class FakeBus {
 public:
  // What becomes of one exchange.
  enum class Trouble {
    none,
    late,          // the reply comes after `delay`
    missing,       // there is no reply
    short_reply,   // half of one
    stalled,       // -EPIPE
    protocol,      // -EPROTO
    overflow,      // -EOVERFLOW
    stale,         // the reply before once more
    unplugged,     // while the reply is waited for
    not_accepted,  // the kernel has no memory for the request
  };
  // From a request to its reply; empty: none is due.
  using Answer = std::function<Bytes(std::span<const std::uint8_t>)>;

  FakeBus(std::uint16_t vendor, std::uint16_t product, Answer answer);
  ~FakeBus();
  FakeBus(const FakeBus&) = delete;
  FakeBus& operator=(const FakeBus&) = delete;
  FakeBus(FakeBus&&) = delete;
  FakeBus& operator=(FakeBus&&) = delete;

  // Opens the device's node; the descriptor is the caller's from then on.
  int open();
  // What is sent to the device without libusb goes to this descriptor as well.
  void copy_plain_bulk_to(int descriptor) { plain_bulk_copy_ = descriptor; }
  // Trouble with the next request, or with the one after so many more.
  void plan(Trouble trouble, int after = 0, std::chrono::milliseconds delay = {});
  void unplug();
  std::vector<Bytes> requests() const;
  void forget_requests();
  void forget_requests_as_they_come() { keeps_requests_ = false; }

  // What the kernel is asked.
  int ioctl(unsigned long request, void* argument);
  std::int64_t read(void* to, std::size_t size);
  int poll(pollfd* all, unsigned long count, int time_out_ms);
  static FakeBus* of(int descriptor);

 private:
  using Clock = std::chrono::steady_clock;
  int submit(usbdevfs_urb* urb);
  int take_request(usbdevfs_urb* urb);
  void answer(Bytes reply, Trouble trouble);
  void complete(usbdevfs_urb* urb, int status, int length);
  void deliver();
  int reap(void** urb);
  int discard(const void* urb);
  void deliver_what_is_due();
  void show_whether_done();
  void drop_pending();
  Trouble trouble_now();

  mutable std::mutex mutex_;
  int descriptor_;
  Bytes descriptors_;
  std::size_t read_at_{0};
  Answer answer_;
  bool is_open_{false};
  int plain_bulk_copy_{-1};
  bool is_gone_{false};
  bool is_blocked_{false};
  std::deque<usbdevfs_urb*> waiting_;  // for a reply
  std::deque<usbdevfs_urb*> done_;
  struct Reply {
    Bytes bytes;
    int status{0};
    Clock::time_point due{};
  };
  std::deque<Reply> replies_;
  Bytes last_reply_;
  std::vector<Bytes> requests_;
  bool keeps_requests_{true};
  Trouble planned_{Trouble::none};
  int exchanges_until_trouble_{0};
  std::chrono::milliseconds delay_{0};
};
}  // namespace tapstudy::testing
