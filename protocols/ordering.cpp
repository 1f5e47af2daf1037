#include "protocols/ordering.hpp"

#include <algorithm>
#include <map>
#include <span>
namespace tapstudy::protocols {
namespace {
std::vector<OrderedStimulus> listed(const Block& block) {
  std::vector<OrderedStimulus> all;
  for (int repetition = 1; repetition <= block.repetitions; ++repetition) {
    for (const std::string& stimulus : block.stimuli) {
      all.push_back({stimulus, repetition});
    }
  }
  return all;
}

std::vector<OrderedStimulus> williams(const Block& block, int participant_index) {
  const int n = static_cast<int>(block.stimuli.size());
  std::vector<OrderedStimulus> all;
  for (int repetition = 1; repetition <= block.repetitions; ++repetition) {
    for (const int i : williams_row(n, participant_index + repetition - 1)) {
      all.push_back({block.stimuli.at(static_cast<std::size_t>(i)), repetition});
    }
  }
  return all;
}
}  // namespace

std::vector<OrderedStimulus> ordered_stimuli(const Block& block, core::Rng& rng,
                                             int participant_index) {
  if (block.order == Order::williams) {
    return williams(block, participant_index);
  }
  std::vector<OrderedStimulus> all = listed(block);
  if (block.order == Order::shuffle) {
    rng.shuffle(all);
    // by how often the stimulus has been presented, whatever its place in the list was
    std::map<std::string, int> seen;
    for (OrderedStimulus& next : all) {
      next.repetition = ++seen[next.stimulus];
    }
  }
  if (block.order == Order::shuffle_within_repetition) {
    const std::size_t size = block.stimuli.size();
    for (std::size_t first = 0; first < all.size(); first += size) {
      rng.shuffle(std::span{all}.subspan(first, size));
    }
  }
  return all;
}

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
}  // namespace tapstudy::protocols
