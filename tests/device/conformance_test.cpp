// What every back-end does in every trouble, in one table. A back-end is a row: a class that begins
// each trouble, or says why it does not apply. Troubles last until the test ends; time is virtual.
#include <fmt/format.h>
#include <linux/usbdevice_fs.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "device/hand/prescribed_hand.hpp"
#include "device/hand/simulated_hand.hpp"
#include "device/remote/remote_hand.hpp"
#include "device/usb/guardian.hpp"
#include "support/catch.hpp"
#include "support/other_tapstudy.hpp"
#include "support/remote_program.hpp"
#include "support/served_program.hpp"
#include "support/staged_loop.hpp"
#include "support/usb/spidar_on_bus.hpp"
using namespace tapstudy;
using core::TickFault;
using device::Nanoseconds;
using testing::FakeBus;
using testing::RemoteProgram;
using testing::RemoteTrouble;
using testing::StagedLoop;

namespace {
constexpr std::chrono::milliseconds max_reply{3};

enum class Trouble {
  hung,
  frozen,
  slow_reply,  // after so many periods
  late_force,  // reported so much later
  counter_jumps,
  not_a_number,
  killed,
  stopped_and_continued,
  unplugged,
  never_lets_go,
  second_device,
  of_one_back_end,  // by its name
  stall,
  suspended,
  late_ticks
};
struct Cell {
  std::string name;
  Trouble trouble{};
  double amount{0.0};          // periods or seconds
  bool is_under_force{false};  // found only while force is on
};
// What the loop finds, if anything, and whether the device confirms the zero force that follows.
struct Expected {
  std::vector<TickFault> found;  // empty: no fault
  bool is_stop_confirmed{true};
};
const Expected no_fault{};
const std::vector<TickFault> no_reply{TickFault::no_reply, TickFault::periods_missed};
// A cell that a back-end drives by itself, to this end.
struct Driven {
  std::string outcome;
};
using Begun = std::variant<Expected, Driven, std::string>;  // or why it does not apply

class BackEnd {
 public:
  virtual ~BackEnd() = default;
  virtual device::Device& device() = 0;
  virtual testing::SteadyClock& clock() = 0;
  virtual void arm(StagedLoop& loop) { loop.tick(5); }
  // Until force is on.
  virtual void press(StagedLoop& loop) = 0;
  virtual Begun begin(const Cell& cell) = 0;
  virtual void forget_packets() {}
  // Since they were forgotten.
  virtual int packets_with_force() { return 0; }
  virtual bool exerts_force() { return false; }
  virtual bool forces_another() { return false; }
};

// SPIDAR-G6: the real libusb on a simulated board.
class SpidarRow final : public BackEnd {
 public:
  explicit SpidarRow(std::uint16_t board) : on_bus_{board, max_reply} {}
  device::Device& device() override { return on_bus_.spidar; }
  testing::SteadyClock& clock() override { return clock_; }
  void arm(StagedLoop& loop) override {
    home();
    on_bus_.hardware.hold_at({0.0, 0.01, 0.0});
    loop.tick(5);
  }
  void press(StagedLoop& loop) override {
    arm(loop);
    loop.tick(400);
    on_bus_.hardware.hold_at({0.0, -0.012, 0.0});
    loop.tick(400);
    note_request_with_force();
  }
  Begun begin(const Cell& cell) override {
    switch (cell.trouble) {
      case Trouble::hung:
        on_bus_.bus.persist_in(FakeBus::Trouble::missing);
        return Expected{{TickFault::no_reply}, false};
      case Trouble::frozen:
        on_bus_.hardware.stop_counting();
        return Expected{{TickFault::position_frozen}, false};
      case Trouble::slow_reply:
        on_bus_.bus.reply_after(std::chrono::nanoseconds{std::llround(1e6 * cell.amount)});
        return cell.amount > 1.0 ? Expected{{TickFault::periods_missed}} : no_fault;
      case Trouble::late_force:
        return "it measures no force";
      case Trouble::counter_jumps:
        on_bus_.hardware.jump(3, 400);
        return Expected{{TickFault::counter_jumped}};
      case Trouble::not_a_number:
        return "its counters are integers";
      case Trouble::killed:
        return guarded({SIGKILL});
      case Trouble::stopped_and_continued:
        return guarded({SIGSTOP, SIGSTOP});
      case Trouble::unplugged:
        on_bus_.bus.unplug();
        return Expected{{TickFault::device_gone}, false};
      case Trouble::never_lets_go:
        on_bus_.bus.persist_in(FakeBus::Trouble::out_lost);
        return Expected{{TickFault::no_reply}, false};
      case Trouble::second_device:
        return beside_a_second_one();
      default:
        return begin_on_usb(cell.name);
    }
  }
  void forget_packets() override { on_bus_.bus.forget_requests(); }
  int packets_with_force() override {
    return static_cast<int>(
        std::ranges::count_if(on_bus_.bus.requests(), [](const testing::Bytes& request) {
          return !testing::outputs_in(request).empty() && !testing::has_no_force(request);
        }));
  }
  bool exerts_force() override { return on_bus_.hardware.tension_n().maxCoeff() > 0.0; }
  bool forces_another() override {
    return second_ && second_->hardware.tension_n().maxCoeff() > 0.0;
  }

  testing::SpidarOnBus& on_bus() { return on_bus_; }
  void tighten() {
    on_bus_.hardware.hold_at({0.0, 0.005, 0.0});
    for (int step = 1; step <= 500; ++step) {
      REQUIRE(on_bus_.spidar.tighten(step / 500.0) == TickFault::none);
    }
  }

 private:
  // The bus's.
  class Clock final : public testing::SteadyClock {
   public:
    Nanoseconds now() noexcept override { return FakeBus::now(); }
    void pass_to(Nanoseconds moment) noexcept override { FakeBus::pass_to(moment); }
  };
  // Another program has the board, and gives it the forces of this row's last request before each
  // of these signals. It has a guardian of its own.
  Driven guarded(const std::vector<int>& signals) {
    const pid_t program = fork();
    if (program == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      hold_board(signals);
    }
    for (const int signal : signals) {
      int status = 0;
      REQUIRE(waitpid(program, &status, WUNTRACED) == program);
      REQUIRE((signal == SIGSTOP ? WIFSTOPPED(status) : WIFSIGNALED(status)));
      while (packets_with_force() == 0) {  // its guardian may have taken the bus's answer to it
        usleep(200);
      }
      while (!is_last_without_force()) {
        usleep(200);
      }
      forget_packets();
      signal == SIGSTOP ? kill(program, SIGCONT) : 0;
    }
    if (signals.back() == SIGSTOP) {
      kill(program, SIGKILL);
      waitpid(program, nullptr, 0);
    }
    return {fmt::format("force off by the guardian, {}", signals.size() == 1 ? "once" : "twice")};
  }
  [[noreturn]] void hold_board(const std::vector<int>& signals) {
    constexpr double max_stall_s = 0.02;
    const device::UsbNode node{on_bus_.bus.open()};
    device::Guardian guardian{node,
                              {testing::out_endpoint, testing::in_endpoint,
                               on_bus_.board->zero_force_packet(), max_stall_s, 0}};
    guardian.channel().begin();
    for (const int signal : signals) {
      usbdevfs_bulktransfer transfer{testing::out_endpoint,
                                     static_cast<unsigned>(request_with_force_.size()), 0,
                                     request_with_force_.data()};
      on_bus_.bus.ioctl(USBDEVFS_BULK, &transfer);
      raise(signal);
    }
    while (true) {
      pause();
    }
  }
  // Of the packets that set outputs.
  bool is_last_without_force() const {
    const std::vector<testing::Bytes> all = on_bus_.bus.requests();
    const auto last = std::find_if(all.rbegin(), all.rend(), [](const testing::Bytes& request) {
      return !testing::outputs_in(request).empty();
    });
    return last != all.rend() && testing::has_no_force(*last);
  }
  void note_request_with_force() {
    const std::vector<testing::Bytes> all = on_bus_.bus.requests();
    const auto last = std::find_if(all.rbegin(), all.rend(), [](const testing::Bytes& request) {
      return !testing::outputs_in(request).empty() && !testing::has_no_force(request);
    });
    REQUIRE(last != all.rend());
    request_with_force_ = *last;
  }
  // This one's session goes on, and none of its forces reaches the other.
  Begun beside_a_second_one() {
    second_ = std::make_unique<testing::SpidarOnBus>(on_bus_.product, max_reply);
    REQUIRE(second_->spidar.tighten(0.0) == TickFault::none);
    return no_fault;
  }
  bool is_sh4() const { return on_bus_.product == device::sh4_product; }
  void home() {
    tighten();
    on_bus_.hardware.hold_at({0.0, 0.0, 0.0});
    for (int step = 0; step < 500; ++step) {
      REQUIRE(on_bus_.spidar.tighten(1.0) == TickFault::none);
    }
    REQUIRE(on_bus_.spidar.home() == TickFault::none);
  }
  Begun begin_on_usb(const std::string& name) {
    using enum testing::FakeUsbfs::Trouble;
    const auto once = [&](FakeBus::Trouble trouble, TickFault fault, bool is_confirmed = true) {
      on_bus_.bus.plan(trouble);
      return Expected{{fault}, is_confirmed};
    };
    if (name == "half a reply, always") {
      on_bus_.bus.persist_in(short_reply);
      return Expected{{TickFault::bad_reply}, false};
    }
    if (name == "every second reply") {
      on_bus_.bus.persist_in(every_other);
      return Expected{no_reply};
    }
    if (name == "takes no request") {
      on_bus_.bus.persist_in(out_nak);
      return Expected{{TickFault::no_reply}, false};
    }
    if (name == "endpoint halted" || name == "endpoint halted for good") {
      constexpr int for_good = 1'000'000;
      const bool is_for_good = name.ends_with("good");
      on_bus_.bus.halt_out(is_for_good ? for_good : 1);
      return Expected{{TickFault::bad_reply}, !is_for_good};
    }
    if (name == "half a reply, once") {
      return once(short_reply, TickFault::bad_reply);
    }
    if (name == "stall") {
      return once(stalled, TickFault::bad_reply);
    }
    if (name == "protocol error") {
      return once(protocol, TickFault::bad_reply);
    }
    if (name == "overflow") {
      return once(overflow, TickFault::bad_reply);
    }
    if (name == "kernel out of memory") {
      return once(not_accepted, TickFault::bad_reply);
    }
    if (name == "unplugged in a tick") {
      return once(unplugged, TickFault::device_gone, false);
    }
    return begin_in_hardware(name);
  }
  Begun begin_in_hardware(const std::string& name) {
    if (name == "wrong echo" || name == "motors without power") {
      if (!is_sh4()) {
        return "this board neither echoes nor measures voltages";
      }
      if (name == "wrong echo") {
        on_bus_.hardware.echo_wrongly();
        return Expected{{TickFault::wrong_echo}, false};
      }
      on_bus_.hardware.switch_amplifier(false);
      return Expected{{TickFault::amplifier_off, TickFault::strings_disagree}};
    }
    if (name == "string slips") {
      on_bus_.hardware.jump(3, 100);
      return Expected{{TickFault::strings_disagree}};
    }
    if (name == "two old samples in turn" || name == "32 old samples in turn") {
      on_bus_.hardware.repeat_samples(name.starts_with("two") ? 2 : 32);
      return Expected{{TickFault::position_frozen}, false};
    }
    if (name == "keeps its force, and replies as if it obeyed") {
      return is_sh4()
                 ? "its echo is right, and a string that is pulled makes a voltage itself: for "
                   "this there is the relay"
                 : "it measures no force: for this there is the relay";
    }
    if (name == "position jumps") {
      on_bus_.hardware.hold_at({0.3, 0.3, 0.0});
      return Expected{
          {TickFault::too_fast, TickFault::outside_workspace, TickFault::counter_jumped}};
    }
    return "a USB board cannot";
  }

  testing::SpidarOnBus on_bus_;
  std::unique_ptr<testing::SpidarOnBus> second_;
  testing::Bytes request_with_force_;
  Clock clock_;
};

// Another program, over the protocol's versions.
class RemoteRow final : public BackEnd {
 public:
  explicit RemoteRow(int version) : owned_{std::make_unique<RemoteProgram>(version)} {
    program_.tremor_m = 1e-9;  // a finger that rests
  }
  device::Device& device() override { return hand_; }
  testing::SteadyClock& clock() override { return clock_; }
  void press(StagedLoop& loop) override {
    loop.tick(200);
    for (int i = 1; i <= 100; ++i) {
      program_.height_m = 0.01 - 1.1e-4 * i;  // 1 mm deep, slowly enough
      loop.tick(1);
    }
    loop.tick(1);  // in version 3 a force acts a tick later
    REQUIRE(program_.exerted_n == Approx(3.0).epsilon(0.01));
  }
  Begun begin(const Cell& cell) override {
    using enum RemoteTrouble;
    switch (cell.trouble) {
      case Trouble::hung:
        return meet(deaf, no_reply, false);
      case Trouble::frozen:
        program_.tremor_m = 0.0;
        return program_.version == 3 ? meet(dead_thread, {TickFault::position_frozen}, false)
                                     : Expected{{TickFault::position_frozen}};
      case Trouble::slow_reply:
        program_.reply_delay = std::llround(1e6 * cell.amount);
        return cell.amount > 1.0 ? Expected{{TickFault::periods_missed}} : no_fault;
      case Trouble::late_force:
        if (program_.version == 1) {
          return "version 1 tells no force";
        }
        program_.gauge_lag_s = cell.amount;
        program_.tap(0.002);
        return cell.amount > device::max_report_lag_s ? Expected{{TickFault::force_not_followed}}
                                                      : no_fault;
      case Trouble::counter_jumps:
        return program_.version == 3 ? Begun{meet(samples_jump, {TickFault::bad_reply})}
                                     : Begun{"it numbers no samples"};
      case Trouble::not_a_number:
        return meet(RemoteTrouble::not_a_number, {TickFault::non_finite_force});
      case Trouble::killed:
        return driven_by_another({SIGKILL});
      case Trouble::stopped_and_continued:
        return driven_by_another({SIGSTOP, SIGSTOP});
      case Trouble::unplugged:
        return meet(gone, {TickFault::device_gone, TickFault::no_reply}, false);
      case Trouble::never_lets_go:
        return program_.version == 1
                   ? Begun{"version 1 tells no force: refused unless the rig answers for it"}
                   : Begun{meet(RemoteTrouble::never_lets_go, {TickFault::force_not_followed},
                                false)};
      case Trouble::second_device:
        return answered_by_two();
      default:
        return begin_on_the_wire(cell.name);
    }
  }
  int packets_with_force() override { return program_.forces_since_trouble; }
  bool exerts_force() override { return program_.exerted_n != 0.0; }

 private:
  // Real processes, in real time: tapstudy, and a program that lets go in a silence. One that does
  // not, or does not tell, is found at session start.
  Driven driven_by_another(const std::vector<int>& signals) const {
    constexpr double force_n = 2.0;
    const testing::ServedProgram served{program_.version};
    testing::OtherTapstudy other{served.port(), force_n};
    for (const int signal : signals) {
      testing::wait_until([&] { return served.exerted_n() == force_n; });
      signal == SIGSTOP ? other.stop() : other.end();
      testing::wait_until([&] { return served.exerted_n() == 0.0; });
      signal == SIGSTOP ? other.go_on() : void();
    }
    const bool is_told = program_.version > 1;
    CHECK((found_at_start(20'000'000) == device::RemoteHand::Release::released) == is_told);
    CHECK(found_at_start(never) == (is_told ? device::RemoteHand::Release::held
                                            : device::RemoteHand::Release::not_reported));
    return {fmt::format("force off, {}; at session start one that would hold it is {}",
                        signals.size() == 1 ? "once" : "twice",
                        is_told ? "refused" : "refused, as all, unless the rig answers for it")};
  }
  device::RemoteHand::Release found_at_start(Nanoseconds release_after) const {
    auto program = std::make_unique<RemoteProgram>(program_.version);
    program->release_after = release_after;
    device::RemoteHand hand{40'000, {max_reply}, std::move(program)};
    return hand.release_after(std::chrono::milliseconds{150});
  }
  Driven answered_by_two() const {
    testing::ServedProgram served{program_.version};
    served.has_impostor = true;
    device::RemoteHand hand{served.port(), {testing::unhurried, testing::max_sample_age_s}};
    for (int i = 0; i < 50; ++i) {
      core::HandState state;
      CHECK(hand.write({0.0, 1.0, 0.0}) == TickFault::none);
      static_cast<void>(hand.read(state, 1e-5));  // a busy machine may have let it let go
      CHECK(state.position_m.y() == served.height_m());
    }
    return {"another program's replies are not heard"};
  }
  Expected meet(RemoteTrouble trouble, std::vector<TickFault> found, bool is_confirmed = true) {
    program_.trouble = trouble;
    return {std::move(found), is_confirmed};
  }
  Begun begin_on_the_wire(const std::string& name) {
    using enum RemoteTrouble;
    if (name == "hears, and is mute") {
      return meet(mute, no_reply, false);
    }
    if (name == "replies after 20 ms") {
      program_.reply_delay = 20'000'000;
      return meet(none, no_reply, false);
    }
    if (name == "half a reply, always") {
      return meet(short_reply, {TickFault::bad_reply}, false);
    }
    if (name == "an old reply") {
      return meet(old_number, no_reply, false);
    }
    if (name == "each reply twice") {
      return meet(twice, {});
    }
    if (name == "position jumps") {
      return meet(jump, {TickFault::too_fast, TickFault::outside_workspace});
    }
    if (name == "every second reply") {
      return meet(every_other, no_reply);
    }
    if (name == "bridge started anew") {
      program_.restart();
      return program_.version == 1 ? Begun{"it tells neither a release nor sample numbers"}
                                   : Expected{{TickFault::force_released}};
    }
    return begin_as_told(name);
  }
  Begun begin_as_told(const std::string& name) {
    using enum RemoteTrouble;
    struct Told {
      const char* name;
      RemoteTrouble trouble;
      int since_version;
      TickFault fault;
      bool is_stop_confirmed{true};
    };
    static const std::vector<Told> all{
        {"two old samples in turn", two_buffers, 1, TickFault::position_frozen},
        {"32 old samples in turn", ring, 1, TickFault::position_frozen},
        {"position dead, velocity noisy", dead_encoders, 1, TickFault::position_frozen},
        {"an old sample under new numbers", old_sample, 3, TickFault::position_frozen},
        {"motors without power", no_power, 2, TickFault::amplifier_off},
        {"exerts 80 N", overload, 2, TickFault::force_not_followed, false},
        {"exerts no force", limp, 2, TickFault::force_not_followed},
        {"force reversed", reversed, 2, TickFault::force_not_followed},
        {"force along another axis", sideways, 2, TickFault::force_not_followed},
        {"force no longer told", tells_no_more, 2, TickFault::force_not_followed, false},
        {"half of a force", half_known, 2, TickFault::bad_reply, false},
        {"another version", falls_back, 2, TickFault::bad_reply, false},
        {"releases in the trial", releases, 2, TickFault::force_released},
        {"must be homed", must_be_homed, 3, TickFault::not_homed},
        {"sample of 6 ms", too_old, 3, TickFault::position_frozen},
        {"sample numbers fall", samples_fall, 3, TickFault::bad_reply},
        {"quaternion of no unit", no_unit, 3, TickFault::bad_reply, false},
        {"text with an escape", rude_text, 3, TickFault::bad_reply, false}};
    const auto found = std::ranges::find(all, name, &Told::name);
    if (name == "keeps its force, and replies as if it obeyed") {
      return "whatever a program tells is believed, if nothing contradicts it";
    }
    if (found == all.end()) {
      return "no USB, no strings";
    }
    if (found->since_version > program_.version ||
        (found->trouble == falls_back && program_.version == 3)) {
      return fmt::format("version {} has no such field", program_.version);
    }
    return meet(found->trouble, {found->fault}, found->is_stop_confirmed);
  }

  std::unique_ptr<RemoteProgram> owned_;
  RemoteProgram& program_{*owned_};
  static constexpr Nanoseconds never = std::numeric_limits<Nanoseconds>::max();
  device::RemoteHand hand_{40'000, {max_reply}, std::move(owned_)};
  testing::ProgramClock clock_{program_};
};

// Hands that exert nothing on anybody.
class SimulatedRow final : public BackEnd {
 public:
  device::Device& device() override { return hand_; }
  testing::SteadyClock& clock() override { return clock_; }
  void press(StagedLoop& loop) override { loop.tick(800); }
  Begun begin(const Cell& cell) override {
    if (cell.trouble == Trouble::stopped_and_continued) {
      clock_.lateness = 30'000'000'000;
      return Expected{{TickFault::loop_stalled}};
    }
    return "computed in this process";
  }

 private:
  static std::vector<core::Vec3> aims() {
    std::vector<core::Vec3> all(300, core::Vec3{0.0, 0.01, 0.0});
    for (int i = 0; i <= 400; ++i) {
      all.emplace_back(0.0, 0.01 - 0.022 * i / 400.0, 0.0);
    }
    return all;
  }
  device::AimedHand hand_{core::HandBody{}, 1e-3, aims()};
  testing::SteadyClock clock_;
};

class ReplayRow final : public BackEnd {
 public:
  device::Device& device() override { return hand_; }
  testing::SteadyClock& clock() override { return clock_; }
  void press(StagedLoop& loop) override { loop.tick(400); }
  Begun begin(const Cell& cell) override {
    if (cell.trouble == Trouble::not_a_number) {
      return Expected{{TickFault::non_finite_force}};
    }
    if (cell.trouble == Trouble::stopped_and_continued) {
      clock_.lateness = 30'000'000'000;
      return Expected{{TickFault::loop_stalled}};
    }
    return "read before the trial";
  }

 private:
  // It ends in a record that is broken.
  static std::vector<core::HandState> states() {
    std::vector<core::HandState> all(300, core::HandState{core::Vec3{0.0, 0.01, 0.0}});
    for (int i = 1; i <= 120; ++i) {
      all.push_back({core::Vec3{0.0, 0.01 - 1e-4 * i, 0.0}, core::Vec3{0.0, -0.1, 0.0}});
    }
    all.push_back({core::Vec3::Constant(std::numeric_limits<double>::quiet_NaN())});
    return all;
  }
  device::ReplayHand hand_{states(), "a test"};
  testing::SteadyClock clock_;
};

struct Row {
  const char* name;
  std::function<std::unique_ptr<BackEnd>()> make;
};
const std::vector<Row> rows{
    {"SPIDAR, SH4", [] { return std::make_unique<SpidarRow>(device::sh4_product); }},
    {"SPIDAR, Simple", [] { return std::make_unique<SpidarRow>(device::simple_product); }},
    {"remote/1", [] { return std::make_unique<RemoteRow>(1); }},
    {"remote/2", [] { return std::make_unique<RemoteRow>(2); }},
    {"remote/3", [] { return std::make_unique<RemoteRow>(3); }},
    {"simulated hand", [] { return std::make_unique<SimulatedRow>(); }},
    {"replay", [] { return std::make_unique<ReplayRow>(); }}};

std::vector<Cell> all_cells() {
  std::vector<Cell> cells{{"hung but acknowledging", Trouble::hung},
                          {"frozen position", Trouble::frozen, 0.0, true}};
  for (const double periods : {0.9, 1.0, 1.05, 1.1, 1.5}) {
    cells.push_back({fmt::format("reply after {} periods", periods), Trouble::slow_reply, periods});
  }
  for (const int late_ms : {0, 5, 15, 50}) {
    cells.push_back(
        {fmt::format("force told {} ms late", late_ms), Trouble::late_force, 1e-3 * late_ms, true});
  }
  for (const auto& [name, trouble] : std::vector<std::pair<const char*, Trouble>>{
           {"counter or sample number jumps", Trouble::counter_jumps},
           {"NaN", Trouble::not_a_number},
           {"killed", Trouble::killed},
           {"stopped, continued, stopped", Trouble::stopped_and_continued},
           {"unplugged", Trouble::unplugged},
           {"second device", Trouble::second_device},
           {"loop stalls for 11 ms", Trouble::stall},
           {"machine suspended", Trouble::suspended},
           {"ticks late", Trouble::late_ticks}}) {
    cells.push_back({name, trouble});
  }
  cells.push_back({"never lets go", Trouble::never_lets_go, 0.0, true});
  for (const char* const name : {"half a reply, always",
                                 "half a reply, once",
                                 "takes no request",
                                 "endpoint halted",
                                 "endpoint halted for good",
                                 "stall",
                                 "protocol error",
                                 "overflow",
                                 "kernel out of memory",
                                 "unplugged in a tick",
                                 "wrong echo",
                                 "string slips",
                                 "position jumps",
                                 "motors without power",
                                 "hears, and is mute",
                                 "replies after 20 ms",
                                 "an old reply",
                                 "each reply twice",
                                 "every second reply",
                                 "bridge started anew",
                                 "another version",
                                 "half of a force",
                                 "must be homed",
                                 "sample of 6 ms",
                                 "sample numbers fall",
                                 "quaternion of no unit",
                                 "text with an escape"}) {
    cells.push_back({name, Trouble::of_one_back_end});
  }
  for (const char* const name :
       {"two old samples in turn", "32 old samples in turn", "position dead, velocity noisy",
        "an old sample under new numbers", "keeps its force, and replies as if it obeyed",
        "force no longer told", "exerts 80 N", "exerts no force", "force reversed",
        "force along another axis", "releases in the trial"}) {
    cells.push_back({name, Trouble::of_one_back_end, 0.0, true});
  }
  return cells;
}

// The loop's own troubles are the same for all.
Begun begun(BackEnd& back_end, const Cell& cell) {
  switch (cell.trouble) {
    case Trouble::stall:
      back_end.clock().lateness = 11'000'000;
      return Expected{{TickFault::loop_stalled}};
    case Trouble::suspended:
      back_end.clock().slept = 60'000'000'000;
      return Expected{{TickFault::suspended}};
    case Trouble::late_ticks:
      back_end.clock().lateness = 700'000;
      return Expected{{TickFault::too_late}};
    default:
      return back_end.begin(cell);
  }
}

struct Outcome {
  std::string text;
  bool applies{false};
};

enum class State { armed, rendering, stopping };
constexpr int enough_ticks = 6300;  // a position may stand still for 6 s

Outcome outcome_of(const Row& row, const Cell& cell, State state) {
  const std::unique_ptr<BackEnd> back_end = row.make();
  StagedLoop stage{back_end->device(), back_end->clock()};
  if (state == State::armed) {
    back_end->arm(stage);
  } else {
    back_end->press(stage);
  }
  const device::LoopReport& report = stage.loop->report();
  REQUIRE(report.stopped_by == TickFault::none);
  const std::int64_t before = report.ticks;
  back_end->forget_packets();
  const Begun begun_as = begun(*back_end, cell);
  if (const auto* const why = std::get_if<std::string>(&begun_as)) {
    return {"does not apply: " + *why};
  }
  if (const auto* const driven = std::get_if<Driven>(&begun_as)) {
    return {driven->outcome};
  }
  const auto& expected = std::get<Expected>(begun_as);
  if (state != State::stopping) {
    stage.tick(expected.found.empty() ? 300 : enough_ticks);
  }
  stage.stop();
  const TickFault found = report.stopped_by;
  CAPTURE(core::to_text(found), static_cast<int>(found));
  const bool is_confirmed = report.stop == device::StopOutcome::confirmed;
  const std::int64_t ticks = report.ticks - before;
  if (expected.found.empty()) {
    CHECK(found == TickFault::none);
  } else {
    CHECK(std::ranges::count(expected.found, found) == 1);
    CHECK(stage.last_sample().fault == found);
    CHECK(back_end->packets_with_force() <= 2 * ticks);  // none after the tick that found it
  }
  CHECK(is_confirmed == expected.is_stop_confirmed);
  CHECK((is_confirmed || !back_end->device().is_force_off()));
  CHECK((!is_confirmed || found == TickFault::none || !back_end->exerts_force()));
  CHECK_FALSE(back_end->forces_another());
  if (found != TickFault::none) {
    const int with_force = back_end->packets_with_force();
    stage.tick(50);
    CHECK(report.ticks == before + ticks);  // latched
    CHECK(back_end->packets_with_force() == with_force);
  }
  return {fmt::format("{} ticks, {}, {}", ticks,
                      found == TickFault::none ? "no fault" : core::to_text(found),
                      is_confirmed ? "force off" : "force may be on"),
          true};
}
}  // namespace

TEST_CASE(
    "each back-end, in each trouble: an honest device is believed, any other is at zero force in "
    "the tick that finds it, stays there, and no stop is called confirmed that is not",
    "[device][safety][usb][remote]") {
  for (const Cell& cell : all_cells()) {
    fmt::print("  {}\n", cell.name);
    for (const Row& row : rows) {
      CAPTURE(cell.name, row.name);
      const Outcome rendering = outcome_of(row, cell, State::rendering);
      fmt::print("    {:<16}{}\n", row.name, rendering.text);
      if (rendering.applies && !cell.is_under_force && cell.trouble != Trouble::slow_reply) {
        outcome_of(row, cell, State::armed);
        outcome_of(row, cell, State::stopping);
      }
    }
  }
}

TEST_CASE("a fault while the strings are tightened leaves none of them pulled",
          "[device][safety][usb]") {
  const std::uint16_t board = GENERATE(device::sh4_product, device::simple_product);
  for (const Cell& cell : all_cells()) {
    if (cell.trouble == Trouble::killed || cell.trouble == Trouble::stopped_and_continued) {
      continue;  // what another program does
    }
    SpidarRow row{board};
    row.tighten();
    const Begun begun_as = row.begin(cell);
    const auto* const expected = std::get_if<Expected>(&begun_as);
    TickFault found = TickFault::none;
    for (int step = 0; step < 50 && found == TickFault::none; ++step) {
      found = row.on_bus().spidar.tighten(1.0);
    }
    if (expected == nullptr || found == TickFault::none) {
      continue;  // what needs a known position, or the loop, is not found yet
    }
    CAPTURE(board, cell.name);
    CHECK(std::ranges::count(expected->found, found) == 1);
    CHECK((row.on_bus().spidar.emergency_stop() == device::StopOutcome::confirmed) ==
          expected->is_stop_confirmed);
    CHECK((!expected->is_stop_confirmed || !row.exerts_force()));
    CHECK(!row.on_bus().spidar.is_homed());
  }
}

TEST_CASE("pressing on a plate through the whole chain gives the plate's force",
          "[device][safety][usb]") {
  SpidarRow row{GENERATE(device::sh4_product, device::simple_product)};
  StagedLoop stage{row.device(), row.clock()};
  row.press(stage);
  const core::TraceSample last = stage.last_sample();
  CHECK(last.touching);
  CHECK(last.force_n[1] == Approx(3000.0 * last.penetration_m));
  CHECK(last.achieved_n[1] == Approx(last.force_n[1]).epsilon(1e-4));
  // the muscle aims 12 mm deep and meets a spring of 3000 N/m: k d / (k + K)
  CHECK(last.penetration_m == Approx(400.0 * 0.012 / 3400.0).epsilon(0.05));
  CHECK(last.closure_margin > 0.0);
}
