#include <fmt/format.h>
#include <sys/prctl.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <memory>

#include "analysis/figure.hpp"
#include "device/device.hpp"
#include "protocols/read_rig.hpp"
#include "runner/commands/commands.hpp"
#include "runner/doctor/loop_probe.hpp"
#include "runner/rig.hpp"
namespace tapstudy::runner {
namespace {
struct DoctorOptions {
  std::string rig;
  double rate_hz{1000.0};
  double seconds{5.0};
  std::string figure;
};

std::string governor() {
  std::ifstream file{"/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor"};
  std::string word;
  return file >> word ? word : "not told (a virtual machine?)";
}

double microseconds(device::Nanoseconds time) {
  return 1e-3 * static_cast<double>(time);
}

void print(const char* name, const ProbedLoop& probed) {
  fmt::print("  {:<6}{:>10.1f}{:>10.1f}{:>10.1f}{:>10.1f}{:>8}\n", name,
             microseconds(probed.lateness.quantile(0.5)),
             microseconds(probed.lateness.quantile(0.99)),
             microseconds(probed.lateness.quantile(0.999)), microseconds(probed.lateness.worst()),
             probed.late);
}

analysis::Series series_of(const char* label, const ProbedLoop& probed) {
  analysis::Series series{label, analysis::Axis::left, {}, {}};
  double rest = 1.0;
  while (rest > 0.5 / static_cast<double>(probed.lateness.count())) {
    series.x.push_back(microseconds(probed.lateness.quantile(1.0 - rest)) + 0.1);
    series.y.push_back(rest);
    rest *= 0.8;
  }
  return series;
}

// A tick that comes half a period late is felt as a click; a p99.9 of a quarter leaves room for the
// tick's own work.
bool is_fit(const ProbedLoop& probed, device::Nanoseconds period) {
  return probed.late == 0 && probed.lateness.quantile(0.999) < period / 4;
}

void run_doctor(const DoctorOptions& options) {
  const protocols::Rig rig =
      options.rig.empty() ? protocols::simulated_rig() : protocols::read_rig(options.rig);
  const device::RealtimeRequest request = realtime_request(rig.loop);
  const auto period = static_cast<device::Nanoseconds>(1e9 / options.rate_hz);
  const ProbedLoop idle = probe_loop(request, period, options.seconds);
  const ProbedLoop loaded = [&] {
    const Load load;
    return probe_loop(request, period, options.seconds);
  }();
  fmt::print("loop       {}\n", idle.realtime);
  fmt::print("governor   {}\n", governor());
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the C library's own
  fmt::print("timer      slack {} ns\n", prctl(PR_GET_TIMERSLACK));
  fmt::print("\nlateness [us] of {} ticks at {} Hz\n", idle.lateness.count(), options.rate_hz);
  fmt::print("          median       p99     p99.9     worst    late\n");
  print("idle", idle);
  print("loaded", loaded);
  if (!options.figure.empty()) {
    analysis::draw_svg({"Lateness of the loop",
                        "lateness [us]",
                        "share of ticks that are later",
                        "",
                        1,
                        {{"", {series_of("idle", idle), series_of("loaded", loaded)}}},
                        analysis::Scale::logarithmic},
                       options.figure);
  }
  if (!is_fit(idle, period)) {
    throw device::DeviceError{
        "\nverdict: this machine cannot hold the loop, even with nothing else to do"};
  }
  fmt::print("\nverdict: {}\n",
             is_fit(loaded, period)
                 ? "this machine holds the loop, under load too"
                 : "this machine holds the loop as long as nothing else runs on it: close other "
                   "programs during a session");
}
}  // namespace

void add_doctor(CLI::App& app) {
  auto* const command =
      app.add_subcommand("doctor", "Can this machine hold the loop? Measured, with a verdict");
  const auto options = std::make_shared<DoctorOptions>();
  command->add_option("--rig", options->rig, "What to ask of the machine (YAML)");
  command->add_option("--rate-hz", options->rate_hz, "Of the loop")
      ->check(CLI::Range(500.0, 10000.0))
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "To measure, idle and under load each")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  command->add_option("--figure", options->figure, "Draw the lateness (.svg)")
      ->check(ends_in(".svg"));
  command->callback([options] { run_doctor(*options); });
}
}  // namespace tapstudy::runner
