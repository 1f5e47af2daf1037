#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>

#include "analysis/report/figures/colour_map.hpp"
#include "analysis/report/figures/figure.hpp"
#include "core/error.hpp"
#include "core/files/output_files.hpp"
#include "core/haptics/haptic_state.hpp"
#include "core/text/print.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "protocols/reader/tap_script.hpp"
#include "protocols/yaml/text_file.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/commands/shared_options.hpp"
#include "runner/session/devices/rigs.hpp"
#include "runner/studies/scripted_tap.hpp"
namespace tapstudy::runner {
namespace {
using core::TraceSample;

struct TapOptions {
  std::string protocol;
  std::string stimulus;
  std::string at{"0,0"};
  double speed_m_s{0.3};
  double seconds{0.3};
  std::string technique;
  std::string script;
  std::string csv;
  std::string actuator_csv;
  std::string panels;
  std::string frames;
  std::vector<std::string> settings;
};

double seconds_of(const TraceSample& sample) {
  return 1e-9 * static_cast<double>(sample.t_ns);
}

void write_csv(std::ostream& out, const std::vector<TraceSample>& trace) {
  out << "t_s,position_x_m,position_y_m,position_z_m,velocity_x_m_s,velocity_y_m_s,velocity_z_m_s,"
         "penetration_m,penalty_n,vibration_n,sinusoid_n,force_x_n,force_y_n,force_z_n,touching,"
         "impact,saturated\n";
  for (const TraceSample& s : trace) {
    core::print(out,
                "{:.6f},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},"
                "{:.17g},{:.17g},{:.17g},{:.17g},{:d},{:d},{:d}\n",
                seconds_of(s), s.position_m[0], s.position_m[1], s.position_m[2], s.velocity_m_s[0],
                s.velocity_m_s[1], s.velocity_m_s[2], s.penetration_m, s.penalty_n, s.vibration_n,
                s.sinusoid_n, s.force_n[0], s.force_n[1], s.force_n[2], s.touching, s.impact,
                s.saturated);
  }
}

void write_actuator_csv(std::ostream& out, const std::vector<float>& actuator_n) {
  out << "t_s,actuator_n\n";
  for (std::size_t i = 0; i < actuator_n.size(); ++i) {
    core::print(out, "{:.9f},{:.9g}\n", static_cast<double>(i) / tap_actuator_rate_hz,
                actuator_n[i]);
  }
}

template <class Value>
double largest(const std::vector<TraceSample>& trace, const Value& value) {
  double most = 0.0;
  for (const TraceSample& sample : trace) {
    most = std::max(most, std::abs(value(sample)));
  }
  return most;
}

void print_summary(const TapOptions& options, const protocols::PresentedStimulus& stimulus,
                   const TapTrace& recorded) {
  const std::vector<TraceSample>& trace = recorded.ticks;
  const auto impact = std::ranges::find(trace, true, &TraceSample::impact);
  if (options.script.empty()) {
    fmt::print("{} at {}\n", options.stimulus, options.at);
  } else {
    fmt::print("{} by {}\n", options.stimulus, options.script);
  }
  for (const auto& [name, value] : stimulus.values) {
    fmt::print("  {} {}\n", name, value);
  }
  if (impact != trace.end()) {
    fmt::print("  impact         {:.3f} s, {:.4f} m/s\n", seconds_of(*impact),
               -core::along_normal(impact->velocity_m_s));
  }
  fmt::print("  impacts        {}{}\n", std::ranges::count(trace, true, &TraceSample::impact),
             impact == trace.end() ? "  (the tip met nothing: is the point beside the body?)" : "");
  fmt::print("  penalty        {:.4g} N at most\n",
             largest(trace, [](const TraceSample& s) { return s.penalty_n; }));
  fmt::print("  vibration      {:.4g} N at most\n",
             largest(trace, [](const TraceSample& s) { return s.vibration_n; }));
  fmt::print("  sinusoid       {:.4g} N at most\n",
             largest(trace, [](const TraceSample& s) { return s.sinusoid_n; }));
  if (!recorded.actuator_n.empty()) {
    const auto [least, most] = std::ranges::minmax(recorded.actuator_n);
    fmt::print("  actuator       {:.4g} N at most\n", std::max(std::abs(least), std::abs(most)));
  }
  fmt::print("  limited ticks  {}\n", std::ranges::count(trace, true, &TraceSample::saturated));
}

protocols::Protocol protocol_with_technique(const TapOptions& options) {
  protocols::Protocol protocol = protocols::read_protocol(options.protocol);
  if (options.technique.empty()) {
    return protocol;
  }
  const core::Technique* technique = core::find_technique(options.technique);
  if (technique == nullptr) {
    throw core::InvalidInput{fmt::format("--technique: '{}' is not a technique (one of: {})",
                                         options.technique,
                                         fmt::join(core::technique_names(), ", "))};
  }
  for (protocols::Stimulus& stimulus : protocol.stimuli) {
    const auto settings = protocols::stimulus_with(protocol, stimulus).rendering;
    if (const auto missing = technique->missing(settings); !missing.empty()) {
      throw core::InvalidInput{
          fmt::format("--technique: '{}' needs {}", options.technique, missing)};
    }
    stimulus.technique = technique;
  }
  return protocol;
}

constexpr double shown_before_impact_s = 0.02;

// Penalty force on the left axis; the technique's far smaller components on the right one.
analysis::Panel panel_of(const std::string& title, const std::vector<TraceSample>& trace) {
  analysis::Panel panel{
      title,
      {{"penalty", analysis::Axis::left, {}, {}}, {"vibration", analysis::Axis::right, {}, {}}}};
  const auto impact = std::ranges::find(trace, true, &TraceSample::impact);
  const double start_s = impact == trace.end() ? 0.0 : seconds_of(*impact);
  for (const TraceSample& sample : trace) {
    const double t_s = seconds_of(sample) - start_s;
    if (t_s < -shown_before_impact_s) {
      continue;
    }
    panel.series[0].x.push_back(t_s);
    panel.series[0].y.push_back(sample.penalty_n);
    panel.series[1].x.push_back(t_s);
    panel.series[1].y.push_back(1e3 * (sample.vibration_n + sample.sinusoid_n));
  }
  return panel;
}

// One figure per plate, one row per stimulus, one column per tapping point (paper, Figures 4, 5).
void draw_panels(const TapOptions& options, const protocols::Protocol& protocol) {
  ModelLibrary models;
  const protocols::Rig rig = simulated_rig();
  core::make_directories(options.panels);
  for (const auto& [name, plate] : protocol.plates) {
    analysis::Figure figure{"Feedback force, plate " + name,
                            "time after impact [s]",
                            "penalty [N]",
                            "vibration [mN]",
                            protocol.tapping_points_m.size(),
                            {}};
    for (const protocols::Stimulus& stimulus : protocol.stimuli) {
      if (stimulus.plate != plate) {
        continue;
      }
      for (const auto& [point, at_m] : plate->tapping_points_m) {
        const ScriptedTap tap{stimulus_with(protocol, stimulus), at_m, options.speed_m_s,
                              options.seconds};
        figure.panels.push_back(panel_of(fmt::format("{}, {}", stimulus.label, point),
                                         trace_of(tap, protocol, rig, models).ticks));
      }
    }
    const std::string file =
        (std::filesystem::path{options.panels} / ("forces_" + name + ".svg")).string();
    if (!figure.panels.empty()) {
      analysis::draw_svg(figure, file);
      fmt::print("{}\n", file);
    }
  }
}

// The paper's Figure 3.
void draw_frames(const TapOptions& options, const protocols::Protocol& protocol,
                 const ScriptedTap& tap, ModelLibrary& models) {
  const protocols::PresentedStimulus& stimulus = tap.stimulus;
  const auto* const box = std::get_if<core::Box>(&stimulus.plate->shape);
  if (box == nullptr || !stimulus.technique->needs_model()) {
    throw core::InvalidInput{"--frames: draws plates that vibrate only"};
  }
  const auto plate = models.plate_of(protocol, stimulus);
  const std::string title =
      fmt::format("{} struck at {}, {} m/s", options.stimulus, options.at, options.speed_m_s);
  analysis::draw_svg(
      analysis::map_of_strike(*plate, *box, stimulus.rendering, {tap.at_m, tap.speed_m_s}, title),
      options.frames);
}

TapTrace trace_of_script(const TapOptions& options, const protocols::Protocol& protocol,
                         const protocols::PresentedStimulus& stimulus, ModelLibrary& models) {
  const protocols::TapScript script = protocols::parse_tap_script(
      protocols::contents_of(options.script), options.script, *stimulus.plate);
  return trace_of(stimulus, script, protocol, simulated_rig(), models);
}

TapTrace trace_of_tap(const TapOptions& options, const protocols::Protocol& protocol,
                      const protocols::PresentedStimulus& stimulus, ModelLibrary& models) {
  const ScriptedTap tap{stimulus, point_on_plate(options.at, *stimulus.plate), options.speed_m_s,
                        options.seconds};
  TapTrace trace = trace_of(tap, protocol, simulated_rig(), models);
  if (!options.frames.empty()) {
    draw_frames(options, protocol, tap, models);
  }
  return trace;
}

void check(const TapOptions& options, const protocols::Protocol& protocol) {
  if (!options.script.empty() && !(options.panels.empty() && options.frames.empty())) {
    throw core::InvalidInput{"--script is of one trace (--csv): no --panels, no --frames"};
  }
  if (!options.settings.empty() && !options.panels.empty()) {
    throw core::InvalidInput{"--set is of one stimulus (--stimulus), --panels draws all of them"};
  }
  if (!options.actuator_csv.empty() && !(protocol.rendering.crossover && options.panels.empty())) {
    throw core::InvalidInput{
        "--actuator-csv is of one trace (no --panels), of a protocol with rendering.crossover_hz"};
  }
  if (options.stimulus.empty() && options.panels.empty()) {
    throw core::InvalidInput{"--stimulus is required (or --panels DIR for all of them)"};
  }
  for (const std::string& file : {options.csv, options.actuator_csv, options.frames}) {
    if (!file.empty() && file != "-") {
      core::check_is_new(file);
    }
  }
}

// But for what goes to standard output.
void write_files(const TapOptions& options, const TapTrace& trace) {
  if (!options.actuator_csv.empty()) {
    core::write_new_file(options.actuator_csv,
                         [&](std::ostream& out) { write_actuator_csv(out, trace.actuator_n); });
  }
  if (!options.csv.empty() && options.csv != "-") {
    core::write_new_file(options.csv, [&](std::ostream& out) { write_csv(out, trace.ticks); });
  }
}

void run_tap(const TapOptions& options) {
  const protocols::Protocol protocol = protocol_with_technique(options);
  check(options, protocol);
  if (!options.panels.empty()) {
    draw_panels(options, protocol);
    return;
  }
  ModelLibrary models;
  const protocols::PresentedStimulus stimulus =
      member_set_to(options.settings, protocol, protocol.stimulus(options.stimulus));
  const TapTrace trace = options.script.empty()
                             ? trace_of_tap(options, protocol, stimulus, models)
                             : trace_of_script(options, protocol, stimulus, models);
  write_files(options, trace);
  if (options.csv == "-") {
    write_csv(std::cout, trace.ticks);
  } else {
    print_summary(options, stimulus, trace);
  }
}
}  // namespace

void add_tap(CommandParser& line) {
  Command command = line.add("tap", "Force trace of one scripted tap");
  const auto options = std::make_shared<TapOptions>();
  command.shipped_file("protocol", options->protocol, "Study (YAML)");
  command.option("--stimulus", options->stimulus, "Which stimulus to tap");
  command.option("--at", options->at, "X,Y on the plate in metres, or a tapping point");
  command.number("--speed", options->speed_m_s, "Speed of impact [m/s]");
  command.option(
      "--technique", options->technique,
      fmt::format("{} instead of the stimulus's own", fmt::join(core::technique_names(), ", ")));
  command.number("--seconds", options->seconds, "How long the finger stays");
  command.option("--script", options->script,
                 "What the finger does (YAML), instead of --at, --speed and --seconds");
  command.repeatable("--set", options->settings, set_help);
  command.option("--csv", options->csv, "Write every tick to this new file (- for stdout)");
  command.option("--actuator-csv", options->actuator_csv,
                 "Write what the actuator renders of it, 48000 samples a second, to this new file");
  command.option("--panels", options->panels,
                 "Draw all stimuli at all tapping points into this directory (SVG)");
  command.file("--frames", options->frames, ".svg",
               "Draw the plate's displacement after the strike, from above (.svg)");
  command.on_run([options] { run_tap(*options); });
}
}  // namespace tapstudy::runner
