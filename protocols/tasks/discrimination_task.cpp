#include "protocols/tasks/discrimination_task.hpp"

#include "protocols/read_sections.hpp"
namespace tapstudy::protocols {
namespace {
// Of each way to present a trial, in a run of trials that is shuffled as a whole.
constexpr std::size_t times_in_run = 4;

std::size_t observations(const Comparison& comparison) {
  std::size_t count = 0;
  for (const auto& track : comparison.tracks) {
    count += track->max_trials();
  }
  return count;
}
}  // namespace

void DiscriminationTask::read(MapReader& reader, const Protocol& protocol, Block& block) const {
  if (reader.has("procedures")) {
    block.comparison = read_comparison(reader, protocol, block, sides());
    if (reader.has("repetitions")) {
      reader.reject("repetitions", "is what the procedures make it");
    }
  } else if (block.stimuli.size() < 2) {
    reader.reject("stimuli",
                  "one stimulus is compared with itself only along an axis: give "
                  "procedures, or at least two stimuli");
  }
}

std::size_t DiscriminationTask::trials_per_repetition(const Block& block) const {
  if (block.comparison) {
    const auto trials = observations(*block.comparison) *
                        static_cast<std::size_t>(1 + empty_trials_per_observation());
    if (empty_trials_per_observation() == 0) {
      return trials;
    }
    // only whole runs hold as many observations as they should
    const std::size_t run = times_in_run * layouts(block).size();
    return (trials + run - 1) / run * run;
  }
  return pairs_of(block.stimuli.size()).size() * layouts(block).size();
}

int DiscriminationTask::visits(const Block& block, const SimulatedTapSettings& taps) const {
  return taps.visits * static_cast<int>(layouts(block).front().size());
}

// The comparison's value is chosen when its trial comes. Shuffled within runs, because procedures
// may end at any trial; runs are long enough that nobody foresees how one ends.
std::vector<PlannedTrial> DiscriminationTask::of_family(const Block& block, core::Rng& rng) const {
  const Comparison& comparison = *block.comparison;
  const Alternative standard{block.stimuli.front(), {{comparison.axis, comparison.standard}}};
  const Alternative varied{block.stimuli.front(), {}, true};
  std::vector<Layout> run;
  for (const Layout& way : layouts(block)) {
    run.insert(run.end(), times_in_run, way);
  }
  std::vector<PlannedTrial> all;
  for (std::size_t i = 0; i < trials_per_repetition(block); ++i) {
    if (i % run.size() == 0) {
      rng.shuffle(run);
    }
    PlannedTrial trial{0, block.name, this, block.is_practice, 1, {}};
    for (const bool is_comparison : run[i % run.size()]) {
      trial.alternatives.push_back(is_comparison ? varied : standard);
    }
    all.push_back(std::move(trial));
  }
  return all;
}

// Every pair in every way once in each repetition, in random order.
std::vector<PlannedTrial> DiscriminationTask::of_pairs(const Block& block, core::Rng& rng) const {
  return shuffled_repetitions(block, rng, [&](int repetition) {
    std::vector<PlannedTrial> part;
    for (const auto& [standard, comparison] : pairs_of(block.stimuli.size())) {
      for (const Layout& way : layouts(block)) {
        PlannedTrial trial{0, block.name, this, block.is_practice, repetition, {}};
        for (const bool is_comparison : way) {
          trial.alternatives.push_back(
              {block.stimuli[is_comparison ? comparison : standard], {}, is_comparison});
        }
        part.push_back(std::move(trial));
      }
    }
    return part;
  });
}

std::vector<PlannedTrial> DiscriminationTask::trials(const Block& block, const Draw& draw) const {
  core::Rng rng{core::derived_seed(draw.participant_seed, core::Purpose::labels, draw.block_index)};
  return block.comparison ? of_family(block, rng) : of_pairs(block, rng);
}
}  // namespace tapstudy::protocols
