#include "analysis/statistics/population/serial_dependence.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/resampling/replicates.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
namespace tapstudy::analysis {
namespace {
void check(const AnswerSequence& sequence) {
  if (sequence.stimuli.size() != sequence.responses.size() ||
      sequence.right.size() != sequence.responses.size()) {
    throw core::InvalidInput{"a sequence has one answer for each stimulus"};
  }
}

// Counts of answers equal to the last answer, and of answers right for the last trial.
void add_counts(const AnswerSequence& sequence, const std::vector<std::size_t>& responses,
                std::vector<double>& counts) {
  for (std::size_t i = 1; i < responses.size(); ++i) {
    counts[0] += responses[i] == responses[i - 1] ? 1.0 : 0.0;
    counts[1] += responses[i] == sequence.right[i - 1] ? 1.0 : 0.0;
  }
}

using Trials = std::vector<std::vector<std::size_t>>;  // those of each stimulus
Trials trials_by_stimulus(const AnswerSequence& sequence) {
  std::map<std::size_t, std::vector<std::size_t>> by;
  for (std::size_t i = 0; i < sequence.stimuli.size(); ++i) {
    by[sequence.stimuli[i]].push_back(i);
  }
  Trials trials;
  for (auto& [stimulus, places] : by) {
    trials.push_back(std::move(places));
  }
  return trials;
}

std::vector<std::size_t> permuted(const AnswerSequence& sequence, const Trials& trials,
                                  core::Rng& rng) {
  std::vector<std::size_t> responses = sequence.responses;
  for (const auto& places : trials) {
    std::vector<std::size_t> of_stimulus;
    for (const std::size_t place : places) {
      of_stimulus.push_back(sequence.responses[place]);
    }
    rng.shuffle(of_stimulus);
    for (std::size_t i = 0; i < places.size(); ++i) {
      responses[places[i]] = of_stimulus[i];
    }
  }
  return responses;
}

// Shares of the responses to each stimulus of one participant.
class SharesOfResponses {
 public:
  explicit SharesOfResponses(const AnswerSequence& sequence)
      : counts_{Eigen::MatrixXd::Zero(codes(sequence.stimuli),
                                      std::max(codes(sequence.responses), codes(sequence.right)))} {
    for (std::size_t i = 0; i < sequence.stimuli.size(); ++i) {
      counts_(index(sequence.stimuli[i]), index(sequence.responses[i])) += 1.0;
    }
    trials_ = counts_.rowwise().sum();
    shares_ = trials_.cwiseMax(1.0).cwiseInverse().asDiagonal() * counts_;
    equal_ = shares_ * shares_.transpose();
    // of two trials of one stimulus the second has one answer less to be drawn from
    const Eigen::ArrayXd pairs = (trials_.array() * (trials_.array() - 1.0)).max(1.0);
    equal_.diagonal() =
        ((counts_.array() * (counts_.array() - 1.0)).rowwise().sum() / pairs).matrix();
  }
  double share(std::size_t stimulus, std::size_t response) const {
    return shares_(index(stimulus), index(response));
  }
  // The probability that two trials get the same response.
  double equal(std::size_t one, std::size_t other) const {
    return equal_(index(one), index(other));
  }

 private:
  static Eigen::Index index(std::size_t code) { return static_cast<Eigen::Index>(code); }
  static Eigen::Index codes(const std::vector<std::size_t>& all) {
    return all.empty() ? 0 : index(*std::ranges::max_element(all)) + 1;
  }
  Eigen::MatrixXd counts_;
  Eigen::VectorXd trials_;
  Eigen::MatrixXd shares_;
  Eigen::MatrixXd equal_;
};

// The means of add_counts over all permutations.
void add_expected(const AnswerSequence& sequence, std::vector<double>& expected) {
  const SharesOfResponses shares{sequence};
  for (std::size_t i = 1; i < sequence.stimuli.size(); ++i) {
    expected[0] += shares.equal(sequence.stimuli[i], sequence.stimuli[i - 1]);
    expected[1] += shares.share(sequence.stimuli[i], sequence.right[i - 1]);
  }
}

// The p of sums over very many trials: normal, with a known mean and the variance of the draws.
double spread_p(const std::vector<double>& distances, double observed) {
  double squares = 0.0;
  for (const double distance : distances) {
    squares += distance * distance;
  }
  const auto draws = static_cast<double>(distances.size());
  const double variance = squares / draws;
  return variance > 0.0 ? f_p(observed * observed / variance, 1.0, draws) : 1.0;  // t squared is F
}

// Counts that are equally far from the mean are so to the last bit.
SerialEffect effect_of(const std::vector<std::vector<double>>& drawn, std::size_t which,
                       double observed, double expected, int trials) {
  constexpr double rounding = 1e-9;
  std::vector<double> distances;
  for (const auto& counts : drawn) {
    distances.push_back(std::abs(counts[which] - expected) + rounding);
  }
  const double n = std::max(1.0, static_cast<double>(trials));
  const double distance = std::abs(observed - expected);
  const bool are_few = std::ssize(drawn) < fewest_draws_to_count;
  return {observed / n, expected / n,
          are_few ? spread_p(distances, distance) : monte_carlo_p(distances, distance), trials};
}
}  // namespace

SerialDependence serial_dependence(const std::vector<AnswerSequence>& participants, int draws,
                                   std::uint64_t seed, unsigned threads) {
  if (draws < 1) {
    throw core::InvalidInput{"a permutation test takes one draw or more"};
  }
  std::vector<Trials> trials;
  std::vector<double> observed(2, 0.0);
  std::vector<double> expected(2, 0.0);
  int following = 0;
  for (const AnswerSequence& sequence : participants) {
    check(sequence);
    trials.push_back(trials_by_stimulus(sequence));
    add_counts(sequence, sequence.responses, observed);
    add_expected(sequence, expected);
    following += std::max(0, static_cast<int>(sequence.responses.size()) - 1);
  }
  const auto drawn = replicated_vectors(
      draws,
      [&](std::uint64_t own_seed) {
        core::Rng rng{own_seed};
        std::vector<double> counts(2, 0.0);
        for (std::size_t i = 0; i < participants.size(); ++i) {
          add_counts(participants[i], permuted(participants[i], trials[i], rng), counts);
        }
        return counts;
      },
      seed, threads);
  return {effect_of(drawn, 0, observed[0], expected[0], following),
          effect_of(drawn, 1, observed[1], expected[1], following)};
}
}  // namespace tapstudy::analysis
