#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <set>

#include "analysis/statistics/proportion.hpp"
#include "core/error.hpp"
#include "core/rng.hpp"
#include "device/hand/penalty_limit.hpp"
#include "protocols/ordering.hpp"
#include "protocols/read_protocol.hpp"
#include "protocols/schedule.hpp"
#include "runner/commands/commands.hpp"
#include "runner/commands/families.hpp"
#include "runner/commands/seed.hpp"
#include "runner/devices/device_kind.hpp"
#include "runner/devices/masking_noise.hpp"
#include "runner/devices/rigs.hpp"
#include "runner/session/session_row.hpp"
#include "runner/stimuli/model_library.hpp"
namespace tapstudy::runner {
namespace {
struct CheckOptions {
  std::string protocol;
  int participants{10};
  std::string seed{"1"};
  std::string rig;
};
constexpr double alpha = 0.05;

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
          "  warning: {} has overdamped modes, which Newmark may let alternate at half the rate "
          "(integrator: exact does not)\n",
          stimulus.name);
    }
  }
}

void print_models(const protocols::Protocol& protocol, ModelLibrary& models) {
  fmt::print("\nmodels\n");
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
        models.bodies_solved() > solved_before ? fmt::format("{:.3f} s", report.cost.total_s())
        : models.bodies_used() > used_before
            ? fmt::format("from the cache, where it took {:.3f} s", report.cost.total_s())
            : "scaled from the same body";
    fmt::print("  {}: {} {} tetrahedra, {} dof, {} modes below {} Hz, {}\n", stimulus.name,
               report.tets, report.order == 2 ? "quadratic" : "linear", report.dofs,
               plate->model.frequency_hz.size(), protocol.band_limit_hz, cost);
  }
  warn_of_overdamped_modes(protocol, models);
  if (models.bodies_used() == 0) {
    fmt::print("  none: no technique here vibrates\n");
  }
}

// The bound of a device that acts later than it is told is lower.
void print_contact(const protocols::Protocol& protocol, int delay_ticks) {
  const double asked = largest_penalty_n_per_m(protocol);
  core::HandBody hand = protocol.simulation.hand;
  const auto limit_of = [&](int delay) {
    return device::largest_stable_penalty_n_per_m(hand, protocol.rendering.dt_s, delay);
  };
  const double limit = limit_of(delay_ticks);
  fmt::print("\ncontact\n  penalty {} N/m; at {} Hz the simulated hand rests on up to {:.0f} N/m",
             asked, protocol.rate_hz, limit);
  if (delay_ticks > 0) {
    fmt::print(" with this device, whose force acts {} tick late\n", delay_ticks);
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

void warn_of_balance(const protocols::Block& block, int participants) {
  if (!block.task->uses_order()) {
    return;
  }
  const int conditions = static_cast<int>(protocols::conditions(block));
  if (conditions < 2) {
    return;
  }
  const int rows = protocols::williams_sequences(conditions, block.repetitions);
  if (block.order != protocols::Order::williams) {
    fmt::print(
        "    note: random orders balance only on average; order: williams balances {} "
        "stimuli, {} times each, over every {} participants\n",
        conditions, block.repetitions, rows);
  } else if (participants % rows != 0) {
    fmt::print("    warning: {} participants do not balance the {} orders (use a multiple of {})\n",
               participants, rows, rows);
  }
}

void print_power(const protocols::Protocol& protocol, const protocols::Block& block,
                 int participants) {
  const std::size_t options = block.task->answers(block, protocol).options.size();
  const double chance = 1.0 / static_cast<double>(options);
  const int answers = participants * block.task->counted_answers(block);
  const int critical = analysis::critical_successes(answers, chance, alpha);
  fmt::print(
      "    chance {:.0f} %; of {} answers {} must {} for p < .05 (one-sided, answers "
      "independent)\n",
      100.0 * chance, answers, critical, block.task->success());
  fmt::print("    power if the truth is");
  for (const double above : {0.1, 0.2, 0.3}) {
    fmt::print("{} {:.0f} %: {:.2f}", above > 0.15 ? "," : "", 100.0 * (chance + above),
               analysis::binomial_power(answers, chance, alpha, chance + above));
  }
  fmt::print("\n");
}

void print_procedures(const protocols::Comparison& comparison) {
  for (const auto& track : comparison.tracks) {
    const auto [low, high] = track->ranges().front();
    fmt::print("    at most {} trials of {}: {} against {:.6g}, from {:.6g} to {:.6g}\n",
               track->max_trials(), comparison.axis, comparison.is_below ? "below" : "above",
               comparison.standard, comparison.value_at(low), comparison.value_at(high));
  }
}

void print_design(const protocols::Protocol& protocol, int participants) {
  fmt::print("{}\n\n", protocol.title);
  double total_s = 0.0;
  for (const protocols::Block& block : protocol.blocks) {
    const int trials = planned_trials(block);
    const double seconds = trials * simulated_trial_s(protocol, block);
    total_s += seconds;
    fmt::print("  {}{}{}: {}, {}, {}{} trials a participant, about {:.0f} s of tapping\n",
               block.name, block.is_practice ? " (practice)" : "",
               block.presented == protocols::Presented::real_plates ? " (real plates)" : "",
               block.task->name(),
               block.stimuli.size() == 1 ? block.stimuli.front()
                                         : fmt::format("{} stimuli", block.stimuli.size()),
               block.comparison ? "at most " : "", trials, seconds);
    warn_of_balance(block, participants);
    if (block.comparison) {
      print_procedures(*block.comparison);
    } else if (block.task->has_chance_level()) {
      print_power(protocol, block, participants);
    }
  }
  fmt::print("\n  {} participants, {:.0f} min of tapping each\n", participants, total_s / 60.0);
}

void print_forms(const protocols::Protocol& protocol) {
  if (protocol.forms.empty()) {
    return;
  }
  fmt::print("\nquestionnaires\n");
  const auto print = [&](const std::vector<std::string>& names, const std::string& when) {
    for (const std::string& name : names) {
      const protocols::Form& form = protocol.forms.at(name);
      fmt::print("  {}: {} questions, {}\n", name, form.items.size(), when);
    }
  };
  print(protocol.forms_before, "before the first trial");
  for (const protocols::Block& block : protocol.blocks) {
    print(block.forms_after, fmt::format("after {}", block.name));
  }
  print(protocol.forms_after, "at the end");
}

void print_languages(const protocols::Protocol& protocol) {
  std::set<std::string> all;
  std::size_t in_one = 0;
  for (const auto& [path, languages] : protocol.translations.given) {
    all.insert(languages.begin(), languages.end());
    in_one += languages.empty() ? 1 : 0;
  }
  if (all.empty()) {
    return;
  }
  fmt::print("\nlanguages\n");
  for (const std::string& language : all) {
    const auto missing = texts_without(language, protocol.translations);
    fmt::print("  {}: {}\n", language,
               missing.empty() ? "complete" : fmt::format("lacks {}", fmt::join(missing, ", ")));
  }
  if (in_one > 0) {
    fmt::print("  texts given once for all of them: {}\n", in_one);
  }
}

void run_check(const CheckOptions& options) {
  const protocols::Protocol protocol = protocols::read_protocol(options.protocol);
  if (options.participants < 1 || options.participants > 10000) {
    throw core::InvalidInput{
        fmt::format("--participants: {} is not allowed (from 1 to 10000)", options.participants)};
  }
  int delay_ticks = 0;
  if (!options.rig.empty()) {
    const protocols::Rig rig = read_rig(options.rig);
    loop_settings(protocol, rig);
    check_fits(protocol, rig);
    delay_ticks = kind_of(rig).delay_ticks(rig);
  }
  print_design(protocol, options.participants);
  if (protocol.masking) {
    fmt::print("\nmasking\n  {}\n", described(*protocol.masking));
  }
  print_forms(protocol);
  print_languages(protocol);
  ModelLibrary models;
  print_models(protocol, models);
  print_families(protocol, models);
  print_contact(protocol, delay_ticks);
  const int index = options.participants - 1;
  const std::uint64_t seed =
      core::derived_seed(seed_from(options.seed, "--seed"), core::Purpose::participant,
                         static_cast<std::uint64_t>(index));
  fmt::print("\nschedule of participant {} of a simulation with seed {}\n", options.participants,
             options.seed);
  fmt::print("{}", protocols::described(make_schedule(protocol, seed, index)));
}
}  // namespace

void add_check(CommandParser& line) {
  Command command = line.add("check", "Validate a study and show its design, models and schedule");
  const auto options = std::make_shared<CheckOptions>();
  command.argument("protocol", options->protocol, "Study (YAML)");
  command.option_with_default("--participants", options->participants, "How many are planned");
  command.option_with_default("--seed", options->seed, "Seed of the schedule shown");
  command.option("--rig", options->rig,
                 "Check that this device reaches the tapping points; bound of its contact");
  command.on_run([options] { run_check(*options); });
}
}  // namespace tapstudy::runner
