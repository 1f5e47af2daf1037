#include "analysis/statistics/permutation_test.hpp"

#include "core/rng.hpp"
namespace tapstudy::analysis {
namespace {
int correct(const std::vector<int>& stimuli, const std::vector<int>& responses) {
  int count = 0;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    count += stimuli.at(i) == responses[i] ? 1 : 0;
  }
  return count;
}
}  // namespace

PermutationResult permutation_test(const std::vector<Answers>& participants, const Redraw& redraw,
                                   int draws, std::uint64_t seed) {
  int observed = 0;
  for (const Answers& answers : participants) {
    observed += correct(answers.stimuli, answers.responses);
  }
  PermutationResult result{0.0, 0, draws};
  for (int draw = 0; draw < draws; ++draw) {
    const std::uint64_t drawn =
        core::derived_seed(seed, core::Purpose::schedule, static_cast<std::uint64_t>(draw));
    int count = 0;
    for (std::size_t i = 0; i < participants.size(); ++i) {
      count += correct(redraw(i, drawn), participants[i].responses);
    }
    result.as_good += count >= observed ? 1 : 0;
  }
  result.p = (1.0 + result.as_good) / (draws + 1.0);
  return result;
}
}  // namespace tapstudy::analysis
