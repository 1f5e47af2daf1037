#pragma once
#include <sys/types.h>
#include <umockdev.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "support/usb/fake_usbfs.hpp"
#include "support/usb/simulated_spidar.hpp"
namespace tapstudy::lab {
// A copy of what lies in the memory of the program.
struct Unref {
  void operator()(UMockdevIoctlData* data) const { g_object_unref(data); }
};
using ClientData = std::unique_ptr<UMockdevIoctlData, Unref>;

// A simulated SPIDAR-G6 at a node of a mocked kernel: usbfs is asked here, in the test bed's own
// thread, for a program in another process.
class MockedBoard : private testing::UsbBoard {
 public:
  struct Log {
    int requests{0};
    int dac_counts{0};  // the largest of the last request
    int max_dac_counts{0};
    int requests_without_force_at_the_end{0};
  };
  // After each exchange, counted from 1, when the program has its reply.
  using AfterExchange = std::function<void(int exchange)>;

  MockedBoard(UMockdevTestbed* bed, int address, AfterExchange after);
  ~MockedBoard() override;
  MockedBoard(const MockedBoard&) = delete;
  MockedBoard& operator=(const MockedBoard&) = delete;
  MockedBoard(MockedBoard&&) = delete;
  MockedBoard& operator=(MockedBoard&&) = delete;

  void plug_in();
  void unplug();
  // Its OUT endpoint is halted until that is cleared; its firmware hangs, while its endpoint takes
  // requests; takes nothing; takes requests again.
  void halt();
  void hang();
  void stop_taking();
  void take_again();
  void fall_silent() { usbfs_.persist_in(testing::FakeUsbfs::Trouble::missing); }
  std::string node() const;
  Log log();
  // The process that inherits the node and sends what it sends by itself.
  void set_heir(pid_t heir) { heir_ = heir; }
  // The mutex is held meanwhile.
  void with_hardware(const std::function<void(testing::SimulatedSpidar&)>& act);

 private:
  static gboolean handle(UMockdevIoctlBase* base, UMockdevIoctlClient* client, gpointer self);
  bool answer(UMockdevIoctlClient* client);
  bool pass_on(UMockdevIoctlClient* client);
  void submit(UMockdevIoctlClient* client);
  void reap(UMockdevIoctlClient* client);
  void discard(UMockdevIoctlClient* client);
  void bulk(UMockdevIoctlClient* client);
  testing::Bytes answer(std::span<const std::uint8_t> request) override;
  std::string name() const;

  UMockdevTestbed* bed_;
  UMockdevIoctlBase* base_;
  int address_;
  AfterExchange after_;
  std::mutex mutex_;
  testing::SimulatedSpidar hardware_;
  testing::FakeUsbfs usbfs_;
  std::vector<ClientData> under_way_;  // transfers that were submitted and not reaped
  Log log_;
  int exchange_that_ended_{0};
  std::atomic<pid_t> heir_{-1};
};
}  // namespace tapstudy::lab
