// inference_bench [STUDIES [TRACKS]]: how often tests of people who feel nothing give p <= .05, and
// how often 95 % intervals hold the truth where people differ. Each cell is of STUDIES studies
// (2000), thresholds are of TRACKS tracks (200). "!" marks sizes outside .03 to .07 and coverages
// outside .93 to .97.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <random>

#include "analysis/report/blocks/discrimination.hpp"
#include "analysis/report/blocks/thresholds.hpp"
#include "analysis/report/confusion/chance_tests.hpp"
#include "analysis/report/confusion/confusion_sections.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/psychometric/inference.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "support/procedures.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
constexpr int numbers[]{3, 5, 8, 20};  // of participants
enum class Guesser { indifferent, of_habit, reluctant_to_repeat };
constexpr std::pair<Guesser, const char*> guessers[]{
    {Guesser::indifferent, "indifferent"},
    {Guesser::of_habit, "80/20 habit"},
    {Guesser::reluctant_to_repeat, "reluctant to repeat"}};

std::string marked(double share, double low, double high) {
  return fmt::format("{:.3f}{}", share, share < low || share > high ? "!" : " ");
}

std::string share_of(int studies, core::Rng& rng, const std::function<bool(core::Rng&)>& is_so,
                     double low, double high) {
  int number = 0;
  for (int study = 0; study < studies; ++study) {
    number += is_so(rng) ? 1 : 0;
  }
  return marked(static_cast<double>(number) / studies, low, high);
}

std::size_t guess(Guesser guesser, std::size_t answers, std::optional<std::size_t> last,
                  core::Rng& rng) {
  const auto any = [&](std::size_t of) { return rng.below(static_cast<std::uint32_t>(of)); };
  if (guesser == Guesser::of_habit) {
    return rng.uniform() < 0.8 ? 0 : 1 + any(answers - 1);
  }
  if (guesser == Guesser::reluctant_to_repeat && last) {
    const bool is_again = rng.uniform() < 0.5 / static_cast<double>(answers);
    return is_again ? *last : (*last + 1 + any(answers - 1)) % answers;
  }
  return any(answers);
}

// Two answers, each right equally often in every repetition.
std::vector<results::AnswerRow> discriminating(Guesser guesser, int people, int trials,
                                               int repetitions, core::Rng& rng) {
  std::vector<results::AnswerRow> answers;
  for (int person = 0; person < people; ++person) {
    std::optional<std::size_t> last;
    for (int repetition = 1; repetition <= repetitions; ++repetition) {
      std::vector<std::size_t> right;
      for (int i = 0; i < trials; ++i) {
        right.push_back(static_cast<std::size_t>(i % 2));
      }
      rng.shuffle(right);
      for (const std::size_t of_trial : right) {
        last = guess(guesser, 2, last, rng);
        results::AnswerRow& answer = answers.emplace_back();
        answer.participant_id = fmt::format("p{}", person);
        answer.response = *last == 0 ? "A" : "B";
        answer.is_correct = *last == of_trial;
        answer.repetition = repetition;
      }
    }
  }
  return answers;
}

void print_discrimination(const char* name, int trials, int repetitions, int studies,
                          core::Rng& rng) {
  BlockDesign design;
  design.guess_rate = 0.5;
  for (const auto& [guesser, words] : guessers) {
    fmt::print("| size, {}, {} |", name, words);
    for (const int people : numbers) {
      fmt::print(" {} |",
                 share_of(
                     studies, rng,
                     [&, of = guesser](core::Rng& own) {
                       const auto answers = discriminating(of, people, trials, repetitions, own);
                       return permutation_tests(*places_redrawn(design, answers),
                                                {{{true, false}, {false, true}}}, 199, own())
                                  .front()
                                  .p <= 0.05;
                     },
                     0.03, 0.07));
    }
    fmt::print("\n");
  }
}

BlockDesign identification() {
  BlockDesign design;
  design.name = "plates";
  design.is_order_known = false;  // shuffled whole, which shuffling answers redraws
  for (const char* const structure : {"one", "two"}) {
    for (const char* const material : {"wood", "steel"}) {
      Item item;
      item.name = fmt::format("{}_{}", material, structure);
      item.label = item.name;
      item.factors = {{"structure", structure}, {"material", material}};
      design.stimuli.push_back(item);
      design.responses.push_back(item);
    }
  }
  return design;
}

std::vector<results::AnswerRow> identifying(const BlockDesign& design, Guesser guesser, int people,
                                            core::Rng& rng) {
  constexpr int repetitions = 4;
  std::vector<results::AnswerRow> answers;
  for (int person = 0; person < people; ++person) {
    std::vector<std::size_t> order;
    for (int i = 0; i < repetitions * 4; ++i) {
      order.push_back(static_cast<std::size_t>(i % 4));
    }
    rng.shuffle(order);
    std::optional<std::size_t> last;
    for (const std::size_t stimulus : order) {
      last = guess(guesser, 4, last, rng);
      results::AnswerRow& answer = answers.emplace_back();
      answer.participant_id = fmt::format("p{}", person);
      answer.stimulus = design.stimuli[stimulus].name;
      answer.response = design.responses[*last].name;
      answer.is_correct = stimulus == *last;
      answer.trial_id = static_cast<std::int64_t>(answers.size());
    }
  }
  return answers;
}

void print_identification(int studies, core::Rng& rng) {
  const BlockDesign design = identification();
  const auto row = [&](const char* name,
                       const std::function<double(const IdentificationData&, core::Rng&)>& p_of) {
    for (const auto& [guesser, words] : guessers) {
      fmt::print("| size, {}, {} |", name, words);
      for (const int people : numbers) {
        fmt::print(" {} |", share_of(
                                studies, rng,
                                [&, of = guesser](core::Rng& own) {
                                  return p_of(identification_data(
                                                  design, identifying(design, of, people, own)),
                                              own) <= 0.05;
                                },
                                0.03, 0.07));
      }
      fmt::print("\n");
    }
  };
  row("identification against chance", [&](const IdentificationData& data, core::Rng& own) {
    return chance_tests(randomisation_of(design, data), {design.stimuli, design.responses}, {},
                        {199, own()})
        .accuracy->p;
  });
  row("contrast of a factor", [](const IdentificationData& data, core::Rng& /*own*/) {
    const auto& first = contrasts_section(data).tables.at(0).rows.at(0);
    return std::get<double>(first.at(5).values.at(0));
  });
}

enum class Trials { equal, unequal, of_those_below };
std::vector<Proportion> people_who_differ(int people, double mean, double intraclass, Trials trials,
                                          core::Rng& rng) {
  std::vector<Proportion> drawn;
  std::mt19937_64 generator{rng()};
  for (int i = 0; i < people; ++i) {
    double share = mean;
    if (intraclass > 0.0) {
      const double nu = 1.0 / intraclass - 1.0;
      const double a = std::gamma_distribution<>{nu * mean}(generator);
      share = a / (a + std::gamma_distribution<>{nu * (1.0 - mean)}(generator));
    }
    const bool stops = trials == Trials::unequal ? rng.uniform() < 0.4 : share < mean;
    drawn.push_back({0, trials == Trials::equal ? 16 : stops ? 6 : 30});
    for (std::int64_t k = 0; k < drawn.back().trials; ++k) {
      drawn.back().successes += rng.uniform() < share ? 1 : 0;
    }
  }
  return drawn;
}

void print_shares(int studies, core::Rng& rng) {
  constexpr std::pair<Trials, const char*> kinds[]{
      {Trials::equal, "16 trials each"},
      {Trials::unequal, "30 trials, some stop at 6"},
      {Trials::of_those_below, "30 trials, those below the mean stop at 6"}};
  for (const auto& [kind, words] : kinds) {
    for (const double mean : {0.5, 0.8, 0.9}) {
      for (const double intraclass : {0.0, 0.1, 0.3}) {
        fmt::print("| coverage, share {} of people with intra-class correlation {}, {} |", mean,
                   intraclass, words);
        for (const int people : numbers) {
          fmt::print(" {} |", share_of(
                                  studies, rng,
                                  [&, trials = kind](core::Rng& own) {
                                    const auto of = mean_share(
                                        people_who_differ(people, mean, intraclass, trials, own));
                                    return of->interval->low <= mean && mean <= of->interval->high;
                                  },
                                  0.93, 0.97));
        }
        fmt::print("\n");
      }
    }
  }
}

// Of log thresholds, and of a fifth of people beyond the highest level of one technique.
void print_contrasts(int studies, core::Rng& rng) {
  const auto row = [&](const char* name, double limit) {
    fmt::print("| coverage, ratio within participants, {} |", name);
    for (const int people : numbers) {
      fmt::print(" {} |",
                 share_of(
                     studies, rng,
                     [&](core::Rng& own) {
                       std::vector<Interval> found;
                       for (int i = 0; i < people; ++i) {
                         const double d = 0.5 + own.normal();
                         found.push_back(d < limit ? Interval{d, d} : Interval{limit, INFINITY});
                       }
                       const auto interval = censored_contrast(found, 1).interval;
                       return !interval || (interval->low <= 0.5 && 0.5 <= interval->high);
                     },
                     0.93, 0.97));
    }
    fmt::print("\n");
  };
  row("all thresholds found", INFINITY);
  row("a fifth beyond the levels", 1.34);
}

std::vector<Level> levels_of(const protocols::TrackSettings& settings,
                             testing::KnownObserver& observer, std::uint64_t seed) {
  const auto track = settings.start(seed);
  std::map<double, Proportion> counts;
  testing::run(*track, [&](const std::vector<double>& values) {
    const std::size_t answer = observer.answer(values[0]);
    counts[values[0]].add(answer == 1);
    return answer;
  });
  std::vector<Level> levels;
  for (const auto& [value, of] : counts) {
    levels.push_back({value, of});
  }
  return levels;
}

void print_thresholds(int tracks) {
  const PsychometricModel model{core::PsychometricShape::weibull, {0.5, 0.5}, {0.0, 0.1}};
  const std::string grid =
      "quest_plus: {function: weibull, stimulus: {min: 0.1, max: 10, count: 25, spacing: log}, "
      "threshold: {min: 0.1, max: 10, count: 25, spacing: log}, slope: {values: [1, 2, 3.5, 5]}, "
      "guess: {values: [0.5]}, lapse: {values: [0.02, 0.05]}, stop: {trials: ";
  const std::vector<std::pair<const char*, std::string>> procedures{
      {"staircase of 60",
       "staircase: {rule: transformed, n_down: 3, steps: factor, start: 3, min: 0.1, max: 10, "
       "first_step: 1.6, min_step: 1.15, stop: {trials: 60}, estimate_reversals: 6}"},
      {"QUEST+ of 40", grid + "40}}"},
      {"QUEST+ of 100", grid + "100}}"},
      {"constant stimuli, 5 x 20",
       "constant: {min: 0.3, max: 3, count: 5, spacing: log, repetitions: 20}"}};
  for (const auto& [name, procedure] : procedures) {
    const auto settings = testing::procedure_of(procedure);
    for (const double slope : {2.0, 0.8}) {
      for (const double lapse : {0.0, 0.05}) {
        int found = 0;
        int held = 0;
        int open = 0;
        for (int track = 0; track < tracks; ++track) {
          testing::KnownObserver observer{
              {core::PsychometricShape::weibull, 1.0, slope, 0.5, lapse},
              static_cast<std::uint64_t>(track)};
          const auto levels = levels_of(*settings, observer, static_cast<std::uint64_t>(track));
          try {
            const auto of = psychometric_posterior(model, levels, 0.95, prior_breadth).estimates;
            found += of ? 1 : 0;
            held += of && of->threshold_interval.low <= 1.0 && 1.0 <= of->threshold_interval.high;
            open += of && std::isinf(of->threshold_interval.high);
          } catch (const core::NotEstimable&) {
          }
        }
        fmt::print("| coverage, threshold, {}, slope {}, lapses {} | {} of {} tracks, open {} |\n",
                   name, slope, lapse,
                   marked(found > 0 ? static_cast<double>(held) / found : 0.0, 0.92, 1.0), found,
                   open);
      }
    }
  }
}
}  // namespace

int main(int argc, char** argv) {
  const int studies = argc > 1 ? std::atoi(argv[1]) : 2000;
  const int tracks = argc > 2 ? std::atoi(argv[2]) : 200;
  core::Rng rng{1};
  fmt::print("| {} studies a cell | N = 3 | 5 | 8 | 20 |\n|---|---|---|---|---|\n", studies);
  print_discrimination("two places, 2 repetitions of one comparison", 2, 2, studies, rng);
  print_discrimination("two places, 4 repetitions of 4 trials", 4, 4, studies, rng);
  print_identification(studies, rng);
  print_shares(studies, rng);
  print_contrasts(studies, rng);
  print_thresholds(tracks);
  return 0;
}
