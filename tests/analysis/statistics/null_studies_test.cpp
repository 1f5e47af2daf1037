// Each test and interval over a thousand studies of which its hypothesis is true.
#include <algorithm>
#include <cmath>
#include <functional>

#include "analysis/report/blocks/discrimination.hpp"
#include "analysis/statistics/contingency/agreement.hpp"
#include "analysis/statistics/contingency/similarity.hpp"
#include "analysis/statistics/friedman_test.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/psychometric/inference.hpp"
#include "analysis/statistics/rank_tests.hpp"
#include "core/random/rng.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using core::Rng;

namespace {
constexpr int studies = 1000;
constexpr std::size_t classes = 4;
using Shares = std::vector<double>;
using Study = std::function<double(Rng& rng)>;  // its p

std::size_t drawn(const Shares& shares, Rng& rng) {
  double left = rng.uniform();
  std::size_t place = 0;
  while (place + 1 < shares.size() && (left -= shares[place]) >= 0.0) {
    ++place;
  }
  return place;
}

// Independent answers: cells by their probabilities, row after row.
CountTable table_of(const Shares& cells, int answers, Rng& rng) {
  CountTable table(classes, std::vector<std::int64_t>(classes, 0));
  for (int i = 0; i < answers; ++i) {
    const std::size_t cell = drawn(cells, rng);
    ++table[cell / classes][cell % classes];
  }
  return table;
}

// Of stimuli that are presented unequally often, as fixed by a protocol: j is the answer to i as
// often as i to j.
CountTable symmetric_answers(Rng& rng) {
  CountTable table(classes, std::vector<std::int64_t>(classes, 0));
  for (std::size_t i = 0; i < classes; ++i) {
    Shares answers(classes, 1.0);
    for (std::size_t j = 0; j < classes; ++j) {
      if (j != i) {
        answers[j] = 0.05 + 0.03 * static_cast<double>(i + j);
        answers[i] -= answers[j];
      }
    }
    for (std::size_t trial = 0; trial < 300 * (1 + i); ++trial) {
      ++table[i][drawn(answers, rng)];
    }
  }
  return table;
}

Shares cells_of(const std::function<double(std::size_t row, std::size_t column)>& weight) {
  Shares cells;
  double sum = 0.0;
  for (std::size_t cell = 0; cell < classes * classes; ++cell) {
    cells.push_back(weight(cell / classes, cell % classes));
    sum += cells.back();
  }
  for (double& cell : cells) {
    cell /= sum;
  }
  return cells;
}

// Kolmogorov and Smirnov's distances from the uniform distribution, either way.
struct Distances {
  double above;  // smaller p than there should be
  double below;
};
Distances distances_of(std::vector<double> p) {
  std::ranges::sort(p);
  Distances found{0.0, 0.0};
  const auto n = static_cast<double>(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    found.above = std::max(found.above, static_cast<double>(i + 1) / n - p[i]);
    found.below = std::max(found.below, p[i] - static_cast<double>(i) / n);
  }
  return found;
}
// Beyond it by chance once in 10 000: exp(-2 n d^2).
double limit_of(int count) {
  return std::sqrt(std::log(10'000.0) / (2.0 * count));
}
enum class Law { uniform, not_smaller };
void check_p(const std::string& name, Law law, const Study& study, int count = studies) {
  std::vector<double> p;
  for (int i = 0; i < count; ++i) {
    Rng rng{core::derived_seed(7, core::Purpose::study, static_cast<std::uint64_t>(i))};
    p.push_back(study(rng));
  }
  const Distances found = distances_of(p);
  INFO(name << ": above " << found.above << ", below " << found.below);
  CHECK(found.above < limit_of(count));
  CHECK((law == Law::not_smaller || found.below < limit_of(count)));
  CHECK(std::ranges::min(p) < 0.05);  // it is a test
}

// How often of a thousand an interval holds 0.
int holding_0(const std::function<Interval(Rng& rng)>& interval_of) {
  int holding = 0;
  for (int i = 0; i < studies; ++i) {
    Rng rng{core::derived_seed(8, core::Purpose::study, static_cast<std::uint64_t>(i))};
    const Interval interval = interval_of(rng);
    holding += interval.low <= 0.0 && 0.0 <= interval.high ? 1 : 0;
  }
  return holding;
}

// Of participants whose spread differs by a factor of up to e.
std::vector<double> differences(int participants, Rng& rng) {
  std::vector<double> all;
  for (int i = 0; i < participants; ++i) {
    all.push_back(std::exp(rng.uniform()) * rng.normal());
  }
  return all;
}
RatingTable unrelated_ratings(int participants, Rng& rng) {
  RatingTable ratings;
  for (int i = 0; i < participants; ++i) {
    const double offset = rng.normal();
    const double spread = std::exp(rng.normal());
    ratings.emplace_back();
    for (std::size_t k = 0; k < classes; ++k) {
      ratings.back().push_back(offset + spread * rng.normal());
    }
  }
  return ratings;
}
}  // namespace

TEST_CASE("tests of tables have uniform probabilities where what they test is true of answers",
          "[analysis][statistics][slow]") {
  constexpr int answers = 2000;
  check_p("symmetry", Law::uniform,
          [&](Rng& rng) { return symmetry_test(symmetric_answers(rng))->p; });
  check_p("homogeneity", Law::uniform,
          [&](Rng& rng) { return homogeneity_test(symmetric_answers(rng))->p; });
  const Shares biases{0.1, 0.2, 0.3, 0.4};
  const Shares guessed = cells_of([&](std::size_t /*i*/, std::size_t j) { return biases[j]; });
  check_p("independence", Law::uniform,
          [&](Rng& rng) { return independence(table_of(guessed, answers, rng))->asymptotic_p; });
  const Shares chosen = cells_of([&](std::size_t i, std::size_t j) {
    const auto similarity = [](std::size_t a, std::size_t b) {
      return a == b ? 1.0 : 0.2 + 0.1 * static_cast<double>(a + b);
    };
    double all = 0.0;
    for (std::size_t m = 0; m < classes; ++m) {
      all += biases[m] * similarity(i, m);
    }
    return biases[j] * similarity(i, j) / all;
  });
  check_p("similarity choice", Law::uniform,
          [&](Rng& rng) { return similarity_choice(table_of(chosen, answers, rng)).p; });
}

TEST_CASE("the similarity-choice model is not rejected too often where errors are few",
          "[analysis][statistics][slow]") {
  constexpr int of_each = 40;
  constexpr int small_studies = 300;
  check_p(
      "similarity choice, given the totals", Law::not_smaller,
      [&](Rng& rng) {
        CountTable table(classes, std::vector<std::int64_t>(classes, 0));
        for (std::size_t i = 0; i < classes; ++i) {
          Shares row(classes, 0.1 / 3.0);
          row[i] = 0.9;
          for (int answer = 0; answer < of_each; ++answer) {
            ++table[i][drawn(row, rng)];
          }
        }
        const SimilarityChoice model = similarity_choice(table);
        return model.degrees_of_freedom > 0 ? conditional_fit(table, model, rng()).p : 1.0;
      },
      small_studies);
}

TEST_CASE("exact tests have no smaller probabilities than they say, whatever participants' biases",
          "[analysis][statistics][slow]") {
  check_p("one person, binomial", Law::not_smaller, [](Rng& rng) {
    const Shares biases{0.1, 0.2, 0.3, 0.4};
    std::vector<std::size_t> presented;
    for (std::size_t i = 0; i < 20; ++i) {
      presented.push_back(i % classes);
    }
    rng.shuffle(presented);
    const auto right = std::ranges::count_if(
        presented, [&](std::size_t stimulus) { return drawn(biases, rng) == stimulus; });
    return binomial_p_at_least({right, 20}, 0.25);
  });
  check_p("multinomial", Law::not_smaller, [](Rng& rng) {
    std::vector<int> votes(classes, 0);
    for (int i = 0; i < 15; ++i) {
      ++votes[rng.below(classes)];
    }
    return *exact_multinomial_p(votes);
  });
  check_p("sign", Law::not_smaller, [](Rng& rng) { return sign_test(differences(14, rng)).p; });
  check_p("signed ranks", Law::not_smaller,
          [](Rng& rng) { return *signed_rank_test(differences(14, rng)).p; });
  check_p("sign flips", Law::not_smaller,
          [](Rng& rng) { return sign_flip_test(differences(10, rng), 1).p; });
}

TEST_CASE("tests over participants have the probabilities that they say",
          "[analysis][statistics][slow]") {
  check_p("Friedman", Law::not_smaller,
          [](Rng& rng) { return friedman_test(unrelated_ratings(5, rng), 1).p; });
  BlockDesign design;
  design.name = "pairs";
  design.guess_rate = 0.5;
  check_p("answers of participants who prefer a place", Law::not_smaller, [&](Rng& rng) {
    std::vector<results::AnswerRow> answers;
    for (int person = 0; person < 12; ++person) {
      for (int trial = 0; trial < 60; ++trial) {
        results::AnswerRow answer;
        answer.participant_id = "p" + std::to_string(person);
        // the first place is right in half of the trials; who prefers it always names it
        answer.is_correct = rng.below(2) == 0;
        answers.push_back(answer);
      }
    }
    return *discrimination_results(design, answers).p;
  });
}

TEST_CASE("the deviance of answers that follow the fitted function is no rarer than it says",
          "[analysis][psychometric][slow]") {
  constexpr int fewer_studies = 200;
  constexpr int draws = 99;
  const PsychometricModel model{core::PsychometricShape::logistic, {0.5, 0.5}, {0.0, 0.05}};
  check_p(
      "deviance", Law::uniform,
      [&](Rng& rng) {
        std::vector<Level> levels;
        for (int i = 0; i < 6; ++i) {
          const double value = 0.5 * i - 1.25;
          const double p = 0.5 + 0.48 / (1.0 + std::exp(-3.0 * value));
          Level level{value, {0, 40}};
          for (int trial = 0; trial < 40; ++trial) {
            level.answers.successes += rng.uniform() < p ? 1 : 0;
          }
          levels.push_back(level);
        }
        return deviance_test(model, levels, draws, rng()).p;
      },
      fewer_studies);
}

TEST_CASE("intervals over participants who differ hold the truth as often as they say",
          "[analysis][statistics][slow]") {
  constexpr int least = 930;  // of 1000 at .95, fewer by chance once in 500
  CHECK(holding_0([](Rng& rng) {
          std::vector<double> normal;
          for (int i = 0; i < 8; ++i) {
            normal.push_back(rng.normal());
          }
          return *paired_contrast(normal, 1).interval;
        }) >= least);
  // two studies of one truth, compared
  const auto study = [](Rng& rng) {
    std::vector<Proportion> people;
    for (int i = 0; i < 10; ++i) {
      const double share = std::clamp(0.5 + 0.15 * rng.normal(), 0.0, 1.0);
      people.push_back({0, 16});
      for (int trial = 0; trial < 16; ++trial) {
        people.back().successes += rng.uniform() < share ? 1 : 0;
      }
    }
    const auto mean = mean_share(people);
    return IntervalEstimate{mean->mean, *mean->interval, mean->participants - 1.0};
  };
  CHECK(holding_0([&](Rng& rng) {
          const IntervalEstimate first = study(rng);
          return independent_difference(first, study(rng)).interval;
        }) >= least);
}
