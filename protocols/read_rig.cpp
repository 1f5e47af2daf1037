#include "protocols/read_rig.hpp"

#include <filesystem>

#include "protocols/read_sections.hpp"
#include "protocols/text_file.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;

void read_loop(MapReader& top, LoopRig& loop) {
  top.map("loop", Presence::optional, [&](MapReader& reader) {
    loop.fifo_priority = reader.integer("fifo_priority", 0, 99, loop.fifo_priority);
    loop.lock_memory = reader.yes_or_no("lock_memory", loop.lock_memory);
    if (reader.has("cpu")) {
      loop.cpu = reader.integer("cpu", 0, 1023);
    }
    loop.most_late_ticks_in_a_row =
        reader.integer("most_late_ticks_in_a_row", 0, 1'000'000, loop.most_late_ticks_in_a_row);
  });
}

StringRig read_string(MapReader& reader) {
  StringRig string;
  string.metres_per_count = reader.number("metres_per_count", {-1e-3, 1e-3});
  string.volts_per_newton = reader.number("volts_per_newton", Range::positive(100.0));
  string.digits_per_volt = reader.number("digits_per_volt", Range::positive(1e5));
  if (string.metres_per_count == 0.0) {
    reader.reject("metres_per_count", "is zero (measure it: pull 0.1 m of string)");
  }
  return string;
}

// The file of one device, apart from the rig: other studies on the same device share it.
void parse_calibration(const std::string& text, const std::string& file, SpidarRig& spidar,
                       Problems& problems) {
  MapReader top = MapReader::whole_file(text, file, problems);
  top.word("format", "format", {"tapstudy-calibration/1"});
  top.word("device", "device", {"spidar-g6"});
  top.word("type", "type of this rig", {spidar.type});
  spidar.min_tension_n = top.number("min_tension_n", Range::positive(5.0));
  spidar.max_tension_n = top.number("max_tension_n", Range::positive(20.0));
  if (spidar.min_tension_n >= spidar.max_tension_n) {
    top.reject("max_tension_n", "is not above min_tension_n");
  }
  std::size_t count = 0;
  top.list("strings", Presence::required, [&](MapReader& reader) {
    const StringRig string = read_string(reader);
    if (count < spidar.strings.size()) {
      spidar.strings.at(count) = string;
    }
    ++count;
  });
  if (count != spidar.strings.size()) {
    top.reject("strings", "must be eight, one for each string, in the order of the motors");
  }
  top.finish();
}

void read_calibration(const std::string& file, SpidarRig& spidar, std::string& rig_text) {
  const std::string text = contents_of(file);
  rig_text += "\n---\n" + text;
  Problems problems{file};
  parse_calibration(text, file, spidar, problems);
  problems.throw_if_any();
}

SpidarRig read_spidar(MapReader& reader, const std::string& directory, std::string& rig_text) {
  SpidarRig spidar;
  spidar.type = reader.word("type", "type", {"X3R", "X3L"});
  if (reader.has("rotary_switch")) {
    spidar.rotary_switch = reader.integer("rotary_switch", 0, 15);
  }
  spidar.max_turn_rad = reader.number("max_turn_rad", Range::positive(0.5), spidar.max_turn_rad);
  spidar.longest_reply_s = reader.number("longest_reply_s", {0.001, 0.1}, spidar.longest_reply_s);
  const std::string calibration = reader.text("calibration");
  if (!spidar.type.empty() && !calibration.empty()) {
    read_calibration((std::filesystem::path{directory} / calibration).string(), spidar, rig_text);
  }
  return spidar;
}

ReplayRig read_replay(MapReader& reader, const std::string& directory) {
  return {(std::filesystem::path{directory} / reader.text("directory")).string(),
          reader.integer("trial_id", 1, 2'000'000'000)};
}

void read_device(MapReader& top, const std::string& directory, Rig& rig) {
  if (rig.device == "spidar-g6") {
    top.map("spidar", Presence::required,
            [&](MapReader& reader) { rig.spidar = read_spidar(reader, directory, rig.text); });
  } else if (rig.device == "remote") {
    top.map("remote", Presence::required, [&](MapReader& reader) {
      rig.remote_port = static_cast<std::uint16_t>(reader.integer("port", 1024, 65535));
    });
  } else if (rig.device == "replay") {
    top.map("replay", Presence::required,
            [&](MapReader& reader) { rig.replay = read_replay(reader, directory); });
  }
}

// A hand that is simulated or was recorded cannot be hurt: others must have limits to their motion.
void read_limits_of_motion(MapReader& top, Rig& rig) {
  rig.max_hand_speed_m_s = top.number("max_hand_speed_m_s", Range::positive(10.0));
  rig.workspace_radius_m = top.number("workspace_radius_m", Range::positive(1.0));
  rig.force_rise_s = top.number("force_rise_s", {0.1, 10.0}, 0.5);
  rig.force_fall_s = top.number("force_fall_s", {0.01, 1.0}, 0.1);
}

Rig parse(const std::string& text, const std::string& file, Problems& problems) {
  MapReader top = MapReader::whole_file(text, file, problems);
  Rig rig;
  rig.text = text;
  top.word("format", "format", {"tapstudy-rig/1"});
  rig.device = top.word("device", "device", {"simulated_hand", "spidar-g6", "remote", "replay"});
  rig.limits.max_force_n = top.number("max_force_n", Range::positive(100.0));
  rig.limits.max_rate_n_per_s = top.number("max_force_rate_n_per_s", Range::positive(1e6));
  read_device(top, std::filesystem::path{file}.parent_path().string(), rig);
  if (rig.has_hardware()) {
    read_limits_of_motion(top, rig);
  }
  read_loop(top, rig.loop);
  read_placement(top, Presence::optional,
                 [&](const core::Placement& placement) { rig.placement = placement; });
  top.finish();
  return rig;
}
}  // namespace

Rig parse_rig(const std::string& text, const std::string& file) {
  Problems problems{file};
  Rig rig = parse(text, file, problems);
  problems.throw_if_any();
  return rig;
}

std::set<std::string> rig_keys_asked_for(const std::string& text, const std::string& file) {
  Problems problems{file};
  parse(text, file, problems);
  return problems.asked();
}

std::set<std::string> calibration_keys_asked_for(const std::string& text, const std::string& file) {
  Problems problems{file};
  SpidarRig spidar;
  spidar.type = "X3R";
  parse_calibration(text, file, spidar, problems);
  return problems.asked();
}

Rig read_rig(const std::string& file) {
  return parse_rig(contents_of(file), file);
}

Rig simulated_rig() {
  return parse_rig(
      "format: tapstudy-rig/1\n"
      "device: simulated_hand\n"
      "max_force_n: 10\n"
      "max_force_rate_n_per_s: 10000\n",
      "simulated rig");
}
}  // namespace tapstudy::protocols
