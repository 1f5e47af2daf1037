#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "device/hand/penalty_limit.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "protocols/schedule/groups.hpp"
#include "protocols/schedule/schedule.hpp"
#include "runner/commands/check_design.hpp"
#include "runner/commands/check_models.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/commands/shared_options.hpp"
#include "runner/session/devices/device_kind.hpp"
#include "runner/session/devices/rigs.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/session/stimuli/model_library.hpp"
#include "runner/session/stimuli/stimulus_family.hpp"
#include "runner/studies/counted.hpp"
#include "runner/studies/simulated_design.hpp"
#include "runner/terminal/process_exit.hpp"
namespace tapstudy::runner {
namespace {
struct CheckOptions {
  std::string protocol;
  std::string participants;
  bool shows_schedule{false};
  std::string seed{"1"};
  std::string rig;
  int simulations{0};
  std::string share;
  std::string out;
};
// Newmark's amplification of an overdamped mode is negative at large steps: the force changes sign
// with every tick.
void warn_of_overdamped_modes(const protocols::Protocol& protocol, ModelLibrary& models) {
  if (protocol.rendering.integrator != core::Integrator::newmark) {
    return;
  }
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (stimulus.technique->needs_model() &&
        (models.plate_of(protocol, stimulus_with(protocol, stimulus))->model.damping_ratio > 1.0)
            .any()) {
      fmt::print(
          "  warning: {} has overdamped modes, for which Newmark may oscillate at half the rate "
          "(integrator: exact does not)\n",
          stimulus.name);
    }
  }
}

// "2 modes below 300 Hz: 57.6, 248 Hz"
std::string describe_frequencies(const Eigen::ArrayXd& frequencies_hz, double band_limit_hz) {
  constexpr Eigen::Index most = 6;
  std::vector<std::string> first;
  for (const double frequency_hz : frequencies_hz.head(std::min(most, frequencies_hz.size()))) {
    first.push_back(fmt::format("{:.3g}", frequency_hz));
  }
  return fmt::format(
      "{} below {} Hz: {}{} Hz", counted(static_cast<std::size_t>(frequencies_hz.size()), "mode"),
      band_limit_hz, fmt::join(first, ", "), frequencies_hz.size() > most ? " …" : "");
}

std::string cost_of(const core::ModelReport& report, bool is_solved_now, bool is_first_use) {
  if (is_solved_now) {
    return fmt::format("{:.3f} s", report.cost.total_s());
  }
  return is_first_use ? fmt::format("from the cache, where it took {:.3f} s", report.cost.total_s())
                      : "scaled from the same body";
}

std::string kind_of_model(const core::ModelReport& report, bool is_beam) {
  return is_beam ? "a beam, in closed form"
                 : fmt::format("{}, {} dof", describe_elements(report), report.dofs);
}

void print_models(const protocols::Protocol& protocol, ModelLibrary& models) {
  std::string warnings;
  fmt::print("\nmodels\n{}", describe_surfaces(protocol));
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (!stimulus.technique->needs_model()) {
      continue;
    }
    const int solved_before = models.bodies_solved();
    const int used_before = models.bodies_used();
    const protocols::PresentedStimulus own = stimulus_with(protocol, stimulus);
    const auto body = models.body_of(protocol, own);
    const auto plate = models.plate_of(protocol, own);
    const core::ModelReport& report = body->report;
    const std::string cost =
        cost_of(report, models.bodies_solved() > solved_before, models.bodies_used() > used_before);
    const bool is_beam = stimulus.technique->needs_beam();
    fmt::print("  {}: {}, {}, {}\n", stimulus.name, kind_of_model(report, is_beam),
               describe_frequencies(plate->model.frequency_hz, protocol.band_limit_hz), cost);
    if (!is_beam) {
      const core::FrequencyErrors errors =
          core::frequency_errors(*body, plate_spec(protocol, own).material, protocol.band_limit_hz);
      fmt::print("    {}\n", describe_errors(errors));
      fmt::print("{}", describe_spending(protocol, own, models));
      warnings += note_of_folds(own) + note_of_hinges(own) + note_of_relaxation(own, report) +
                  warning_of_order(own, report) + warning_of_errors(stimulus.name, errors);
    }
  }
  fmt::print("{}", warnings);
  warn_of_overdamped_modes(protocol, models);
  warn_of_light_plates(protocol, models);
  if (models.bodies_used() == 0) {
    fmt::print("  none: no technique here needs a model\n");
  }
  fmt::print("{}", describe_real_plates(protocol));
}

// The bound of a device that acts later than it is told is lower.
void print_contact(const protocols::Protocol& protocol, double delay_s) {
  const int delay_ticks = static_cast<int>(std::ceil(delay_s * protocol.rate_hz - 1e-6));
  const double asked = largest_contact_stiffness_n_per_m(protocol);
  core::HandBody hand = protocol.simulation.hand;
  const auto limit_of = [&](int delay) {
    return device::largest_stable_penalty_n_per_m(hand, protocol.rendering.dt_s, delay);
  };
  const double limit = limit_of(delay_ticks);
  fmt::print(
      "\ncontact\n  {:.6g} N/m{}; at {} Hz the simulated hand rests on up to {:.0f} N/m", asked,
      asked > protocol.rendering.penalty_stiffness_n_per_m
          ? fmt::format(" at most, penalty {} N/m", protocol.rendering.penalty_stiffness_n_per_m)
          : " of penalty",
      protocol.rate_hz, limit);
  if (delay_ticks > 0) {
    fmt::print(" with this device, whose force acts {:.6g} ms late\n", 1e3 * delay_s);
  } else {
    fmt::print(",\n  on a device whose force acts a tick late up to {:.0f} N/m\n", limit_of(1));
  }
  hand.muscle_damping_n_s_per_m *= 0.5;
  if (asked >= limit) {
    fmt::print("  warning: it will chatter (lower penalty_stiffness_n_per_m or raise rate_hz)\n");
  } else if (asked >= limit_of(delay_ticks)) {
    fmt::print("  note: a hand with half its damping would chatter\n");
  }
}

void run_simulations(const SimulatedDesign& design, const protocols::Protocol& protocol,
                     const std::string& out) {
  check_trial_length(protocol);
  listen_for_stop();
  if (out.empty()) {
    fmt::print("\n{}", describe_design(design.participants, simulate_design(design, protocol)));
    return;
  }
  SharedSimulation share = shared_simulation(design.share, protocol);
  share.participants = design.participants;
  share.studies = design.studies;
  share.seed = design.seed;
  write_complete_share(out, share, [&](const std::string& /*unfinished*/) {
    return simulate_design(design, protocol);
  });
  fmt::print("\nshare {} of {} simulated studies\n{}\n", to_text(design.share), design.studies,
             out);
}

// A page of it, or all.
void print_schedule(const protocols::Schedule& schedule, bool is_whole) {
  constexpr std::ptrdiff_t page = 40;
  const std::ptrdiff_t shown =
      is_whole ? std::ssize(schedule) : std::min(page, std::ssize(schedule));
  fmt::print("{}",
             protocols::described(protocols::Schedule{schedule.begin(), schedule.begin() + shown}));
  if (shown < std::ssize(schedule)) {
    fmt::print("… and {} trials more (--schedule shows all)\n", std::ssize(schedule) - shown);
  }
}

void check_simulations(const CheckOptions& options) {
  if (options.simulations < 0 || options.simulations > 10000) {
    throw core::InvalidInput{
        fmt::format("--simulations: {} is not allowed (from 0 to 10000)", options.simulations)};
  }
  if (options.share.empty() != options.out.empty() ||
      (!options.share.empty() && options.simulations == 0)) {
    throw core::InvalidInput{"--share of `check` goes with --simulations and --out"};
  }
}

void run_check(const CheckOptions& options) {
  const protocols::Protocol protocol = protocols::read_protocol(options.protocol);
  const int participants = planned_participants(options.participants, protocol);
  check_simulations(options);
  double delay_s = 0.0;
  std::optional<protocols::Rig> rig;
  if (!options.rig.empty()) {
    rig = read_rig(options.rig);
    loop_settings(protocol, *rig);
    check_fits(protocol, *rig);
    delay_s = kind_of(*rig).force_delay_s(*rig, protocol.rendering.dt_s);
  }
  for (const std::string& language : protocols::languages_of(protocol.translations)) {
    protocols::read_protocol(options.protocol, language);  // what only its sessions would meet
  }
  const core::ActuatorOutput actuator =
      (rig ? rig->actuator : std::nullopt).value_or(core::ActuatorOutput{});
  print_design(protocol, participants, actuator.rate_hz);
  ModelLibrary models;
  print_models(protocol, models);
  print_divided_modes(protocol, models);
  if (rig) {
    print_unrendered_modes(protocol, models, *rig);
  }
  print_families(protocol, models);
  print_contact(protocol, delay_s);
  const int index = participants - 1;
  const std::uint64_t seed =
      core::derived_seed(seed_from(options.seed, "--seed"), core::Purpose::participant,
                         static_cast<std::uint64_t>(index));
  const protocols::Group* const group = protocols::group_of(protocol, index);
  fmt::print("\nschedule of participant {} of a simulation with seed {}{}\n", participants,
             options.seed, group == nullptr ? "" : fmt::format(", in group {}", group->name));
  print_schedule(make_schedule(protocol, seed, index), options.shows_schedule);
  if (options.simulations > 0) {
    run_simulations(
        {options.protocol, participants, options.simulations, seed_from(options.seed, "--seed"),
         options.share.empty() ? Share{} : share_from(options.share)},
        protocol, options.out);
  }
}
}  // namespace

void add_check(CommandParser& line) {
  Command command = line.add("check", "Validate a study and show its design, models and schedule");
  const auto options = std::make_shared<CheckOptions>();
  command.shipped_file("protocol", options->protocol, "Study (YAML)");
  command.option("--participants", options->participants, participants_help);
  command.option_with_default("--seed", options->seed, "Seed of the schedule shown");
  command.shipped_file(
      "--rig", options->rig,
      "Check that this device reaches the tapping points; bound of its contact; modes that it "
      "does not render");
  command.option_with_default("--simulations", options->simulations,
                              "Simulate the study so often: power, and widths of intervals");
  command.option("--share", options->share,
                 "K/N: only the studies of share K of N; `merge` puts the shares together");
  command.option("--out", options->out, "With --share: its directory");
  command.flag("--schedule", options->shows_schedule, "All trials of the schedule shown");
  command.on_run([options] { run_check(*options); });
}
}  // namespace tapstudy::runner
