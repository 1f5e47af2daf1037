#include "runner/commands/check_design.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "analysis/report/confusion/chance_tests.hpp"
#include "analysis/report/document/wording.hpp"
#include "analysis/statistics/proportion.hpp"
#include "protocols/protocol.hpp"
#include "protocols/schedule/groups.hpp"
#include "protocols/schedule/ordering.hpp"
#include "protocols/schedule/schedule.hpp"
#include "results/traces/trace_codec.hpp"
#include "runner/commands/check_screens.hpp"
#include "runner/session/devices/masking_card.hpp"
#include "runner/session/engine/planned_sessions.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/studies/counted.hpp"
#include "runner/studies/study_summary.hpp"
namespace tapstudy::runner {
namespace {
constexpr double alpha = 0.05;

std::optional<int> first_not_multiple(const std::vector<int>& counts, int of) {
  const auto found = std::ranges::find_if(counts, [&](int count) { return count % of != 0; });
  return found == counts.end() ? std::nullopt : std::optional{*found};
}

// Of each group that does the block with these stimuli, as many participants as it has.
void warn_of_balance(const protocols::Block& block, const std::vector<int>& participants) {
  const int conditions = static_cast<int>(protocols::conditions(block));
  if (!block.task->uses_order() || conditions < 2) {
    return;
  }
  const int rows = protocols::williams_rows(conditions);
  const int sequences = protocols::williams_sequences(conditions, block.repetitions);
  if (block.order == protocols::Order::listed) {
    fmt::print("    note: the order is the same for every participant, and not balanced\n");
  } else if (block.order != protocols::Order::williams) {
    fmt::print(
        "    note: random orders balance only on average; order: williams balances {} stimuli over "
        "every {} participants\n",
        conditions, rows);
  } else if (const auto broken = first_not_multiple(participants, rows)) {
    fmt::print(
        "    warning: {} participants{} do not balance the {} orders (use a multiple of {})\n",
        *broken, participants.size() > 1 ? " of a group" : "", rows, rows);
  } else if (first_not_multiple(participants, sequences)) {
    fmt::print(
        "    note: balanced within each repetition; what follows what from one repetition to the "
        "next is with a multiple of {} participants\n",
        sequences);
  }
}

// Where one answer is right more often than others, accuracy alone says little.
void warn_of_unequal_answers(const protocols::Block& block) {
  const std::map<std::string, int> right = protocols::right_answers(block);
  const auto most = std::ranges::max_element(right, {}, [](const auto& of) { return of.second; });
  const auto stimuli = static_cast<double>(block.stimuli.size());
  if (!block.right_response.empty() &&
      most->second * std::ssize(right) > std::ssize(block.stimuli)) {
    fmt::print("    warning: always answering '{}' is right in {:.0f} %\n", most->first,
               100.0 * most->second / stimuli);
  }
}

// Of the report's test of accuracy, by so many in all groups; unset where it draws no order again.
std::optional<double> smallest_p(const protocols::Protocol& protocol, const protocols::Block& block,
                                 int in_all) {
  const analysis::StudyDesign study = design_of(protocol, results::Mode::simulated);
  const auto design = std::ranges::find(study.blocks, block.name, &analysis::BlockDesign::name);
  std::vector<analysis::Place> participants;
  for (int i = 0; i < in_all; ++i) {
    if (protocols::does(protocols::group_of(protocol, i), block)) {
      participants.push_back({i, i});
    }
  }
  return design == study.blocks.end() ? std::nullopt
                                      : analysis::smallest_chance_p(*design, participants);
}

// True, and warns, where the test's p has too few steps to say how many answers it needs.
bool warn_of_few_orders(const protocols::Protocol& protocol, const protocols::Block& block,
                        int in_all) {
  constexpr double too_large = alpha / 5.0;
  const double smallest = smallest_p(protocol, block, in_all).value_or(0.0);
  const bool is_declared = std::ranges::any_of(protocol.hypotheses, [&](const auto& of) {
    return of.block == block.name && of.claim == protocols::Claim::accuracy_above_chance;
  });
  const std::size_t family = is_declared ? protocol.hypotheses.size() : 1;
  const double adjusted = std::min(1.0, smallest * static_cast<double>(family));
  if (smallest <= too_large && adjusted <= alpha) {
    return false;
  }
  fmt::print(
      "    warning: even if all answers are right, the report's test against chance gives about "
      "{}{}: the order of so few can be drawn in few ways (more participants, or order: shuffle)\n",
      analysis::p_value(smallest),
      family > 1 ? fmt::format(", up to {:.2g} when adjusted for {} hypotheses", adjusted, family)
                 : "");
  return true;
}

// That are counted, of so many in all groups.
int answers_of_all(const protocols::Protocol& protocol, const protocols::Block& block, int in_all) {
  int answers = 0;
  for (int i = 0; i < in_all; ++i) {
    const protocols::Group* const group = protocols::group_of(protocol, i);
    answers += protocols::does(group, block)
                   ? block.task->counted_answers(protocols::block_of(group, block))
                   : 0;
  }
  return answers;
}

void print_power(const protocols::Protocol& protocol, const protocols::Block& block, int in_all) {
  const double chance = block.task->chance_level(block, protocol);
  if (warn_of_few_orders(protocol, block, in_all)) {
    fmt::print("    chance {:.0f} %\n", 100.0 * chance);
    return;
  }
  const int answers = answers_of_all(protocol, block, in_all);
  const int critical = analysis::critical_successes(answers, chance, alpha);
  fmt::print(
      "    chance {:.0f} %; of {} answers {} must {} for p < .05 (one-sided, as if all answers "
      "were independent: the report draws the order again, and needs more where people have "
      "habits, "
      "are few or differ)\n",
      100.0 * chance, answers, critical, block.task->success());
  fmt::print("    power of that test if the truth is");
  for (const double above : {0.1, 0.2, 0.3}) {
    fmt::print("{} {:.0f} %: {:.2f}", above > 0.15 ? "," : "", 100.0 * (chance + above),
               analysis::binomial_power(answers, chance, alpha, chance + above));
  }
  fmt::print("\n");
}

// A procedure that takes guesses for discrimination chooses levels that are too low.
void warn_of_guess_rate(const protocols::TrackSettings& track, double of_task) {
  constexpr double rounding = 1e-3;  // of one third, written with three digits
  const auto rates = track.guess_rates();
  if (rates && (of_task < rates->first - rounding || of_task > rates->second + rounding)) {
    fmt::print("    warning: the procedure's guess rate is {}, by chance {:.3g} is right\n",
               rates->first == rates->second
                   ? fmt::format("{:.3g}", rates->first)
                   : fmt::format("{:.3g} to {:.3g}", rates->first, rates->second),
               of_task);
  }
}

const char* describe_side(protocols::Side side) {
  switch (side) {
    case protocols::Side::above:
      return "above";
    case protocols::Side::below:
      return "below";
    case protocols::Side::either:
      break;
  }
  return "on either side";
}

// A staircase steps from what it asked for: where few values are built, its estimate says little.
void warn_of_coarse_table(const protocols::Stimulus& family,
                          const protocols::Comparison& comparison,
                          const protocols::TrackSettings& track) {
  constexpr std::ptrdiff_t enough = 8;
  const auto range = std::ranges::find(family.vary, comparison.axis,
                                       [](const auto& of) { return std::string{of.axis->name}; });
  if (range == family.vary.end() || range->table.empty() || !track.settles_at()) {
    return;
  }
  const auto [low, high] = track.ranges().front();
  const double one = comparison.value_at(low);
  const double other = comparison.value_at(high);
  const double rounding = 1e-9 * std::max(std::abs(one), std::abs(other));
  const auto built = std::ranges::count_if(range->table, [&](double value) {
    return std::min(one, other) - rounding <= value && value <= std::max(one, other) + rounding;
  });
  if (built < enough) {
    fmt::print(
        "    warning: {} values of {} are built between its limits: its estimate is off by up to "
        "half of their distance\n",
        built, comparison.axis);
  }
}

// guess_rate: unset where participants set their own.
void print_procedures(const protocols::Stimulus& family, const protocols::Comparison& comparison,
                      std::optional<double> guess_rate) {
  for (const auto& track : comparison.tracks) {
    const auto [low, high] = track->ranges().front();
    fmt::print("    {}{} of {}: {} against {:.6g}, from {:.6g} to {:.6g}\n",
               track->may_end_early() ? "at most " : "", counted(track->max_trials(), "trial"),
               comparison.axis, describe_side(comparison.side), comparison.standard,
               comparison.value_at(low), comparison.value_at(high));
    for (std::size_t i = 0; i < comparison.further_axes.size(); ++i) {
      const auto [least, greatest] = track->ranges().at(i + 1);
      fmt::print("      each at one of several {}, from {:.6g} to {:.6g}\n",
                 comparison.further_axes[i], least, greatest);
    }
    warn_of_coarse_table(family, comparison, *track);
    const bool starts_from_0 = comparison.side == protocols::Side::either;
    if (guess_rate) {
      warn_of_guess_rate(*track, starts_from_0 ? 0.0 : *guess_rate);
    }
  }
}

long minutes(double seconds) {
  return std::lround(seconds / 60.0);
}

// "material: identification, 4 stimuli, 8 trials a participant"
std::string heading(const protocols::Block& block, const BlockLength& length) {
  return fmt::format(
      "{}{}{}{}: {}, {}, {} a participant", block.name, block.is_practice ? " (practice)" : "",
      block.presented == protocols::Presented::real_plates ? " (real plates)" : "",
      block.mixed_with.empty() ? "" : fmt::format(" (mixed with '{}')", block.mixed_with),
      block.task->name(),
      block.stimuli.size() == 1 ? block.stimuli.front()
                                : fmt::format("{} stimuli", block.stimuli.size()),
      describe_length(block, length));
}

using BlockOrderDealt = std::vector<std::size_t>;  // places in the protocol's list

// All balanced orders; of random ones, those of many participants.
std::set<BlockOrderDealt> dealt_orders(const protocols::Protocol& protocol) {
  constexpr int random_orders = 200;
  const bool is_random = protocol.block_order.order == protocols::Order::shuffle;
  const std::vector<const protocols::Group*> groups = protocols::groups_of(protocol);
  int count = is_random ? random_orders : 1;
  for (const protocols::Group* const group : groups) {
    count = std::max(count, protocols::balanced_block_orders(protocol, group));
  }
  count *= static_cast<int>(groups.size());
  std::set<BlockOrderDealt> orders;
  for (int i = 0; i < count; ++i) {
    orders.insert(protocols::block_sequence(protocol, static_cast<std::uint64_t>(i), i));
  }
  return orders;
}

bool counted_trials_precede(std::size_t practice, const BlockOrderDealt& order,
                            const protocols::Protocol& protocol) {
  const auto at = std::ranges::find(order, practice);
  return at != order.end() && std::any_of(order.begin(), at, [&](std::size_t i) {
           return !protocol.blocks[i].is_practice;
         });
}

std::string described_order(const BlockOrderDealt& order, const protocols::Protocol& protocol) {
  std::vector<std::string> names;
  for (const std::size_t i : order) {
    const protocols::Block& block = protocol.blocks[i];
    names.push_back(block.name + (block.is_practice ? " (practice)" : ""));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

bool have_own_orders(const protocols::Protocol& protocol) {
  return std::ranges::any_of(protocol.groups,
                             [](const auto& group) { return !group.block_order.empty(); });
}

// Who practises after counted trials learnt in trials that count.
void print_orders_of_practice(const protocols::Protocol& protocol) {
  if ((protocol.block_order.order == protocols::Order::listed && !have_own_orders(protocol)) ||
      std::ranges::none_of(protocol.blocks, &protocols::Block::is_practice)) {
    return;
  }
  constexpr std::size_t max_printed = 12;
  const std::set<BlockOrderDealt> orders = dealt_orders(protocol);
  std::size_t printed = 0;
  for (const BlockOrderDealt& order : orders) {
    if (printed++ < max_printed) {
      fmt::print("  order of blocks: {}\n", described_order(order, protocol));
    }
  }
  if (orders.size() > max_printed) {
    fmt::print("  and {} orders more\n", orders.size() - max_printed);
  }
  for (std::size_t i = 0; i < protocol.blocks.size(); ++i) {
    const auto late = std::ranges::count_if(orders, [&](const BlockOrderDealt& order) {
      return counted_trials_precede(i, order, protocol);
    });
    if (protocol.blocks[i].is_practice && late > 0) {
      fmt::print(
          "  warning: counted trials come before practice '{}' in {} of {} orders of the blocks "
          "(put it first, for all of them, or give each block its own)\n",
          protocol.blocks[i].name, late, orders.size());
    }
  }
}

void warn_of_block_order(const protocols::Protocol& protocol, int participants) {
  print_orders_of_practice(protocol);
  for (const protocols::Group* const group : protocols::groups_of(protocol)) {
    const int orders = protocols::balanced_block_orders(protocol, group);
    const int members = protocols::members(protocol, group, participants);
    if (members % orders != 0) {
      fmt::print(
          "  warning: {} participants{} do not balance the {} orders of the blocks (use a multiple "
          "of {})\n",
          members, group == nullptr ? "" : fmt::format(" in group '{}'", group->name), orders,
          orders);
    }
  }
  if (protocol.block_order.order != protocols::Order::listed) {
    return;
  }
  // blocks exchange their places within a session, of those who do both
  const auto is_fixed = [](const protocols::Block& block) {
    return block.is_practice || block.is_fixed || !block.mixed_with.empty();
  };
  const bool are_confounded =
      std::ranges::any_of(protocols::groups_of(protocol), [&](const protocols::Group* const group) {
        std::set<std::pair<const protocols::Task*, std::string>> known;
        const bool has_own_order = group != nullptr && !group->block_order.empty();
        return !has_own_order && std::ranges::any_of(protocol.blocks, [&](const auto& block) {
          return protocols::does(group, block) && !is_fixed(block) &&
                 !known.emplace(block.task, block.session).second;
        });
      });
  if (are_confounded) {
    fmt::print(
        "  note: blocks come in the file's order for every participant{}: what distinguishes two "
        "of "
        "one task is confounded with practice and fatigue (block_order: {{order: williams}} "
        "balances it)\n",
        have_own_orders(protocol) ? " of groups without an order of their own" : "");
  }
}

// How many participants there are in each group that does the block, by the stimuli that it is
// presented; of all where there are no groups.
std::map<std::vector<std::string>, std::vector<int>> members_by_stimuli(
    const protocols::Block& block, const protocols::Protocol& protocol, int participants) {
  std::map<std::vector<std::string>, std::vector<int>> counts;
  for (const protocols::Group* const group : protocols::groups_of(protocol)) {
    if (protocols::does(group, block)) {
      counts[protocols::block_of(group, block).stimuli].push_back(
          protocols::members(protocol, group, participants));
    }
  }
  return counts;
}

void warn_of_design(const protocols::Block& block, const protocols::Protocol& protocol,
                    int participants) {
  const auto members = members_by_stimuli(block, protocol, participants);
  for (const auto& [stimuli, counts] : members) {
    protocols::Block own = block;
    own.stimuli = stimuli;
    if (members.size() > 1) {
      fmt::print("    of those who are presented {}:\n", fmt::join(stimuli, ", "));
    }
    warn_of_balance(own, counts);
    if (!block.comparison && block.task->has_chance_level()) {
      warn_of_unequal_answers(own);
    }
  }
}

void print_blocks(const protocols::Protocol& protocol, const BlockLengths& lengths,
                  int participants) {
  fmt::print("{}\n\n", protocol.title);
  for (const protocols::Block& block : protocol.blocks) {
    const BlockLength& length = lengths.at(block.name);
    fmt::print("  {}, about {:.0f} s of tapping\n", heading(block, length),
               length.usual * simulated_trial_s(protocol, block));
    if (std::ranges::any_of(protocol.groups, [&](const auto& group) {
          return group.stimuli.contains(block.name);
        })) {
      fmt::print("    note: groups are presented their own of these stimuli, as listed below\n");
    }
    if (block.presented_if) {
      fmt::print(
          "    note: only for those who answer {}; lengths, balance and power are those of all\n",
          describe(*block.presented_if));
    }
    if (block.is_practice) {
      continue;  // in no result
    }
    warn_of_design(block, protocol, participants);
    if (block.comparison) {
      print_procedures(protocol.stimulus(block.stimuli.front()), *block.comparison,
                       block.task->has_own_guess_rate()
                           ? std::nullopt
                           : std::optional{block.task->guess_rate(block, protocol)});
    } else if (block.task->has_chance_level()) {
      print_power(protocol, block, participants);
    }
  }
}

// What a session asks of a participant, roughly.
struct Session {
  int trials{};
  double tapped_s{};
  double recorded_s{};
  double screens_s{};
};
Session session_of(const protocols::Group* group, const protocols::Protocol& protocol,
                   const BlockLengths& of_all) {
  const BlockLengths lengths = lengths_for(group, protocol, of_all);
  Session session{.screens_s = seconds_of_screens(protocol, group, lengths)};
  for (const protocols::Block& block : protocol.blocks) {
    if (protocols::does(group, block)) {
      const int trials = lengths.at(block.name).usual;
      const double seconds = trials * simulated_trial_s(protocol, block);
      session.trials += trials;
      session.tapped_s += seconds;
      session.recorded_s += block.presented == protocols::Presented::real_plates ? 0.0 : seconds;
    }
  }
  return session;
}

// "; in the order b, a; of test: mdf_two, mdf_three"
std::string described_differences(const protocols::Group& group) {
  std::string words = group.block_order.empty()
                          ? ""
                          : fmt::format("; in the order {}", fmt::join(group.block_order, ", "));
  for (const auto& [block, stimuli] : group.stimuli) {
    words += fmt::format("; of {}: {}", block, fmt::join(stimuli, ", "));
  }
  return words;
}

// "group trained (with training): practice, training, test; about 40 trials; 5 of 10"
std::string described_group(const protocols::Group& group, const Session& session, int members,
                            int participants) {
  return fmt::format("group {}{}: {}{}; {}; {} of {}", group.name,
                     group.label == group.name ? "" : fmt::format(" ({})", group.label),
                     fmt::join(group.blocks, ", "), described_differences(group),
                     counted(static_cast<std::size_t>(session.trials), "trial"), members,
                     participants);
}

double stored_bytes_per_s(const protocols::Protocol& protocol, double actuator_rate_hz) {
  const bool has_samples = protocol.rendering.crossover && protocol.stores_actuator;
  return results::usual_bytes_per_tick * protocol.rate_hz +
         (has_samples ? results::usual_bytes_per_actuator_sample * actuator_rate_hz : 0.0);
}

void print_sessions(const protocols::Protocol& protocol, const BlockLengths& lengths,
                    int participants, double bytes_per_s) {
  fmt::print("\n");
  double recorded_s = 0.0;
  for (const protocols::Group* const group : protocols::groups_of(protocol)) {
    const Session session = session_of(group, protocol, lengths);
    const int members = protocols::members(protocol, group, participants);
    recorded_s += session.recorded_s * members;
    fmt::print("  {} participants, about {} min each{}: {} of tapping, {} for the screens below\n",
               group == nullptr ? std::to_string(participants)
                                : described_group(*group, session, members, participants),
               minutes(session.tapped_s) + minutes(session.screens_s),
               protocol.sessions.empty() ? "" : " in all sessions", minutes(session.tapped_s),
               minutes(session.screens_s));
  }
  const auto groups = static_cast<int>(std::max<std::size_t>(protocol.groups.size(), 1));
  if (participants % groups != 0) {
    fmt::print("  warning: {} participants are not as many in each of {} groups\n", participants,
               groups);
  }
  fmt::print("  about {:.0f} MB of disk for all, if they tap no longer than simulated ones\n",
             1e-6 * bytes_per_s * recorded_s);
}

void print_planned_sessions(const protocols::Protocol& protocol) {
  for (const protocols::PlannedSession& session : protocol.sessions) {
    const std::string interval = described_interval(session);
    fmt::print("  session {}{}: {}\n", session.name,
               interval.empty() ? "" : ", " + interval + " after the one before began",
               fmt::join(session.blocks, ", "));
  }
}

void print_languages(const protocols::Protocol& protocol) {
  const std::set<std::string> all = protocols::languages_of(protocol.translations);
  const auto in_one = std::ranges::count_if(protocol.translations.given,
                                            [](const auto& text) { return text.second.empty(); });
  if (all.empty()) {
    return;
  }
  fmt::print("\nlanguages\n");
  for (const std::string& language : all) {
    const auto missing = texts_without(language, protocol.translations);
    fmt::print("  {}: {}\n", language,
               !missing.empty() ? fmt::format("lacks {}", fmt::join(missing, ", "))
               : in_one == 0    ? "complete"
                                : fmt::format("all but {} given once for all languages",
                                              counted(static_cast<std::size_t>(in_one), "text")));
  }
}
}  // namespace

void print_design(const protocols::Protocol& protocol, int participants, double actuator_rate_hz) {
  if (protocol.blocks.empty()) {
    fmt::print("{}\n\n  no blocks, so no session: for tap, modes and trade\n", protocol.title);
    return;
  }
  const BlockLengths lengths = lengths_of(protocol);
  print_blocks(protocol, lengths, participants);
  print_sessions(protocol, lengths, participants, stored_bytes_per_s(protocol, actuator_rate_hz));
  print_planned_sessions(protocol);
  warn_of_block_order(protocol, participants);
  if (protocol.masking) {
    fmt::print("\nmasking\n  {} in every trial; {}\n", described(*protocol.masking),
               protocol.masking->is_required ? "required" : "a session without a card is warned");
  }
  print_screens(protocol, lengths);
  print_languages(protocol);
}
}  // namespace tapstudy::runner
