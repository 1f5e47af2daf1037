#include <fmt/format.h>

#include <memory>
#include <optional>

#include "analysis/figures/figure.hpp"
#include "device/device.hpp"
#include "runner/commands/commands.hpp"
#include "runner/devices/device_kind.hpp"
#include "runner/devices/diagnosis.hpp"
#include "runner/devices/rigs.hpp"
namespace tapstudy::runner {
namespace {
struct DoctorOptions {
  std::string rig;
  double rate_hz{1000.0};
  double seconds{5.0};
  std::string figure;
};

double microseconds(device::Nanoseconds time) {
  return 1e-3 * static_cast<double>(time);
}

void print(const char* name, const device::LatenessCount& times, const std::string& late) {
  fmt::print("  {:<11}{:>10.1f}{:>10.1f}{:>10.1f}{:>10.1f}{:>8}\n", name,
             microseconds(times.quantile(0.5)), microseconds(times.quantile(0.99)),
             microseconds(times.quantile(0.999)), microseconds(times.worst()), late);
}

void print(const Diagnosis& diagnosis) {
  fmt::print("loop       {}\n", diagnosis.idle.realtime);
  fmt::print("governor   {}\n", diagnosis.governor);
  fmt::print("timer      slack {} ns\n", diagnosis.idle.timer_slack_ns);
  fmt::print("\nlateness [us] of {} ticks at {} Hz\n", diagnosis.idle.lateness.count(),
             1e9 / static_cast<double>(diagnosis.period));
  fmt::print("               median       p99     p99.9     worst    late\n");
  print("idle", diagnosis.idle.lateness, std::to_string(diagnosis.idle.late));
  if (diagnosis.loaded) {
    print("loaded", diagnosis.loaded->lateness, std::to_string(diagnosis.loaded->late));
  }
  if (diagnosis.round_trip) {
    fmt::print("\nround trip [us] of {} requests to the device\n", diagnosis.round_trip->count());
    print("", *diagnosis.round_trip, "");
  }
}

analysis::Series series_of(const char* label, const device::ProbedLoop& probed) {
  analysis::Series series{label, analysis::Axis::left, {}, {}};
  double rest = 1.0;
  while (rest > 0.5 / static_cast<double>(probed.lateness.count())) {
    series.x.push_back(microseconds(probed.lateness.quantile(1.0 - rest)) + 0.1);
    series.y.push_back(rest);
    rest *= 0.8;
  }
  return series;
}

void draw(const Diagnosis& diagnosis, const std::string& file) {
  analysis::draw_svg(
      {"Lateness of the loop",
       "lateness [us]",
       "share of ticks that are later",
       "",
       1,
       {{"", {series_of("idle", diagnosis.idle), series_of("loaded", *diagnosis.loaded)}}},
       analysis::Scale::logarithmic},
      file);
}

// Of the rig's device; without a rig, of any device that is plugged in and accessible.
std::optional<device::LatenessCount> round_trip(const DoctorOptions& options,
                                                const protocols::Rig& rig) {
  if (!options.rig.empty()) {
    return kind_of(rig).round_trip();
  }
  for (const DeviceKind* const kind : device_kinds()) {
    if (!kind->listing().empty() && kind->is_there()) {
      return kind->round_trip();
    }
  }
  return std::nullopt;
}

void run_doctor(const DoctorOptions& options) {
  const protocols::Rig rig = options.rig.empty() ? simulated_rig() : read_rig(options.rig);
  const auto answered = round_trip(options, rig);
  Diagnosis diagnosis =
      diagnose(rig.realtime, static_cast<device::Nanoseconds>(1e9 / options.rate_hz),
               options.seconds, Under::load_too);
  diagnosis.round_trip = answered;
  print(diagnosis);
  if (!options.figure.empty()) {
    draw(diagnosis, options.figure);
  }
  const Verdict verdict = verdict_of(diagnosis);
  if (!verdict.holds) {
    throw device::DeviceError{"\nverdict: " + verdict.words};
  }
  fmt::print("\nverdict: {}\n", verdict.words);
}
}  // namespace

void add_doctor(CommandParser& line) {
  Command command = line.add("doctor", "Measure whether this machine can sustain the haptic loop");
  const auto options = std::make_shared<DoctorOptions>();
  command.option("--rig", options->rig, "Rig whose real-time settings to use (YAML)");
  command.number_within("--rate-hz", options->rate_hz, 500.0, 10000.0, "Rate of the loop");
  command.number_within("--seconds", options->seconds, 0.1, 600.0,
                        "Duration of each measurement, idle and under load");
  command.file("--figure", options->figure, ".svg", "Draw the lateness (.svg)");
  command.on_run([options] { run_doctor(*options); });
}
}  // namespace tapstudy::runner
