#include "protocols/schedule.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

#include "core/rng.hpp"
namespace tapstudy::protocols {
namespace {
struct Presentation {
  std::string stimulus;
  int repetition;
};

std::vector<Presentation> listed(const Block& block) {
  std::vector<Presentation> presentations;
  for (int repetition = 1; repetition <= block.repetitions; ++repetition) {
    for (const std::string& stimulus : block.stimuli) {
      presentations.push_back({stimulus, repetition});
    }
  }
  return presentations;
}

std::vector<Presentation> williams(const Block& block, int participant_index) {
  const int n = static_cast<int>(block.stimuli.size());
  std::vector<Presentation> presentations;
  for (int repetition = 1; repetition <= block.repetitions; ++repetition) {
    for (const int i : williams_row(n, participant_index + repetition - 1)) {
      presentations.push_back({block.stimuli.at(static_cast<std::size_t>(i)), repetition});
    }
  }
  return presentations;
}

std::vector<Presentation> ordered(const Block& block, core::Rng& rng, int participant_index) {
  if (block.order == Order::williams) {
    return williams(block, participant_index);
  }
  std::vector<Presentation> presentations = listed(block);
  if (block.order == Order::shuffle) {
    rng.shuffle(presentations);
    // a presentation's repetition is the how-manieth time its stimulus is presented
    std::map<std::string, int> seen;
    for (Presentation& presentation : presentations) {
      presentation.repetition = ++seen[presentation.stimulus];
    }
  }
  if (block.order == Order::shuffle_within_repetition) {
    const std::size_t size = block.stimuli.size();
    for (std::size_t first = 0; first < presentations.size(); first += size) {
      rng.shuffle(std::span{presentations}.subspan(first, size));
    }
  }
  return presentations;
}

PlannedTrial trial_of(const Block& block, int number, int repetition,
                      std::vector<std::string> stimuli) {
  return {number, block.name, block.task, block.is_practice, repetition, std::move(stimuli)};
}
}  // namespace

std::vector<int> williams_row(int n, int row) {
  const int shift = row % n;
  std::vector<int> conditions;
  for (int place = 0; place < n; ++place) {
    const int zigzag = place % 2 == 1 ? (place + 1) / 2 : n - place / 2;
    conditions.push_back((zigzag + shift) % n);
  }
  const bool is_mirrored = row % williams_rows(n) >= n;
  if (is_mirrored) {
    std::ranges::reverse(conditions);
  }
  return conditions;
}

int williams_rows(int n) {
  return n % 2 == 0 ? n : 2 * n;
}

Schedule make_schedule(const Protocol& protocol, std::uint64_t participant_seed,
                       int participant_index) {
  Schedule schedule;
  for (std::size_t i = 0; i < protocol.blocks.size(); ++i) {
    const Block& block = protocol.blocks[i];
    core::Rng rng{core::derived_seed(
        participant_seed,
        block.task == Task::choice ? core::Purpose::labels : core::Purpose::schedule, i)};
    const auto next_number = [&] { return static_cast<int>(schedule.size()) + 1; };
    if (block.task == Task::choice) {
      std::vector<std::string> alternatives = block.stimuli;
      rng.shuffle(alternatives);
      for (int repetition = 1; repetition <= block.repetitions; ++repetition) {
        schedule.push_back(trial_of(block, next_number(), repetition, alternatives));
      }
      continue;
    }
    for (const Presentation& presentation : ordered(block, rng, participant_index)) {
      schedule.push_back(
          trial_of(block, next_number(), presentation.repetition, {presentation.stimulus}));
    }
  }
  return schedule;
}

std::string described(const Schedule& schedule) {
  std::string lines;
  for (const PlannedTrial& trial : schedule) {
    lines += fmt::format("{} {} {} {}{}\n", trial.number, trial.block, trial.repetition,
                         fmt::join(trial.stimuli, ","), trial.is_practice ? " practice" : "");
  }
  return lines;
}

std::string blind_label(std::size_t position) {
  return {static_cast<char>('A' + static_cast<char>(position))};
}
}  // namespace tapstudy::protocols
