#include "device/spidar/spidar_g6.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>
#include <vector>

#include "device/spidar/find_spidars.hpp"
#include "protocols/spidar_calibration.hpp"
#include "protocols/yaml/text_file.hpp"
#include "protocols/yaml/yaml_reader.hpp"
#include "runner/devices/shipped_devices.hpp"
#include "runner/terminal/exit_code.hpp"
#include "runner/terminal/operator_prompt.hpp"
namespace tapstudy::runner {
namespace {
using protocols::MapReader;
using protocols::Range;
constexpr int tightening_steps = 500;
constexpr std::chrono::milliseconds tightening_step{1};

struct SpidarSection final : protocols::DeviceSection {
  std::string type;
  std::optional<int> rotary_switch;  // selects the board if there are several
  double max_turn_rad{0.3};          // of the grip, from how it was homed
  double max_reply_s{0.003};         // reply timeout of the board
  core::SpidarCalibration calibration;
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
  settings.watchdog = &guardian.channel();
  return settings;
}

// The chain from USB node to device; members in order of construction.
class SpidarDevice final : public SessionDevice {
 public:
  SpidarDevice(const device::UsbListing& listing, const SpidarSection& section, double dt_s,
               LineInput& operator_input)
      : input_{operator_input},
        open_{listing, std::chrono::milliseconds{std::llround(1e3 * section.max_reply_s)}},
        spidar_{open_.pipe, *open_.board, settings_of(section, dt_s, open_.guardian)},
        round_trip_{device::round_trips(open_)} {}
  device::Device& device() override { return spidar_; }
  int rotary_switch() const { return spidar_.rotary_switch(); }
  std::optional<device::LatenessCount> round_trip() const override { return round_trip_; }
  void get_ready() override {
    if (!spidar_.is_homed()) {
      tighten();
      home();
    }
  }

 private:
  static void check(core::TickFault fault) {
    if (fault != core::TickFault::none) {
      throw device::DeviceError{fmt::format("SPIDAR-G6: {}", to_text(fault))};
    }
  }
  void tighten() {
    for (int step = 1; step <= tightening_steps; ++step) {
      check(spidar_.tighten(static_cast<double>(step) / tightening_steps));
      std::this_thread::sleep_for(tightening_step);
    }
  }
  void home() {
    if (!asked_and_done(input_, "\nHold the grip in the middle of the frame, not turned, and")) {
      throw Stopped{"stopped before the grip was in the middle"};
    }
    check(spidar_.home());
  }

  LineInput& input_;
  device::OpenBoard open_;
  device::SpidarG6 spidar_;
  device::LatenessCount round_trip_;
};

class SpidarKind final : public DeviceKind {
 public:
  std::string_view name() const override { return "spidar-g6"; }
  bool has_hardware() const override { return true; }
  std::shared_ptr<const protocols::DeviceSection> read_section(
      MapReader& top, const protocols::RigText& rig) const override {
    auto section = std::make_shared<SpidarSection>();
    top.map("spidar", MapReader::Presence::required,
            [&](MapReader& reader) { read(reader, rig, *section); });
    return section;
  }
  void check(const protocols::Rig& rig) const override {
    device::check_calibration(section_of(rig).calibration);
  }

  std::unique_ptr<SessionDevice> open(const DeviceRequest& request) const override {
    const SpidarSection& section = section_of(request.rig);
    const std::vector<device::UsbListing> all = device::find_spidars();
    if (all.size() > 1 && !section.rotary_switch) {
      throw device::DeviceError{fmt::format(
          "{} SPIDAR-G6 are plugged in: say in the rig which (spidar.rotary_switch)", all.size())};
    }
    for (const device::UsbListing& listing : all) {
      auto found = std::make_unique<SpidarDevice>(listing, section, request.protocol.rendering.dt_s,
                                                  request.operator_input);
      if (!section.rotary_switch || found->rotary_switch() == *section.rotary_switch) {
        return found;
      }
    }
    throw device::DeviceError{fmt::format("no SPIDAR-G6 with its rotary switch on {} is plugged in",
                                          *section.rotary_switch)};
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
  std::optional<device::LatenessCount> round_trip() const override {
    const std::vector<device::UsbListing> all = device::find_spidars();
    const auto openable = std::ranges::find_if(all, &device::UsbListing::may_open);
    return device::probed_round_trip(openable == all.end() ? all.front() : *openable);
  }

 private:
  static void read(MapReader& reader, const protocols::RigText& rig, SpidarSection& section) {
    section.type = reader.word("type", "type", device::spidar_types());
    if (reader.has("rotary_switch")) {
      section.rotary_switch = reader.integer("rotary_switch", 0, 15);
    }
    section.max_turn_rad =
        reader.number("max_turn_rad", Range::positive(0.5), section.max_turn_rad);
    section.max_reply_s = reader.number("max_reply_s", {0.001, 0.1}, section.max_reply_s);
    const std::string calibration = reader.text("calibration");
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
