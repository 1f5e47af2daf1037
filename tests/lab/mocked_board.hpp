#pragma once
#include <sys/types.h>
#include <umockdev.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>

#include "support/usb/simulated_spidar.hpp"
namespace tapstudy::lab {
// A simulated SPIDAR-G6 at a node of a mocked kernel: what usbfs would do with its descriptor is
// done here, in the test bed's own thread, for a program in another process.
class MockedBoard {
 public:
  struct Log {
    int requests{0};
    int max_dac_counts{0};
    int requests_without_force_at_the_end{0};
  };
  // After each exchange, counted from 1, when the program has its reply.
  using AfterExchange = std::function<void(int exchange)>;

  MockedBoard(UMockdevTestbed* bed, int address, AfterExchange after);
  ~MockedBoard();
  MockedBoard(const MockedBoard&) = delete;
  MockedBoard& operator=(const MockedBoard&) = delete;
  MockedBoard(MockedBoard&&) = delete;
  MockedBoard& operator=(MockedBoard&&) = delete;

  void plug_in();
  void unplug();
  void fall_silent() { is_silent_ = true; }
  std::string node() const;
  Log log();
  // The process that inherits the node and sends what it sends by itself.
  void set_heir(pid_t heir) { heir_ = heir; }
  // The mutex is held meanwhile.
  void with_hardware(const std::function<void(testing::SimulatedSpidar&)>& act);

 private:
  static gboolean handle(UMockdevIoctlBase* base, UMockdevIoctlClient* client, gpointer self);
  bool answer(UMockdevIoctlClient* client);
  void submit(UMockdevIoctlClient* client);
  void reap(UMockdevIoctlClient* client);
  void discard(UMockdevIoctlClient* client);
  void bulk(UMockdevIoctlClient* client);
  void take_request(const testing::Bytes& request);
  void deliver();
  void end_waiting(int status);
  std::string name() const;

  UMockdevTestbed* bed_;
  UMockdevIoctlBase* base_;
  int address_;
  AfterExchange after_;
  std::mutex mutex_;
  testing::SimulatedSpidar hardware_;
  std::deque<UMockdevIoctlData*> waiting_;  // transfers that wait for a reply
  std::deque<UMockdevIoctlData*> done_;
  std::deque<testing::Bytes> replies_;
  Log log_;
  int exchange_that_ended_{0};
  std::atomic<pid_t> heir_{-1};
  bool is_gone_{false};
  bool is_silent_{false};
};
}  // namespace tapstudy::lab
