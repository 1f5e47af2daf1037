#include "device/spidar/spidar_g6.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>
#include <vector>

#include "device/spidar/find_spidars.hpp"
#include "device/spidar/tensions.hpp"
#include "protocols/reader/read_rig.hpp"
#include "protocols/yaml/text_file.hpp"
#include "protocols/yaml/yaml_reader.hpp"
#include "runner/session/devices/device_kind.hpp"
#include "runner/terminal/process_exit.hpp"
namespace tapstudy::runner {
namespace {
using protocols::MapReader;
using protocols::Range;
constexpr int tightening_steps = 500;
constexpr std::chrono::milliseconds tightening_step{1};
constexpr int max_steps_without_voltage = 3000;

struct SpidarSection final : protocols::DeviceSection {
  std::string type;
  std::optional<int> rotary_switch;  // selects the board if there are several
  double max_turn_rad{0.3};          // of the grip, from how it was homed
  double max_reply_s{0.003};         // reply timeout of the board
  std::string relay;                 // serial port of a dead-man relay; empty: there is none
  bool is_amplifier_sensed{true};    // by the voltages that the board measures
  core::SpidarCalibration calibration;
  double max_reply_time_s() const override { return max_reply_s; }
};

const SpidarSection& section_of(const protocols::Rig& rig) {
  return dynamic_cast<const SpidarSection&>(*rig.section);
}

device::SpidarSettings settings_of(const SpidarSection& section, double dt_s,
                                   device::Guardian& guardian) {
  device::SpidarSettings settings;
  settings.geometry = device::spidar_geometry(section.type);
  settings.calibration = section.calibration;
  settings.limits.max_turn_rad = section.max_turn_rad;
  settings.dt_s = dt_s;
  settings.is_amplifier_sensed = section.is_amplifier_sensed;
  settings.watchdog = &guardian.channel();
  return settings;
}

// The guardian leaves the loop time to find its own stalls first, and is never the slower to wake.
double guardian_stall_s(double max_stall_s) {
  constexpr double min_s = 0.02;
  constexpr double where_any_is_allowed_s = 0.1;
  return max_stall_s > 0.0 ? std::max(min_s, 2.0 * max_stall_s) : where_any_is_allowed_s;
}

device::BoardSettings board_settings(const protocols::Rig& rig) {
  constexpr int max_priority = 99;
  const int priority = rig.realtime.fifo_priority;
  return {std::chrono::microseconds{std::llround(1e6 * section_of(rig).max_reply_s)},
          guardian_stall_s(rig.max_stall_s),
          priority > 0 ? std::min(priority + 1, max_priority) : 0, section_of(rig).relay};
}

// The chain from USB node to device; members in order of construction.
class SpidarDevice final : public SessionDevice {
 public:
  SpidarDevice(const device::UsbListing& listing, const DeviceRequest& request)
      : ask_operator_{request.ask_operator},
        open_{listing, board_settings(request.rig)},
        spidar_{
            open_.pipe, *open_.board,
            settings_of(section_of(request.rig), request.protocol.rendering.dt_s, open_.guardian)},
        is_amplifier_sensed_{section_of(request.rig).is_amplifier_sensed},
        round_trip_{device::round_trips(open_)} {}
  device::Device& device() override { return spidar_; }
  std::optional<device::LatenessCount> round_trip() const override { return round_trip_; }
  void get_ready() override {
    if (!spidar_.is_homed()) {
      tighten();
      home();
    }
  }

 private:
  void check(core::TickFault fault) {
    if (fault != core::TickFault::none) {
      const bool is_off = spidar_.emergency_stop() == device::StopOutcome::confirmed;
      throw device::DeviceError{fmt::format("SPIDAR-G6: {}{}{}", to_text(fault), is_off ? "" : "; ",
                                            is_off ? "" : device::force_may_be_on)};
    }
  }
  void tighten() {
    for (int step = 1; step <= tightening_steps; ++step) {
      check(spidar_.tighten(static_cast<double>(step) / tightening_steps));
      std::this_thread::sleep_for(tightening_step);
    }
    // a relay may close late: its microcontroller starts when its port is opened
    for (int step = 0; step < max_steps_without_voltage && is_without_voltage(); ++step) {
      check(spidar_.tighten(1.0));
      std::this_thread::sleep_for(tightening_step);
    }
    if (is_without_voltage()) {
      throw device::DeviceError{
          "SPIDAR-G6: the motors get no voltage (is the amplifier on? if this board does not "
          "measure it, set spidar.amplifier_sensed: false)"};
    }
  }
  bool is_without_voltage() const { return is_amplifier_sensed_ && !spidar_.has_motor_voltage(); }
  void home() {
    if (!ask_operator_("Hold the grip in the middle of the frame, not turned.")) {
      throw Stopped{"stopped before the grip was in the middle"};
    }
    check(spidar_.home());
  }

  std::function<bool(const std::string& task)> ask_operator_;
  device::OpenBoard open_;
  device::SpidarG6 spidar_;
  bool is_amplifier_sensed_;
  device::LatenessCount round_trip_;
};

class SpidarKind final : public DeviceKind {
 public:
  std::string_view name() const override { return "spidar-g6"; }
  bool has_hardware() const override { return true; }
  std::shared_ptr<const protocols::DeviceSection> read_section(
      MapReader& top, const protocols::RigText& rig) const override {
    auto section = std::make_shared<SpidarSection>();
    top.map({"spidar", "a SPIDAR-G6 on its USB board"}, MapReader::Presence::required,
            [&](MapReader& reader) { read(reader, rig, *section); });
    return section;
  }
  void check(const protocols::Rig& rig) const override {
    device::check_calibration(section_of(rig).calibration);
  }
  bool reaches(const protocols::Rig& rig, const core::Vec3& at_m) const override {
    const device::SpidarGeometry geometry = device::spidar_geometry(section_of(rig).type);
    return device::closure_margin(device::strings_at(
               geometry, {device::with_z_turned(at_m), Eigen::Matrix3d::Identity()})) > 0.0;
  }

  std::unique_ptr<SessionDevice> open(const DeviceRequest& request) const override {
    const SpidarSection& section = section_of(request.rig);
    const std::vector<device::UsbListing> all = device::find_spidars();
    if (all.size() > 1 && !section.rotary_switch) {
      throw device::DeviceError{fmt::format(
          "{} SPIDAR-G6 are plugged in: say in the rig which (spidar.rotary_switch)", all.size())};
    }
    if (!section.rotary_switch) {
      return std::make_unique<SpidarDevice>(all.front(), request);
    }
    for (const device::UsbListing& listing : all) {
      if (is_set_to(*section.rotary_switch, listing, all.size())) {
        return std::make_unique<SpidarDevice>(listing, request);
      }
    }
    throw device::DeviceError{
        fmt::format("no SPIDAR-G6 with its rotary switch on {} is plugged in, or another "
                    "program uses it",
                    *section.rotary_switch)};
  }
  // an exchange sends the tensions of the tick before
  double force_delay_s(const protocols::Rig& /*rig*/, double period_s) const override {
    return period_s;
  }
  bool is_there() const override {
    return std::ranges::any_of(device::usb_devices(), [](const device::UsbListing& listing) {
      return device::is_spidar(listing) && listing.may_open;
    });
  }
  std::vector<std::string> listing() const override {
    std::vector<std::string> lines;
    for (const device::UsbListing& listing : device::usb_devices()) {
      if (device::is_spidar(listing)) {
        lines.push_back(fmt::format(
            "{:04x}:{:04x}  {}  SPIDAR-G6, {} board{}", listing.vendor, listing.product,
            listing.node, device::board_of(listing.product)->name(),
            listing.may_open ? "" : "  (no permission: install device/udev/70-tapstudy.rules)"));
      }
    }
    return lines;
  }
  // needs neither a rig nor a calibration
  std::function<void()> zero_force_exchange(const protocols::Rig& /*rig*/) const override {
    const std::vector<device::UsbListing> all = device::find_spidars();
    const auto openable = std::ranges::find_if(all, &device::UsbListing::may_open);
    const auto open =
        std::make_shared<device::OpenBoard>(openable == all.end() ? all.front() : *openable);
    open->pipe.clear_halt();
    open->pipe.drain();
    return [open] { device::exchange_zero_force(*open); };
  }

 private:
  // Of several boards, one that another session has claimed is passed over.
  static bool is_set_to(int rotary_switch, const device::UsbListing& listing, std::size_t boards) {
    try {
      return device::rotary_switch_of(listing) == rotary_switch;
    } catch (const device::ClaimedByAnother& refusal) {
      if (boards == 1) {
        throw;
      }
      return false;
    }
  }
  static void read(MapReader& reader, const protocols::RigText& rig, SpidarSection& section) {
    section.type = reader.word({"type", "type of the frame"}, "type", device::spidar_types());
    if (reader.has("rotary_switch")) {
      section.rotary_switch = reader.integer(
          {"rotary_switch", "selects the board if several are connected; unset: the only one"}, 0,
          15);
    }
    section.max_turn_rad = reader.number({"max_turn_rad", "grip rotation beyond it is a fault"},
                                         Range::positive(0.5), section.max_turn_rad);
    section.max_reply_s = read_max_reply_s(reader, section.max_reply_s);
    if (reader.has("relay")) {
      section.relay = reader.text({"relay",
                                   "serial port of a dead-man relay in the amplifier's supply, "
                                   "which opens 50 ms after the last byte; unset: there is none"});
    }
    section.is_amplifier_sensed =
        reader.yes_or_no({"amplifier_sensed",
                          "end the trial if the board measures no voltage at the motors; false: "
                          "this board's measurement is not to be relied on"},
                         section.is_amplifier_sensed);
    const std::string calibration = reader.text({"calibration",
                                                 "file measured on this individual device by "
                                                 "`tapstudy calibrate`; path relative to the rig"});
    if (section.type.empty() || calibration.empty()) {
      return;
    }
    const std::string file = (std::filesystem::path{rig.directory} / calibration).string();
    const std::string text = protocols::contents_of(file);
    *rig.text += "\n---\n" + text;
    section.calibration = protocols::parse_calibration(text, file, section.type);
  }
};
}  // namespace

const DeviceKind& spidar_g6() {
  static const SpidarKind kind;
  return kind;
}
}  // namespace tapstudy::runner
