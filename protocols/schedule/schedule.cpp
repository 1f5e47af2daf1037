#include "protocols/schedule/schedule.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <sstream>
#include <utility>

#include "protocols/schedule/groups.hpp"
#include "protocols/schedule/ordering.hpp"
namespace tapstudy::protocols {
namespace {
// Blocks that stay together, as places in the protocol's list: a block with the practice that
// belongs to it and those that are mixed with it; practice that stays; a last one may be practice
// alone.
using Unit = std::vector<std::size_t>;

bool has_own_order(const Group* group) {
  return group != nullptr && !group->block_order.empty();
}

bool may_move(const Protocol& protocol, const Group* group, const Block& block) {
  const std::vector<std::string>& named =
      has_own_order(group) ? group->block_order : protocol.block_order.blocks;
  return !block.is_practice && !block.is_fixed &&
         (named.empty() || std::ranges::find(named, block.name) != named.end());
}

// A group's blocks in one of the sessions; where there are none of these, its name is empty.
struct Part {
  const Group* group{};
  std::string session;
};

std::vector<Part> parts_of(const Protocol& protocol, const Group* group) {
  std::vector<Part> parts;
  for (const PlannedSession& session : protocol.sessions) {
    parts.push_back({group, session.name});
  }
  return parts.empty() ? std::vector<Part>{{group, ""}} : parts;
}

// The unit with whose block this one is mixed; nullptr if there is none.
Unit* unit_led_alike(const Protocol& protocol, const Block& block, std::vector<Unit>& units) {
  const auto found = std::ranges::find_if(units, [&](const Unit& unit) {
    return !block.mixed_with.empty() && protocol.are_mixed(protocol.blocks[unit.back()], block);
  });
  return found == units.end() ? nullptr : &*found;
}

// Each of the part's with the practice before it.
std::vector<Unit> with_practice_before(const Protocol& protocol, const Part& part) {
  std::vector<Unit> units;
  bool is_new = true;
  for (std::size_t i = 0; i < protocol.blocks.size(); ++i) {
    const Block& block = protocol.blocks[i];
    if (!does(part.group, block) || block.session != part.session) {
      continue;
    }
    if (Unit* const mixed = unit_led_alike(protocol, block, units)) {
      mixed->push_back(i);
      continue;
    }
    if (is_new || block.is_fixed) {
      units.emplace_back();
    }
    units.back().push_back(i);
    is_new = !block.is_practice || block.is_fixed;
  }
  return units;
}

// The last block of those that stay together, or the one it is mixed with, says whether they move.
bool moves(const Protocol& protocol, const Group* group, const Unit& unit) {
  return may_move(protocol, group, protocol.leader(protocol.blocks[unit.back()]));
}

std::vector<Unit> units_of(const Protocol& protocol, const Part& part) {
  std::vector<Unit> units = with_practice_before(protocol, part);
  const auto is_practice = [&](std::size_t block) { return protocol.blocks[block].is_practice; };
  const bool has_each_its_own = std::ranges::all_of(units, [&](const Unit& unit) {
    return !moves(protocol, part.group, unit) || is_practice(unit.front());
  });
  if (units.empty() || has_each_its_own) {
    return units;
  }
  Unit& first = units.front();
  const auto end = std::ranges::find_if_not(first, is_practice);
  if (end != first.begin() && end != first.end()) {
    const Unit practice{first.begin(), end};
    first.erase(first.begin(), end);
    units.insert(units.begin(), practice);
  }
  return units;
}

// Those that exchange their places.
std::vector<std::size_t> moving(const Protocol& protocol, const Group* group,
                                const std::vector<Unit>& units) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < units.size(); ++i) {
    if (moves(protocol, group, units[i])) {
      found.push_back(i);
    }
  }
  return found;
}

// Whose order it is: the index is that within the participant's group.
struct Whose {
  std::uint64_t seed{};
  int index{};
};

void reorder(const Protocol& protocol, const Whose& whose, std::uint64_t session,
             std::vector<std::size_t>& places) {
  if (protocol.block_order.order == Order::shuffle) {
    core::Rng rng{core::derived_seed(whose.seed, core::Purpose::block_order, session)};
    rng.shuffle(places);
    return;
  }
  const int n = static_cast<int>(places.size());
  if (protocol.block_order.order == Order::listed || n < 2) {
    return;  // a group may do one alone of those that move
  }
  const std::uint64_t seed =
      core::derived_seed(protocol.counterbalancing_seed, core::Purpose::block_order);
  const std::vector<std::size_t> listed = places;
  const std::vector<int> row =
      williams_row(n, balanced_sequence(williams_rows(n), {whose.index, seed}));
  std::ranges::transform(row, places.begin(),
                         [&](int i) { return listed[static_cast<std::size_t>(i)]; });
}

// Each at the place that the group's own order gives it.
void put_in_own_order(const Protocol& protocol, const Group& group, const std::vector<Unit>& units,
                      std::vector<std::size_t>& places) {
  std::ranges::sort(places, {}, [&](std::size_t place) {
    const Block& last = protocol.leader(protocol.blocks[units[place].back()]);
    return std::ranges::find(group.block_order, last.name) - group.block_order.begin();
  });
}
}  // namespace

std::vector<std::size_t> block_sequence(const Protocol& protocol, std::uint64_t participant_seed,
                                        int order_index) {
  std::vector<std::size_t> sequence;
  const Whose whose{participant_seed, index_in_group(protocol, order_index)};
  std::uint64_t session = 0;
  for (const Part& part : parts_of(protocol, group_of(protocol, order_index))) {
    const std::vector<Unit> units = units_of(protocol, part);
    std::vector<const Unit*> ordered;
    std::ranges::transform(units, std::back_inserter(ordered),
                           [](const Unit& unit) { return &unit; });
    const std::vector<std::size_t> places = moving(protocol, part.group, units);
    std::vector<std::size_t> drawn = places;
    if (has_own_order(part.group)) {
      put_in_own_order(protocol, *part.group, units, drawn);
    } else {
      reorder(protocol, whose, session, drawn);
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
      ordered[places[i]] = &units[drawn[i]];
    }
    for (const Unit* unit : ordered) {
      sequence.insert(sequence.end(), unit->begin(), unit->end());
    }
    ++session;
  }
  return sequence;
}

int balanced_block_orders(const Protocol& protocol, const Group* group) {
  int orders = 1;
  for (const Part& part : parts_of(protocol, group)) {
    const std::size_t places = moving(protocol, group, units_of(protocol, part)).size();
    if (protocol.block_order.order == Order::williams && !has_own_order(group) && places > 1) {
      orders = std::lcm(orders, williams_rows(static_cast<int>(places)));
    }
  }
  return orders;
}

Schedule trials_of_session(const Schedule& schedule, const Protocol& protocol,
                           const std::string& session) {
  Schedule part;
  std::ranges::copy_if(schedule, std::back_inserter(part), [&](const PlannedTrial& trial) {
    return protocol.block(trial.block).session == session;
  });
  return part;
}

int planned_trials(const Block& block) {
  return block.repetitions * static_cast<int>(block.task->trials_per_repetition(block)) +
         (block.catch_trials ? block.catch_trials->count : 0);
}

Draw draw_of(std::uint64_t counterbalancing_seed, std::size_t block_index,
             std::uint64_t participant_seed, int index) {
  return {participant_seed, index, block_index, counterbalancing_seed,
          core::derived_seed(counterbalancing_seed, core::Purpose::catch_trials,
                             static_cast<std::uint64_t>(index))};
}

namespace {
// Those that are mixed with one another, in the protocol's order; most are alone.
std::vector<Unit> mixed_units(const Protocol& protocol, const std::vector<std::size_t>& sequence) {
  std::vector<Unit> mixed;
  for (const std::size_t i : sequence) {
    if (mixed.empty() ||
        !protocol.are_mixed(protocol.blocks[mixed.back().back()], protocol.blocks[i])) {
      mixed.emplace_back();
    }
    mixed.back().push_back(i);
  }
  std::ranges::for_each(mixed, [](Unit& unit) { std::ranges::sort(unit); });
  return mixed;
}

// Each order of the blocks' trials is equally likely in which those of a block keep their own.
Schedule mixed(std::vector<Schedule> of_blocks, std::uint64_t seed) {
  std::vector<std::size_t> turns;
  for (std::size_t i = 0; i < of_blocks.size(); ++i) {
    turns.insert(turns.end(), of_blocks[i].size(), i);
  }
  if (of_blocks.size() > 1) {
    core::Rng rng{seed};
    rng.shuffle(turns);
  }
  Schedule all;
  std::vector<std::size_t> next(of_blocks.size(), 0);
  for (const std::size_t i : turns) {
    all.push_back(std::move(of_blocks[i][next[i]++]));
  }
  return all;
}

Schedule scheduled(const Protocol& protocol, const std::vector<std::size_t>& sequence,
                   std::uint64_t participant_seed, int order_index) {
  Schedule schedule;
  const Group* const group = group_of(protocol, order_index);
  for (const Unit& unit : mixed_units(protocol, sequence)) {
    std::vector<Schedule> of_blocks;
    for (const std::size_t i : unit) {
      const Block block = block_of(group, protocol.blocks[i]);
      of_blocks.push_back(
          block.task->trials(block, draw_of(protocol.counterbalancing_seed, i, participant_seed,
                                            index_in_group(protocol, order_index))));
    }
    for (PlannedTrial& trial :
         mixed(std::move(of_blocks),
               core::derived_seed(participant_seed, core::Purpose::mixed_blocks, unit.front()))) {
      trial.number = static_cast<int>(schedule.size()) + 1;
      schedule.push_back(std::move(trial));
    }
  }
  return schedule;
}

// The number and the block that a line of described() begins with.
std::pair<int, std::string> number_and_block(const std::string& line) {
  std::istringstream words{line};
  int number = 0;
  std::string block;
  words >> number >> block;
  return {number, block};
}
}  // namespace

Schedule make_schedule(const Protocol& protocol, std::uint64_t participant_seed, int order_index) {
  return scheduled(protocol, block_sequence(protocol, participant_seed, order_index),
                   participant_seed, order_index);
}

std::map<std::string, int> first_trials(const std::string& planned_order) {
  std::map<std::string, int> first;
  std::istringstream lines{planned_order};
  for (std::string line; std::getline(lines, line);) {
    const auto [number, block] = number_and_block(line);
    first.emplace(block, number);
  }
  return first;
}

Schedule make_schedule(const Protocol& protocol, std::uint64_t participant_seed, int order_index,
                       const std::string& planned_order) {
  std::vector<std::pair<int, std::size_t>> places;  // by the first trial
  for (const auto& [name, number] : first_trials(planned_order)) {
    const auto block = std::ranges::find(protocol.blocks, name, &Block::name);
    if (block != protocol.blocks.end()) {
      places.emplace_back(number, static_cast<std::size_t>(block - protocol.blocks.begin()));
    }
  }
  std::ranges::sort(places);
  std::vector<std::size_t> sequence;
  std::ranges::transform(places, std::back_inserter(sequence),
                         &std::pair<int, std::size_t>::second);
  return scheduled(protocol, sequence, participant_seed, order_index);
}

namespace {
// "family at E = 2, family *": what a procedure will choose has a star.
std::vector<std::string> described(const std::vector<Alternative>& alternatives) {
  std::vector<std::string> words;
  for (const Alternative& alternative : alternatives) {
    words.push_back(alternative.stimulus);
    if (!alternative.values.empty()) {
      words.back() += " at " + protocols::described(alternative.values);
    } else if (alternative.is_comparison) {
      words.back() += " *";
    }
  }
  return words;
}
}  // namespace

std::string described(const Schedule& schedule) {
  std::string lines;
  for (const PlannedTrial& trial : schedule) {
    lines += fmt::format("{} {} {} {}{}{}\n", trial.number, trial.block, trial.repetition,
                         fmt::join(described(trial.alternatives), ","),
                         trial.is_practice ? " practice" : "", trial.is_catch ? " catch" : "");
  }
  return lines;
}
}  // namespace tapstudy::protocols
