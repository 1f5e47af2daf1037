#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "support/usb/fake_usbfs.hpp"

struct pollfd;
namespace tapstudy::testing {
// A USB device of one request and one reply, behind the kernel's interface to user space. The test
// program's own ioctl, read and poll answer for its descriptor; libusb above them is the real one.
// Its clock is the bus's own, which passes only while libusb waits: time-outs take no time, and a
// machine that is busy elsewhere causes none.
// A process forked from this one has the same device: a thread here answers its plain bulk
// transfers.
class FakeBus : private UsbBoard {
 public:
  using Trouble = FakeUsbfs::Trouble;
  // From a request to its reply; empty: none is due.
  using Answer = std::function<Bytes(std::span<const std::uint8_t>)>;

  FakeBus(std::uint16_t vendor, std::uint16_t product, Answer answer);
  ~FakeBus() override;
  FakeBus(const FakeBus&) = delete;
  FakeBus& operator=(const FakeBus&) = delete;
  FakeBus(FakeBus&&) = delete;
  FakeBus& operator=(FakeBus&&) = delete;

  // Opens the device's node; the descriptor is the caller's from then on.
  int open();
  // What a forked process sends to the device goes to this descriptor as well.
  void copy_plain_bulk_to(int descriptor) { plain_bulk_copy_ = descriptor; }
  // Trouble with the next request, or with the one after so many more.
  void plan(Trouble trouble, int after = 0, std::chrono::milliseconds delay = {});
  // Trouble with every request from now on.
  void persist_in(Trouble trouble);
  // Every reply comes so late from now on.
  void reply_after(std::chrono::nanoseconds delay);
  // Requests stall until the halt was cleared so many times.
  void halt_out(int clears);
  void unplug();
  std::vector<Bytes> requests() const;
  void forget_requests();
  void forget_requests_as_they_come() { keeps_requests_ = false; }

  // What the kernel is asked.
  int ioctl(unsigned long request, void* argument);
  std::int64_t read(void* to, std::size_t size);
  int poll(pollfd* all, unsigned long count, std::chrono::nanoseconds time_out);
  static FakeBus* of(int descriptor);
  // The time of all buses, in nanoseconds.
  static std::int64_t now() noexcept;
  static void pass_to(std::int64_t moment) noexcept;

 private:
  Bytes answer(std::span<const std::uint8_t> request) override;
  void show_news();
  void answer_forked_processes();
  int ask_from_forked_process(unsigned long request, void* argument);

  mutable std::mutex mutex_;
  int descriptor_;
  Bytes descriptors_;
  std::size_t read_at_{0};
  Answer answer_;
  FakeUsbfs usbfs_;
  bool is_open_{false};
  bool is_blocked_{false};
  int plain_bulk_copy_{-1};
  std::vector<Bytes> requests_;
  bool keeps_requests_{true};
  int generation_;
  std::array<int, 2> line_{};  // its first end is this process's
  std::thread answering_;
};
}  // namespace tapstudy::testing
