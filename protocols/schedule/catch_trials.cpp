#include "protocols/schedule/catch_trials.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "protocols/reader/read_sections.hpp"
namespace tapstudy::protocols {
std::optional<CatchTrials> read_catch_trials(MapReader& reader, const Protocol& protocol,
                                             const Block& block) {
  std::optional<CatchTrials> found;
  reader.map({"catch_trials",
              "identification only: trials that show who attends, at random places, in no result; "
              "unset: none"},
             MapReader::Presence::optional, [&](MapReader& inner) {
               CatchTrials trials;
               trials.count = inner.integer({"count", "in the block"}, 1, 1000);
               inner.each_text(
                   {"expected", "by stimulus, which nobody should mistake"},
                   MapReader::Presence::at_least_one,
                   [&](const std::string& stimulus, const std::string& answer) {
                     const auto names = stimulus_names(protocol);
                     if (std::ranges::find(names, stimulus) == names.end()) {
                       inner.reject("expected", fmt::format("'{}' is not a stimulus", stimulus));
                     }
                     if (std::ranges::find(block.responses, answer) == block.responses.end()) {
                       inner.reject("expected",
                                    fmt::format("'{}' cannot be answered (one of: {})", answer,
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

std::vector<std::size_t> catch_places(const Block& block, const Draw& draw, std::size_t others) {
  std::vector<std::size_t> places;
  if (!block.catch_trials || block.catch_trials->expected.empty() || others == 0) {
    return places;
  }
  core::Rng rng{core::derived_seed(draw.catch_seed, core::Purpose::catch_trials, draw.block_index)};
  for (int i = 0; i < block.catch_trials->count; ++i) {
    places.push_back(1 + rng.below(static_cast<std::uint32_t>(others + places.size())));
  }
  return places;
}

std::vector<PlannedTrial> with_catch_trials(std::vector<PlannedTrial> trials, const Block& block,
                                            const Draw& draw) {
  int count = 0;
  for (const std::size_t place : catch_places(block, draw, trials.size())) {
    PlannedTrial trial = trials.front();
    const auto& expected = block.catch_trials->expected;
    trial.alternatives = {{std::next(expected.begin(), count % std::ssize(expected))->first}};
    trial.repetition = ++count;
    trial.is_catch = true;
    trials.insert(trials.begin() + static_cast<std::ptrdiff_t>(place), trial);
  }
  return trials;
}
}  // namespace tapstudy::protocols
