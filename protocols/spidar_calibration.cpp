#include "protocols/spidar_calibration.hpp"

#include <fmt/format.h>

#include "core/print.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;
constexpr const char* format = "tapstudy-calibration/1";
constexpr const char* device = "spidar-g6";

core::StringCalibration read_string(MapReader& reader) {
  core::StringCalibration string;
  string.metres_per_count = reader.number("metres_per_count", {-1e-3, 1e-3});
  string.volts_per_newton = reader.number("volts_per_newton", Range::positive(100.0));
  string.dac_counts_per_volt = reader.number("dac_counts_per_volt", Range::positive(1e5));
  if (string.metres_per_count == 0.0) {
    reader.reject("metres_per_count", "is zero (measure it: pull 0.1 m of string)");
  }
  return string;
}

core::SpidarCalibration parse(const std::string& text, const std::string& file,
                              const std::string& type, Problems& problems) {
  MapReader top = MapReader::whole_file(text, file, problems);
  top.word("format", "format", {format});
  top.word("device", "device", {device});
  top.word("type", "type of this rig", {type});
  core::SpidarCalibration calibration;
  calibration.min_tension_n = top.number("min_tension_n", Range::positive(5.0));
  calibration.max_tension_n = top.number("max_tension_n", Range::positive(20.0));
  if (calibration.min_tension_n >= calibration.max_tension_n) {
    top.reject("max_tension_n", "is not above min_tension_n");
  }
  std::size_t count = 0;
  top.list("strings", Presence::required, [&](MapReader& reader) {
    const core::StringCalibration string = read_string(reader);
    if (count < calibration.strings.size()) {
      calibration.strings.at(count) = string;
    }
    ++count;
  });
  if (count != calibration.strings.size()) {
    top.reject("strings", "must be eight, one for each string, in the order of the motors");
  }
  top.finish();
  return calibration;
}
}  // namespace

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
