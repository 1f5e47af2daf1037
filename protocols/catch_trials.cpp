#include "protocols/catch_trials.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "protocols/read_sections.hpp"
namespace tapstudy::protocols {
std::optional<CatchTrials> read_catch_trials(MapReader& reader, const Protocol& protocol,
                                             const Block& block) {
  std::optional<CatchTrials> found;
  reader.map("catch_trials", MapReader::Presence::optional, [&](MapReader& inner) {
    CatchTrials trials;
    trials.count = inner.integer("count", 1, 1000);
    inner.each_text(
        "expected", MapReader::Presence::required,
        [&](const std::string& stimulus, const std::string& answer) {
          const auto names = stimulus_names(protocol);
          if (std::ranges::find(names, stimulus) == names.end()) {
            inner.reject("expected", fmt::format("'{}' is no stimulus", stimulus));
          }
          if (std::ranges::find(block.responses, answer) == block.responses.end()) {
            inner.reject("expected", fmt::format("'{}' cannot be answered (one of: {})", answer,
                                                 fmt::join(block.responses, ", ")));
          }
          const auto right = block.right_response.find(stimulus);
          if (right != block.right_response.end() && right->second != answer) {
            inner.reject("expected", fmt::format("'{}' is presented in the block, where "
                                                 "'{}' is right",
                                                 stimulus, right->second));
          }
          trials.expected[stimulus] = answer;
        });
    if (trials.expected.empty()) {
      inner.reject("expected", "names no stimulus");
    }
    found = trials;
  });
  return found;
}

std::vector<PlannedTrial> with_catch_trials(std::vector<PlannedTrial> trials, const Block& block,
                                            const Draw& draw) {
  if (!block.catch_trials || block.catch_trials->expected.empty() || trials.empty()) {
    return trials;
  }
  core::Rng rng{core::derived_seed(draw.catch_seed, core::Purpose::catch_trials, draw.block_index)};
  std::vector<std::string> stimuli;
  for (const auto& [stimulus, answer] : block.catch_trials->expected) {
    stimuli.push_back(stimulus);
  }
  for (int i = 0; i < block.catch_trials->count; ++i) {
    PlannedTrial trial = trials.front();
    trial.repetition = i + 1;
    trial.alternatives = {{stimuli[static_cast<std::size_t>(i) % stimuli.size()]}};
    trial.is_catch = true;
    const auto place = 1 + rng.below(static_cast<std::uint32_t>(trials.size()));
    trials.insert(trials.begin() + place, trial);
  }
  return trials;
}
}  // namespace tapstudy::protocols
