#include "protocols/reader/read_rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numbers>

#include "core/text/print.hpp"
#include "protocols/reader/read_sections.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;

// A person's hand is on hardware; a simulated one may wait for any time (0).
constexpr double max_late_of_hardware_s = 0.02;
constexpr double max_stall_of_hardware_s = 0.01;
constexpr double max_missed_share_of_hardware = 0.01;

void read_loop(MapReader& top, Rig& rig) {
  rig.max_late_s = rig.has_hardware ? max_late_of_hardware_s : 0.0;
  rig.max_stall_s = rig.has_hardware ? max_stall_of_hardware_s : 0.0;
  rig.max_missed_share = rig.has_hardware ? max_missed_share_of_hardware : 1.0;
  top.map({"loop", "real-time settings requested for the haptic loop; the system may refuse them"},
          Presence::optional, [&](MapReader& reader) {
            core::RealtimeRequest& realtime = rig.realtime;
            realtime.fifo_priority = reader.integer(
                {"fifo_priority", "SCHED_FIFO priority of the haptic thread; 0: not requested"}, 0,
                99, realtime.fifo_priority);
            realtime.lock_memory = reader.yes_or_no(
                {"lock_memory", "lock the program's memory against paging"}, realtime.lock_memory);
            if (reader.has("cpu")) {
              realtime.cpu = reader.integer({"cpu", "processor to run on; unset: any"}, 0, 1023);
            }
            reader.refuse_former("max_late_ticks_in_a_row", "max_late_s, a time in seconds");
            rig.max_late_s =
                reader.number({"max_late_s",
                               "ticks of which each is late for longer end the trial; 0, not with "
                               "hardware: no limit; unset: 0.02 with hardware, else 0"},
                              {0.0, 1000.0, !rig.has_hardware, true}, rig.max_late_s);
            rig.max_stall_s =
                reader.number({"max_stall_s",
                               "a longer time between two ticks ends the trial; 0, not with "
                               "hardware: no limit; unset: 0.01 with hardware, else 0"},
                              {0.0, 0.1, !rig.has_hardware, true}, rig.max_stall_s);
            rig.max_missed_share = reader.number(
                {"max_missed_share",
                 "more of the periods of a second missed end the trial; 1: any; unset: 0.01 with "
                 "hardware, else 1"},
                {0.001, 1.0}, rig.max_missed_share);
          });
}

void check_reply_time(MapReader& top, const Rig& rig) {
  if (rig.section && rig.max_stall_s > 0.0 &&
      2.0 * rig.section->max_reply_time_s() > rig.max_stall_s) {
    top.reject("loop", fmt::format("max_stall_s: {} s is below twice the device's max_reply_s, {} "
                                   "s: a single missing reply would be a stall",
                                   rig.max_stall_s, rig.section->max_reply_time_s()));
  }
}

// Motion limits are mandatory for hardware; simulated and recorded hands cannot be hurt.
void read_limits_of_motion(MapReader& top, core::GateSettings& gate) {
  gate.max_hand_speed_m_s = top.number(
      {"max_hand_speed_m_s", "a faster hand ends the trial; hardware only"}, Range::positive(10.0));
  gate.workspace_radius_m =
      top.number({"workspace_radius_m",
                  "a hand farther from the device's origin ends the trial; hardware only"},
                 Range::positive(1.0));
  gate.force_rise_s =
      top.number({"force_rise_s", "ramp from zero to full force; hardware only"}, {0.1, 10.0}, 0.5);
  gate.force_fall_s =
      top.number({"force_fall_s", "ramp from full to zero force; hardware only"}, {0.01, 1.0}, 0.1);
}

std::vector<std::string> names_of(RigDevices devices) {
  std::vector<std::string> names;
  for (const RigDevice* const device : devices) {
    names.emplace_back(device->name());
  }
  return names;
}

void read_device(MapReader& top, const std::string& file, RigDevices devices, Rig& rig) {
  rig.device = top.word({"device", "kind of device"}, "device", names_of(devices));
  const auto device = std::ranges::find(devices, std::string_view{rig.device}, &RigDevice::name);
  if (device == devices.end()) {
    return;
  }
  rig.has_hardware = (*device)->has_hardware();
  rig.section =
      (*device)->read_section(top, {std::filesystem::path{file}.parent_path().string(), &rig.text});
}

// A slower limit would hold the force on after the finger has left the plate.
constexpr double max_time_to_full_force_s = 0.1;

void read_limits(MapReader& top, core::ForceLimits& limits) {
  limits.max_force_n =
      top.number({"max_force_n", "larger forces are scaled down to it"}, {0.01, 100.0});
  limits.max_force_rate_n_per_s = top.number(
      {"max_force_rate_n_per_s", "limit on the rate of change of force"}, Range::positive(1e6));
  const double least_n_per_s = limits.max_force_n / max_time_to_full_force_s;
  if (top.has("max_force_rate_n_per_s") && limits.max_force_rate_n_per_s < least_n_per_s) {
    top.reject("max_force_rate_n_per_s",
               fmt::format("is too slow to reach, and to release, max_force_n within {} s (at "
                           "least {:.6g})",
                           max_time_to_full_force_s, least_n_per_s));
  }
}

std::string read_card(MapReader& reader, const std::string& usual) {
  std::string card = reader.text(
      {"card", "name of an ALSA PCM (`aplay -L` lists them); in quotes if it has a comma"}, usual);
  // ALSA's plug-in `file` would run what follows
  reader.check("card", card.find('|') == std::string::npos, R"({"not": {"pattern": "[|]"}})",
               "names a command to run ('|')");
  return card;
}

void read_audio(MapReader& top, Rig& rig) {
  top.map(
      {"audio",
       "sound card of the masking noise; unset: the card `default` with hardware, else none",
       "audio: {card: \"plughw:1\", rate_hz: 48000, gain_db: -6}"},
      Presence::optional, [&](MapReader& reader) {
        core::AudioOutput& audio = rig.audio.emplace();
        audio.card = read_card(reader, audio.card);
        audio.rate_hz =
            reader.integer({"rate_hz", "samples a second"}, 8000, 192'000, audio.rate_hz);
        audio.gain_db = reader.number(
            {"gain_db",
             "calibration of card and headphones, added to the level that the protocol asks for"},
            {-60.0, 60.0}, audio.gain_db);
      });
}

core::ActuatorResponse read_actuator_response(MapReader& reader) {
  core::ActuatorResponse response;
  reader.list(
      {"points",
       "as measured; straight lines between them over the logarithm of frequency, the nearest "
       "beyond"},
      Presence::at_least_one, [&](MapReader& point) {
        std::vector<core::DeviceResponse::Point>& points = response.magnitude.points;
        const double frequency_hz =
            point.number({"frequency_hz", "ascending"}, Range::positive(1e5));
        if (!points.empty() && frequency_hz <= points.back().frequency_hz) {
          point.reject("frequency_hz", "is not above that of the point before");
        }
        points.push_back(
            {frequency_hz, point.number({"gain", "force over force commanded"}, {1e-3, 1e3})});
        response.phase_rad.push_back(
            std::numbers::pi / 180.0 *
            point.number({"phase_deg", "of the force, not wrapped; negative: it lags"},
                         {-3600.0, 3600.0}, 0.0));
      });
  response.magnitude.max_boost =
      reader.number({"max_boost", "no frequency is amplified by more"}, {1.0, 100.0}, 4.0);
  return response;
}

void read_actuator(MapReader& top, Rig& rig) {
  top.map(
      {"actuator",
       "a vibration actuator on a sound card, which renders what is above the protocol's "
       "rendering.crossover_hz; unset: none",
       "actuator: {card: \"hw:1\", full_scale_n: 4}"},
      Presence::optional, [&](MapReader& reader) {
        core::ActuatorOutput& actuator = rig.actuator.emplace();
        actuator.card = read_card(reader, "default");
        actuator.rate_hz = reader.integer({"rate_hz", "samples a second"}, 8000, 192'000, 48'000);
        actuator.channels = reader.integer(
            {"channels", "of the card that are opened; silent but for one"}, 1, 64, 2);
        actuator.channel = reader.integer({"channel", "that plays, from 1 to channels"}, 1, 64, 1);
        if (actuator.channel > actuator.channels) {
          reader.reject("channel", "is above channels");
        }
        actuator.full_scale_n =
            reader.number({"full_scale_n", "force on the finger at full scale"}, {1e-3, 1000.0});
        actuator.limits.peak_n = reader.number({"max_force_n", "no sample is larger"},
                                               Range::positive(1000.0), actuator.full_scale_n);
        actuator.limits.rms_n =
            reader.number({"max_rms_force_n", "over about a second: what heats a coil"},
                          Range::positive(1000.0), actuator.limits.peak_n);
        actuator.max_delay_s = reader.number(
            {"max_delay_s", "from the tick of an impact to its sound; it is the same for all"},
            {0.001, 0.1}, actuator.max_delay_s);
        actuator.max_gaps = reader.integer(
            {"max_gaps", "of the card's sound in a trial; more are a fault, which ends the trial"},
            0, 1'000'000, actuator.max_gaps);
        actuator.response = core::ActuatorResponse::flat();
        reader.map(
            {"response", "what it makes of a command, undone mode by mode; unset: as commanded"},
            Presence::optional,
            [&](MapReader& inner) { actuator.response = read_actuator_response(inner); });
      });
}

void read_response(MapReader& top, Rig& rig) {
  top.map(
      {"vibration_response",
       "what the device makes of a commanded vibration: undone in what technique `recorded` plays, "
       "by a filter of minimum phase"},
      Presence::optional, [&](MapReader& reader) {
        core::DeviceResponse response;
        reader.list(
            {"points",
             "as measured; straight lines between them on logarithmic axes, beyond them constant"},
            Presence::at_least_one, [&](MapReader& point) {
              const double frequency_hz =
                  point.number({"frequency_hz", "ascending"}, Range::positive(1e5));
              if (!response.points.empty() && frequency_hz <= response.points.back().frequency_hz) {
                point.reject("frequency_hz", "is not above that of the point before");
              }
              response.points.push_back(
                  {frequency_hz,
                   point.number({"gain", "force at the grip over force commanded, in magnitude"},
                                {1e-3, 1e3})});
            });
        response.max_boost = reader.number({"max_boost", "no frequency is amplified by more"},
                                           {1.0, 100.0}, response.max_boost);
        rig.vibration_response = std::make_shared<const core::DeviceResponse>(std::move(response));
      });
}

// A file is looked for beside the rig.
void read_markers(MapReader& top, const std::string& file, Rig& rig) {
  top.map({"markers",
           "who is told of the session's changes of state, as they happen "
           "(`runner/session/markers/README.md`); unset: nobody",
           "markers: {osc: {port: 9000}, lines: /dev/ttyUSB0}"},
          Presence::optional, [&](MapReader& reader) {
            reader.map({"osc", "Open Sound Control over UDP: `/tapstudy/<state>`; unset: none"},
                       Presence::optional, [&](MapReader& osc) {
                         OscTarget& target = rig.markers.osc.emplace();
                         target.host =
                             osc.text({"host", "name or address, looked up before the session"},
                                      target.host);
                         target.port = osc.integer({"port", "UDP port"}, 1, 65'535);
                       });
            reader.map({"lsl",
                        "a stream of the Lab Streaming Layer, whose library liblsl must be "
                        "installed; unset: none"},
                       Presence::optional, [&](MapReader& lsl) {
                         LslStreams& streams = rig.markers.lsl.emplace();
                         streams.name = lsl.text({"name", "of the stream"}, streams.name);
                         streams.has_forces = lsl.yes_or_no(
                             {"forces", "a second stream, NAME_force, of the force in every tick"},
                             streams.has_forces);
                       });
            if (reader.has("lines")) {
              rig.markers.lines =
                  (std::filesystem::path{file}.parent_path() /
                   reader.text({"lines",
                                "serial port (115 200 baud, 8N1), named pipe or file that gets a "
                                "line for each; relative to the rig's folder; unset: none"}))
                      .string();
            }
          });
}

void read_own_placement(MapReader& top, const std::function<void(const core::Placement&)>& take) {
  read_placement(top, {"placement", "replaces the protocol's placement; unset: the protocol's"},
                 Presence::optional, take);
}

void read_whole(MapReader& top, const std::string& file, RigDevices devices, Rig& rig) {
  top.check_format("tapstudy-rig/1");
  read_device(top, file, devices, rig);
  read_limits(top, rig.gate.limits);
  if (rig.has_hardware) {
    read_limits_of_motion(top, rig.gate);
  }
  if (top.has("vibration_band_hz")) {
    rig.vibration_band_hz =
        top.number({"vibration_band_hz",
                    "the highest frequency of vibration that the device renders; `check --rig` "
                    "names the modes above it; unset: taken for 300 Hz there"},
                   Range::positive(1e5));
  }
  read_response(top, rig);
  read_loop(top, rig);
  check_reply_time(top, rig);
  read_own_placement(top, [&](const core::Placement& placement) { rig.placement = placement; });
  read_audio(top, rig);
  read_actuator(top, rig);
  read_markers(top, file, rig);
}

Rig parse(const std::string& text, const std::string& file, RigDevices devices,
          Problems& problems) {
  MapReader top = MapReader::whole_file(text, file, problems);
  Rig rig;
  rig.text = text;
  read_whole(top, file, devices, rig);
  top.finish();
  return rig;
}
}  // namespace

Rig parse_rig(const std::string& text, const std::string& file, RigDevices devices) {
  Problems problems{file};
  Rig rig = parse(text, file, devices, problems);
  problems.throw_if_any();
  return rig;
}

std::string rig_schema(RigDevices devices) {
  return MapReader::schema_of(
      "rig", "The device of a study and what it may do. SI units, spelled in the keys.",
      [&](MapReader& top) {
        Rig rig;
        read_whole(top, "", devices, rig);
      });
}

std::optional<core::Placement> placement_in_stored_rig(const std::string& rig_text) {
  if (rig_text.empty()) {
    return std::nullopt;
  }
  const std::string file = "stored rig";
  Problems problems{file};
  MapReader top = MapReader::first_document(rig_text, file, problems);  // a calibration follows
  std::optional<core::Placement> placement;
  read_own_placement(top, [&](const core::Placement& own) { placement = own; });
  problems.throw_if_any();
  return placement;
}

std::optional<core::ActuatorOutput> actuator_in_stored_rig(const std::string& rig_text) {
  const std::string file = "stored rig";
  Problems problems{file};
  MapReader top = MapReader::first_document(rig_text, file, problems);
  Rig rig;
  read_actuator(top, rig);
  problems.throw_if_any();
  return rig.actuator;
}

std::set<std::string> rig_keys_asked_for(const std::string& text, const std::string& file,
                                         RigDevices devices) {
  Problems problems{file};
  parse(text, file, devices, problems);
  return problems.asked();
}

namespace {
using Presence = MapReader::Presence;
constexpr const char* format = "tapstudy-calibration/1";
constexpr const char* device = "spidar-g6";

core::StringCalibration read_string(MapReader& reader) {
  core::StringCalibration string;
  string.metres_per_count = reader.number(
      {"metres_per_count",
       "string length per encoder count; negative if the count falls as the string lengthens"},
      {-1e-3, 1e-3});
  string.volts_per_newton = reader.number({"volts_per_newton", "output voltage per string tension"},
                                          Range::positive(100.0));
  string.dac_counts_per_volt =
      reader.number({"dac_counts_per_volt", "DAC counts per output voltage"}, Range::positive(1e5));
  reader.check("metres_per_count", string.metres_per_count != 0.0, R"({"not": {"const": 0}})",
               "is zero (measure it: pull 0.1 m of string)");
  return string;
}

core::SpidarCalibration read_calibration(MapReader& top, const std::vector<std::string>& types) {
  top.check_format(format);
  top.word({"device", "kind of device"}, "device", {device});
  top.word({"type", "type of the frame; must be that of the rig"}, "type of this rig", types);
  core::SpidarCalibration calibration;
  calibration.min_tension_n =
      top.number({"min_tension_n", "keeps the strings taut"}, Range::positive(5.0));
  calibration.max_tension_n = top.number(
      {"max_tension_n", "maximum tension per string; above min_tension_n"}, Range::positive(20.0));
  if (calibration.min_tension_n >= calibration.max_tension_n) {
    top.reject("max_tension_n", "is not above min_tension_n");
  }
  std::size_t count = 0;
  top.list({"strings", "one per motor, in the order of the motors"}, Presence::required,
           [&](MapReader& reader) {
             const core::StringCalibration string = read_string(reader);
             if (count < calibration.strings.size()) {
               calibration.strings.at(count) = string;
             }
             ++count;
           });
  top.check("strings", count == calibration.strings.size(), R"({"minItems": 8, "maxItems": 8})",
            "must be eight, one for each string, in the order of the motors");
  return calibration;
}

core::SpidarCalibration parse(const std::string& text, const std::string& file,
                              const std::string& type, Problems& problems) {
  MapReader top = MapReader::whole_file(text, file, problems);
  const core::SpidarCalibration calibration = read_calibration(top, {type});
  top.finish();
  return calibration;
}
}  // namespace

std::string calibration_schema(const std::vector<std::string>& types) {
  return MapReader::schema_of(
      "calibration",
      "What was measured on one SPIDAR-G6, string by string. SI units, spelled in the keys.",
      [&](MapReader& top) { read_calibration(top, types); });
}

core::SpidarCalibration parse_calibration(const std::string& text, const std::string& file,
                                          const std::string& type) {
  Problems problems{file};
  const core::SpidarCalibration calibration = parse(text, file, type, problems);
  problems.throw_if_any();
  return calibration;
}

void write_calibration(std::ostream& out, const std::string& type,
                       const core::SpidarCalibration& calibration) {
  core::print(out,
              "# Measured on one device, string by string; good for no other.\n"
              "format: {}\n"
              "device: {}\n"
              "type: {}\n"
              "min_tension_n: {}\n"
              "max_tension_n: {}\n"
              "strings:\n",
              format, device, type, calibration.min_tension_n, calibration.max_tension_n);
  for (const core::StringCalibration& string : calibration.strings) {
    core::print(
        out,
        "  - {{metres_per_count: {:.6g}, volts_per_newton: {:.6g}, dac_counts_per_volt: {}}}\n",
        string.metres_per_count, string.volts_per_newton, string.dac_counts_per_volt);
  }
}

std::set<std::string> calibration_keys_asked_for(const std::string& text, const std::string& file) {
  Problems problems{file};
  parse(text, file, "X3R", problems);
  return problems.asked();
}
}  // namespace tapstudy::protocols
