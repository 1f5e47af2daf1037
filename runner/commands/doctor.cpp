#include <fmt/format.h>

#include <functional>
#include <memory>

#include "analysis/report/figures/figure.hpp"
#include "device/device.hpp"
#include "device/loop/sleep_inhibitor.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/session/devices/actuator_card.hpp"
#include "runner/session/devices/device_kind.hpp"
#include "runner/session/devices/diagnosis.hpp"
#include "runner/session/devices/rigs.hpp"
namespace tapstudy::runner {
namespace {
struct DoctorOptions {
  std::string rig;
  double rate_hz{1000.0};
  double seconds{10.0};  // 99.9 % needs thousands of ticks
  std::string figure;
};

double microseconds(device::Nanoseconds time) {
  return 1e-3 * static_cast<double>(time);
}

std::string interval_of(const device::LatenessCount& times) {
  const auto [low, high] = times.interval_of_quantile(0.999);
  return fmt::format("{:.1f} to {}", microseconds(low),
                     high ? fmt::format("{:.1f}", microseconds(*high)) : "?");
}

void print(const char* name, const device::LatenessCount& times, const std::string& rest) {
  fmt::print("  {:<11}{:>10.1f}{:>10.1f}{:>10.1f}{:>20}{:>10.1f}{}\n", name,
             microseconds(times.quantile(0.5)), microseconds(times.quantile(0.99)),
             microseconds(times.quantile(0.999)), interval_of(times), microseconds(times.worst()),
             rest);
}

constexpr const char* const lateness_header =
    "               median       p99     p99.9       95 % of p99.9     worst    {}  holds\n";

const char* to_text(Holds found) {
  return found == Holds::yes ? "yes" : found == Holds::no ? "no" : "open";
}

void print(const char* name, const Diagnosis& diagnosis, const device::ProbedLoop& probed) {
  print(name, probed.lateness,
        fmt::format("{:>8}  {}", probed.late, to_text(holds(diagnosis, probed))));
}

void print(const char* name, const device::ProbedCard& card) {
  print(name, card.lateness, fmt::format("{:>8}  {}", card.gaps, to_text(holds(card))));
}

void print(const DiagnosedCard& card, const core::ActuatorOutput& actuator) {
  const device::ProbedCard& idle = card.idle;
  fmt::print("\nactuator   card {}, {} Hz: period {:.2f} ms, buffer {:.2f} ms, delay {:.2f} ms\n",
             actuator.card, idle.rate_hz, 1e3 * idle.period_s, 1e3 * idle.buffer_s,
             1e3 * idle.delay_s);
  fmt::print("its clock  jitter {}, drift {:+.1f} ppm against the loop's\n",
             idle.jitter_s ? fmt::format("{:.1f} us", 1e6 * *idle.jitter_s)
                           : "not measured (it takes more than a second without a gap)",
             1e6 * idle.rate_error);
  if (idle.lateness.count() == 0) {
    fmt::print(
        "its gaps   {} idle, {} under load; lateness unknown: it does not tell what it has "
        "played\n",
        idle.gaps, card.loaded.gaps);
    return;
  }
  fmt::print("\nlateness [us] of {} periods of the actuator's card\n", idle.lateness.count());
  fmt::print(lateness_header, "gaps");
  print("idle", idle);
  print("loaded", card.loaded);
  fmt::print("  holds: no gap, and p99.9 is within {:.0f} us\n",
             microseconds(max_p999_lateness(idle)));
}

void print(const Diagnosis& diagnosis) {
  fmt::print("loop       {}\n", diagnosis.idle.realtime.text);
  for (const auto& [name, value] : diagnosis.machine) {
    fmt::print("{:<11}{}\n", name, value);
  }
  fmt::print("timer      slack {} ns\n", diagnosis.idle.timer_slack_ns);
  fmt::print("sleep      {}\n", diagnosis.sleep);
  for (const auto& [what, remedy] : diagnosis.idle.realtime.refusals) {
    fmt::print("refused    {}: {}\n", what, remedy);
  }
  fmt::print("\nlateness [us] of {} ticks at {} Hz\n", diagnosis.idle.lateness.count(),
             1e9 / static_cast<double>(diagnosis.period));
  fmt::print(lateness_header, "late");
  print("idle", diagnosis, diagnosis.idle);
  if (diagnosis.loaded) {
    print("loaded", diagnosis, *diagnosis.loaded);
  }
  if (diagnosis.on_device) {
    print("on device", diagnosis, *diagnosis.on_device);
  }
  fmt::print("  holds: p99.9 is within {:.0f} us\n",
             microseconds(max_p999_lateness(diagnosis.period)));
  if (diagnosis.round_trip) {
    fmt::print("\nround trip [us] of {} requests to the device\n", diagnosis.round_trip->count());
    print("", *diagnosis.round_trip, "");
  }
  if (!diagnosis.release.empty()) {
    fmt::print("\nrelease    {}\n", diagnosis.release);
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

// A vertical line.
analysis::Series limit_of(const char* label, device::Nanoseconds lateness) {
  constexpr double min_share = 1e-4;
  return {label,
          analysis::Axis::left,
          {microseconds(lateness), microseconds(lateness)},
          {min_share, 1.0}};
}

void draw(const Diagnosis& diagnosis, const std::string& file) {
  analysis::draw_svg({"Lateness of the loop",
                      "lateness [us]",
                      "share of ticks that are later",
                      "",
                      1,
                      {{"",
                        {series_of("idle", diagnosis.idle), series_of("loaded", *diagnosis.loaded),
                         limit_of("99.9 % must be earlier", max_p999_lateness(diagnosis.period))}}},
                      analysis::Scale::logarithmic},
                     file);
}

// Uses the rig's device; without a rig, any that is plugged in and accessible.
std::function<void()> zero_force_exchange(const DoctorOptions& options, const protocols::Rig& rig) {
  if (!options.rig.empty()) {
    return kind_of(rig).zero_force_exchange(rig);
  }
  for (const DeviceKind* const kind : device_kinds()) {
    if (!kind->listing().empty() && kind->is_there()) {
      return kind->zero_force_exchange(rig);
    }
  }
  return {};
}

// As the loop was: with nothing else to do, then under load.
DiagnosedCard diagnosed(const core::ActuatorOutput& actuator, const protocols::Rig& rig,
                        double seconds) {
  const auto card = open_actuator_card(actuator);
  const core::RealtimeRequest request = device::below(rig.realtime);
  DiagnosedCard found{device::probe_card(*card, seconds, request), {}};
  {
    const device::Load load;
    found.loaded = device::probe_card(*card, seconds, request);
  }
  for (const device::ProbedCard* const probed : {&found.idle, &found.loaded}) {
    if (probed->loss) {
      throw device::DeviceError{
          fmt::format("the actuator's card plays no more ({})", probed->loss->why)};
    }
  }
  return found;
}

void run_doctor(const DoctorOptions& options) {
  const protocols::Rig rig = options.rig.empty() ? simulated_rig() : read_rig(options.rig);
  const std::string release = kind_of(rig).tried_release(rig);
  Diagnosis diagnosis =
      diagnose(rig.realtime, static_cast<device::Nanoseconds>(1e9 / options.rate_hz),
               options.seconds, Under::load_too, zero_force_exchange(options, rig));
  diagnosis.release = release;
  diagnosis.sleep = device::SleepInhibitor{}.outcome();
  if (rig.actuator) {
    diagnosis.actuator = diagnosed(*rig.actuator, rig, options.seconds);
  }
  print(diagnosis);
  if (rig.actuator) {
    print(*diagnosis.actuator, *rig.actuator);
  }
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
  command.shipped_file("--rig", options->rig, "Rig whose real-time settings to use (YAML)");
  command.number_within("--rate-hz", options->rate_hz, 500.0, 10000.0, "Rate of the loop");
  command.number_within("--seconds", options->seconds, 0.1, 600.0,
                        "Duration of the measurements, idle and under load each");
  command.file("--figure", options->figure, ".svg", "Draw the lateness (.svg)");
  command.on_run([options] { run_doctor(*options); });
}
}  // namespace tapstudy::runner
