#include "analysis/statistics/permutation_test.hpp"

#include "core/rng.hpp"
namespace tapstudy::analysis {
namespace {
int correct(const Answers& answers) {
  int count = 0;
  for (std::size_t i = 0; i < answers.stimuli.size(); ++i) {
    count += answers.stimuli[i] == answers.responses[i] ? 1 : 0;
  }
  return count;
}

int correct(const std::vector<Answers>& participants) {
  int count = 0;
  for (const Answers& answers : participants) {
    count += correct(answers);
  }
  return count;
}
}  // namespace

double permutation_p(const std::vector<Answers>& participants, int shuffles, std::uint64_t seed) {
  core::Rng rng{seed};
  const int observed = correct(participants);
  std::vector<Answers> shuffled = participants;
  int as_good = 0;
  for (int round = 0; round < shuffles; ++round) {
    for (Answers& answers : shuffled) {
      rng.shuffle(answers.responses);
    }
    as_good += correct(shuffled) >= observed ? 1 : 0;
  }
  return (1.0 + as_good) / (shuffles + 1.0);
}
}  // namespace tapstudy::analysis
