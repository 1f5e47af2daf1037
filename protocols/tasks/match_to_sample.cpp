#include <fmt/format.h>

#include "protocols/tasks/sample_task.hpp"
#include "protocols/tasks/shared_keys.hpp"
#include "protocols/tasks/task.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
namespace {
// All choices of `size` of the places below `count`, each from low to high.
std::vector<std::vector<std::size_t>> subsets(std::size_t count, std::size_t size) {
  std::vector<std::vector<std::size_t>> all{{}};
  for (std::size_t taken = 0; taken < size; ++taken) {
    std::vector<std::vector<std::size_t>> longer;
    for (const std::vector<std::size_t>& subset : all) {
      for (std::size_t next = subset.empty() ? 0 : subset.back() + 1; next < count; ++next) {
        longer.push_back(subset);
        longer.back().push_back(next);
      }
    }
    all = std::move(longer);
  }
  return all;
}

// How many of these there are.
std::size_t subset_count(std::size_t count, std::size_t size) {
  std::size_t subsets = 1;
  for (std::size_t i = 0; i < size; ++i) {
    subsets = subsets * (count - i) / (i + 1);
  }
  return subsets;
}

// Several different stimuli and one of them again: which? (Skinner 1950)
class MatchToSample final : public SampleTask {
 public:
  std::string_view name() const override { return "match_to_sample"; }
  std::string_view statistic(const Block& /*block*/) const override { return "discrimination"; }
  // With two alternatives it is ABX; none is published for more.
  std::string_view decision_model(const Block& block) const override {
    return block.alternatives == 2 ? "abx_differencing" : "";
  }
  void read(MapReader& reader, const Protocol& /*protocol*/, Block& block) const override {
    block.alternatives = read_alternatives(reader, 2, 4, 3);
    reader.check_count("stimuli", block.stimuli, alternatives(block), max_stimuli,
                       fmt::format("a match to sample among {} alternatives needs at least as many "
                                   "stimuli",
                                   block.alternatives));
    if (block.stimuli.size() >= alternatives(block) && trials_per_repetition(block) > max_trials) {
      reader.reject("stimuli",
                    fmt::format("{} stimuli give {} trials in each repetition; at most "
                                "{} are allowed",
                                block.stimuli.size(), trials_per_repetition(block), max_trials));
    }
  }
  // Every choice of stimuli, with every one of them as the sample, at every place.
  std::size_t trials_per_repetition(const Block& block) const override {
    return subset_count(block.stimuli.size(), alternatives(block)) * alternatives(block) *
           alternatives(block);
  }
  std::vector<PlannedTrial> trials(const Block& block, const Draw& draw) const override {
    core::Rng rng{
        core::derived_seed(draw.participant_seed, core::Purpose::labels, draw.block_index)};
    return shuffled_repetitions(block, rng, [&](int repetition) {
      std::vector<PlannedTrial> part;
      for (const std::vector<std::size_t>& subset :
           subsets(block.stimuli.size(), alternatives(block))) {
        for (const std::size_t sample : subset) {
          for (std::size_t place = 0; place < subset.size(); ++place) {
            part.push_back({0, block.name, this, block.is_practice, repetition,
                            arranged(block, subset, sample, place, rng)});
          }
        }
      }
      return part;
    });
  }
  int visits(const Block& block, const SimulatedTapSettings& taps) const override {
    return taps.visits * (block.alternatives + 1);
  }

 protected:
  std::size_t alternatives(const Block& block) const override {
    return static_cast<std::size_t>(block.alternatives);
  }
  // Its trials are of as many stimuli as alternatives, not of two.
  std::vector<Layout> layouts(const Block& /*block*/) const override { return {}; }

 private:
  static constexpr std::size_t max_trials = 1000;

  // The sample's match at its place, the others in random order.
  static std::vector<Alternative> arranged(const Block& block,
                                           const std::vector<std::size_t>& subset,
                                           std::size_t sample, std::size_t place, core::Rng& rng) {
    std::vector<Alternative> alternatives;
    for (const std::size_t i : subset) {
      if (i != sample) {
        alternatives.push_back({block.stimuli[i]});
      }
    }
    rng.shuffle(alternatives);
    const Alternative match{block.stimuli[sample], {}, true};
    alternatives.insert(alternatives.begin() + static_cast<std::ptrdiff_t>(place), match);
    alternatives.push_back(match);
    return alternatives;
  }
};
}  // namespace

const Task& match_to_sample() {
  static const MatchToSample task;
  return task;
}
}  // namespace tapstudy::protocols
