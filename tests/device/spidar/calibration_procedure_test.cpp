#include "device/spidar/calibration_procedure.hpp"

#include <unistd.h>

#include <sstream>
#include <thread>

#include "core/error.hpp"
#include "device/device.hpp"
#include "device/spidar/calibration.hpp"
#include "protocols/reader/read_rig.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
#include "support/usb/spidar_on_bus.hpp"
using namespace tapstudy;

namespace {
// A board whose eight strings differ: metres a count, newtons a digit, friction.
struct Workbench {
  std::array<int, 8> count{};
  std::array<int, 8> dac_counts{};
  int max_dac_counts{0};
  double newtons_per_count_scale{1.0};
  testing::FakeBus bus{device::cyverse_vendor, device::sh4_product,
                       [this](auto request) { return reply(request); }};
  device::UsbNode node{testing::node_of(bus)};
  device::LibusbPipe pipe{node, {}, std::chrono::milliseconds{100}, testing::FakeBus::now};
  std::unique_ptr<device::SpidarBoard> board{device::board_of(device::sh4_product)};
  device::WatchdogChannel watchdog;
  device::VirtualClock clock;
  std::jthread guardian{[this](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      watchdog.complete_round();
      usleep(1000);
    }
  }};

  static double metres_per_count(std::size_t i) {
    return (i % 2 == 0 ? 1.0 : -1.0) * (1.6e-5 + 1e-7 * static_cast<double>(i));
  }
  static double newtons_per_dac_count(std::size_t i) {
    return 0.006 + 0.0005 * static_cast<double>(i);
  }
  static constexpr double friction_n = 0.2;

  testing::Bytes reply(std::span<const std::uint8_t> request) {
    testing::Bytes bytes(512, 0);
    for (std::size_t i = 0; i < 8; ++i) {
      dac_counts.at(i) = request[2 + 2 * i] | request[3 + 2 * i] << 8;
      max_dac_counts = std::max(max_dac_counts, dac_counts.at(i));
      bytes[16 + 2 * i] = static_cast<std::uint8_t>(count.at(i) & 0xFF);
      bytes[17 + 2 * i] = static_cast<std::uint8_t>(count.at(i) >> 8 & 0xFF);
    }
    return bytes;
  }
};

// Does what is asked, on the string whose turn it is.
class SkilledOperator : public device::CalibrationOperator {
 public:
  explicit SkilledOperator(Workbench& bench) : bench_{bench} {}
  void please(const std::string& task) override {
    string_ = std::stoi(task.substr(task.find("String ") + 7)) - 1;
  }
  double how_much(const std::string& task, double /*max*/,
                  const std::function<void()>& keep_waiting) override {
    const auto i = static_cast<std::size_t>(string_);
    keep_waiting();
    if (task.find("metres") != std::string::npos) {
      bench_.count.at(i) += static_cast<int>(0.1 / Workbench::metres_per_count(i));
      return 0.1;
    }
    return bench_.newtons_per_count_scale * Workbench::newtons_per_dac_count(i) *
               bench_.dac_counts.at(i) +
           bench_.newtons_per_count_scale * Workbench::friction_n;
  }

 private:
  Workbench& bench_;
  int string_{-1};
};

// Whose one answer, counted from 1, is another: a slip of the pen.
class SlippingOperator final : public SkilledOperator {
 public:
  SlippingOperator(Workbench& bench, int slip, double factor)
      : SkilledOperator{bench}, slip_{slip}, factor_{factor} {}
  double how_much(const std::string& task, double max,
                  const std::function<void()>& keep_waiting) override {
    const double right = SkilledOperator::how_much(task, max, keep_waiting);
    return ++answers_ == slip_ ? factor_ * right : right;
  }
  void warn(const std::string& what) noexcept override { warnings += what + "\n"; }
  std::string warnings;

 private:
  int slip_;
  double factor_;
  int answers_{0};
};

// Pulls no string, and gives up at the second time.
class IdleOperator final : public device::CalibrationOperator {
 public:
  void please(const std::string& /*task*/) override {
    if (!warnings.empty()) {
      throw core::InvalidInput{"gave up"};
    }
  }
  double how_much(const std::string& /*task*/, double /*max*/,
                  const std::function<void()>& /*keep_waiting*/) override {
    return 0.1;
  }
  void warn(const std::string& what) noexcept override { warnings += what; }
  std::string warnings;
};
}  // namespace

TEST_CASE("what a skilled operator measures is what the strings are", "[device][calibration]") {
  Workbench bench;
  SkilledOperator person{bench};
  const auto strings =
      device::calibrate_spidar(*bench.board, bench.pipe, bench.watchdog, bench.clock, person)
          .strings;
  for (std::size_t i = 0; i < 8; ++i) {
    CHECK(strings.at(i).metres_per_count == Approx(Workbench::metres_per_count(i)).epsilon(1e-3));
    const double newtons_per_dac_count =
        1.0 / (strings.at(i).volts_per_newton * strings.at(i).dac_counts_per_volt);
    CHECK(newtons_per_dac_count == Approx(Workbench::newtons_per_dac_count(i)).epsilon(1e-9));
  }
  CHECK(bench.max_dac_counts <= device::calibration_dac_counts);
  CHECK(std::ranges::all_of(bench.dac_counts, [](int dac_counts) { return dac_counts == 0; }));
}

TEST_CASE("what calibration writes, a rig reads", "[device][calibration]") {
  Workbench bench;
  SkilledOperator person{bench};
  const core::SpidarCalibration measured =
      device::calibrate_spidar(*bench.board, bench.pipe, bench.watchdog, bench.clock, person);
  std::ostringstream file;
  protocols::write_calibration(file, "X3R", measured);
  const core::SpidarCalibration read =
      protocols::parse_calibration(file.str(), "spidar_calibration.yaml", "X3R");
  CHECK(read.min_tension_n == measured.min_tension_n);
  CHECK(read.max_tension_n == measured.max_tension_n);
  for (std::size_t i = 0; i < read.strings.size(); ++i) {
    CHECK(read.strings[i].metres_per_count ==
          Approx(measured.strings[i].metres_per_count).epsilon(1e-5));
    CHECK(read.strings[i].volts_per_newton ==
          Approx(measured.strings[i].volts_per_newton).epsilon(1e-5));
  }
}

TEST_CASE("an implausible reading costs one string, not the whole calibration",
          "[device][calibration]") {
  const auto [slip, factor, said] = GENERATE(table<int, double, std::string>(
      {{6, 10.0, "are not proportional"},   // the gauge at string 2, stronger output
       {5, 0.01, "are not proportional"},   // at the weaker one
       {7, 4.0, "metres_per_count is"}}));  // the ruler at string 3
  Workbench bench;
  SlippingOperator person{bench, slip, factor};
  const auto strings =
      device::calibrate_spidar(*bench.board, bench.pipe, bench.watchdog, bench.clock, person)
          .strings;
  CHECK_THAT(person.warnings, Contains(said));
  for (std::size_t i = 0; i < 8; ++i) {
    CHECK(strings.at(i).metres_per_count == Approx(Workbench::metres_per_count(i)).epsilon(1e-3));
  }
}

TEST_CASE("calibration asks for no more tension than the board can put out, so a rig accepts it",
          "[device][calibration]") {
  Workbench bench;
  SkilledOperator person{bench};
  bench.newtons_per_count_scale = 0.3;
  const core::SpidarCalibration measured =
      device::calibrate_spidar(*bench.board, bench.pipe, bench.watchdog, bench.clock, person);
  CHECK(measured.max_tension_n == Approx(4095 * 0.3 * 0.006).epsilon(1e-9));
  CHECK_NOTHROW(device::check_calibration(measured));
}

TEST_CASE("an encoder that does not move is told, and all outputs are zero when calibration ends",
          "[device][calibration]") {
  Workbench bench;
  IdleOperator person;
  CHECK_THROWS_WITH(
      device::calibrate_spidar(*bench.board, bench.pipe, bench.watchdog, bench.clock, person),
      "gave up");
  CHECK_THAT(person.warnings, Contains("string 1: its encoder counted 0"));
  CHECK(std::ranges::all_of(bench.dac_counts, [](int dac_counts) { return dac_counts == 0; }));
}

TEST_CASE("a board that is unplugged ends calibration", "[device][calibration]") {
  Workbench bench;
  SkilledOperator person{bench};
  bench.bus.plan(testing::FakeBus::Trouble::unplugged, 10);
  CHECK_THROWS_AS(
      device::calibrate_spidar(*bench.board, bench.pipe, bench.watchdog, bench.clock, person),
      device::DeviceError);
}

namespace {
// Reads the gauge never: something else happens while a string pulls.
class SlowOperator final : public device::CalibrationOperator {
 public:
  explicit SlowOperator(std::function<void()> meanwhile) : meanwhile_{std::move(meanwhile)} {}
  void please(const std::string& /*task*/) override {}
  double how_much(const std::string& task, double /*max*/,
                  const std::function<void()>& keep_waiting) override {
    if (task.find("metres") != std::string::npos) {
      length_();
      return 0.1;
    }
    meanwhile_();
    keep_waiting();
    return 1.0;
  }
  std::function<void()> length_;

 private:
  std::function<void()> meanwhile_;
};
}  // namespace

TEST_CASE("a string under calibration pulls under watch, and for a minute at most",
          "[device][calibration][safety]") {
  Workbench bench;
  std::string reason;
  bool was_watched = false;
  int output_meanwhile = 0;
  SlowOperator person{[&] {
    was_watched = bench.watchdog.is_on();
    output_meanwhile = bench.dac_counts.at(0);
    if (reason.find("minute") != std::string::npos) {
      bench.clock.wait_until(bench.clock.now() + 61'000'000'000);
    } else {
      bench.watchdog.take_output_over();
    }
  }};
  person.length_ = [&] { bench.count.at(0) += 6000; };
  const auto [why, said] = GENERATE(table<std::string, std::string>(
      {{"a minute has passed", "under tension for 60 s"}, {"stood still", "took the force off"}}));
  reason = why;
  CHECK_THROWS_WITH(
      device::calibrate_spidar(*bench.board, bench.pipe, bench.watchdog, bench.clock, person),
      Contains(said));
  CHECK(was_watched);
  CHECK(output_meanwhile > 0);
  CHECK_FALSE(bench.watchdog.is_on());
  CHECK(std::ranges::all_of(bench.dac_counts, [](int dac_counts) { return dac_counts == 0; }));
}

TEST_CASE("without a guardian no string pulls, and one that cannot be let go is told",
          "[device][calibration][safety]") {
  Workbench bench;
  std::string warning;
  class Warned final : public device::CalibrationOperator {
   public:
    Warned(Workbench& bench, std::string& warning) : bench_{bench}, warning_{warning} {}
    void please(const std::string& /*task*/) override {}
    double how_much(const std::string& task, double /*max*/,
                    const std::function<void()>& /*keep_waiting*/) override {
      if (task.find("metres") != std::string::npos) {
        bench_.count.at(0) += 6000;
      } else {
        bench_.bus.persist_in(testing::FakeBus::Trouble::missing);
      }
      return 0.1;
    }
    void warn(const std::string& what) noexcept override { warning_ = what; }

   private:
    Workbench& bench_;
    std::string& warning_;
  } person{bench, warning};
  SECTION("no guardian") {
    bench.guardian = {};
    CHECK_THROWS_WITH(
        device::calibrate_spidar(*bench.board, bench.pipe, bench.watchdog, bench.clock, person),
        Contains("watchdog process has ended"));
    CHECK(bench.max_dac_counts == 0);
  }
  SECTION("no reply to zero force") {
    CHECK_THROWS_AS(
        device::calibrate_spidar(*bench.board, bench.pipe, bench.watchdog, bench.clock, person),
        device::DeviceError);
    CHECK_THAT(warning, Contains("FORCE MAY STILL BE ON"));
    CHECK(bench.watchdog.must_repeat());
  }
}

// A board of the kind that echoes nothing: what it replied to the pull looks like any other reply.
TEST_CASE("a string that hangs after a late reply is not taken for let go",
          "[device][calibration][safety]") {
  constexpr std::uint8_t latch = 0x51;
  constexpr std::uint8_t set_outputs = 0x52;
  int count = 0;
  bool is_pulling = false;
  bool hangs = false;
  testing::FakeBus bus{device::cyverse_vendor, device::simple_product,
                       [&](std::span<const std::uint8_t> request) {
                         testing::Bytes reply;
                         if (request[0] == latch && !hangs) {
                           reply.assign(device::SimpleBoard::packet_bytes, 0);
                           reply[0] = static_cast<std::uint8_t>(count & 0xFF);
                           reply[1] = static_cast<std::uint8_t>(count >> 8);
                           hangs = is_pulling;
                         }
                         is_pulling = is_pulling || (request[0] == set_outputs && request[1] != 0);
                         return reply;
                       }};
  const device::UsbNode node = testing::node_of(bus);
  constexpr std::chrono::milliseconds max_reply{100};
  device::LibusbPipe pipe{node, {}, max_reply, testing::FakeBus::now};
  const auto board = device::board_of(device::simple_product);
  device::WatchdogChannel watchdog;
  device::VirtualClock clock;
  const std::jthread guardian{[&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      watchdog.complete_round();
      usleep(1000);
    }
  }};
  SlowOperator person{[] {}};
  person.length_ = [&] {
    constexpr int requests_until_pull = 3;
    count += 6000;
    bus.plan(testing::FakeBus::Trouble::late, requests_until_pull, 3 * max_reply / 2);
  };
  CHECK_THROWS_AS(device::calibrate_spidar(*board, pipe, watchdog, clock, person),
                  device::DeviceError);
  CHECK(hangs);
  CHECK(watchdog.must_repeat());
}
