// inference_bench [STUDIES [TRACKS [WORD]]]: how often tests of people who feel nothing give
// p <= .05, and how often 95 % intervals hold the truth where people differ, as a table in
// Markdown. Each cell is of STUDIES studies (2000), where each participant's answers take a fit of
// TRACKS (200). With WORD only lines that hold it. Of three numbers in a cell those of tests are of
// indifferent, habitual and reluctant guessers, those of intervals of intra-class correlations 0,
// .1 and .3. "!" marks sizes outside .03 to .07 and coverages outside .93 to .97, "°" sizes below
// .03 that discrete answers leave no better choice; in parentheses the share of studies without a
// result.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "analysis/statistics/resampling/replicates.hpp"
#include "core/error.hpp"
#include "inference/rows.hpp"
using namespace tapstudy::bench;
using tapstudy::core::Rng;

namespace {
constexpr std::array numbers{3, 5, 8, 20};  // of participants
constexpr std::array guessers{Guesser::indifferent, Guesser::of_habit,
                              Guesser::reluctant_to_repeat};
constexpr std::array correlations{0.0, 0.1, 0.3};
constexpr double alpha = 0.05;

struct Cell {
  std::vector<Outcome> outcomes;
  int studies{};
};

double share_up_to(const std::vector<Outcome>& tests, double p) {
  const auto number =
      std::ranges::count_if(tests, [&](const Outcome& one) { return one.value <= p + 1e-9; });
  return static_cast<double>(number) / static_cast<double>(tests.size());
}

// Whether the next p that answers can have would make the test reject too often, but for errors of
// so few studies; of tests given their data, whether one that rejects by lot at that p has its
// size.
bool is_as_near_as_can_be(const std::vector<Outcome>& tests, double smallest) {
  double next = 1.0;
  double by_lot = 0.0;
  for (const Outcome& one : tests) {
    next = one.value > alpha + 1e-9 ? std::min(next, one.value) : next;
    by_lot += std::clamp((alpha - one.of_further) / (one.value - one.of_further), 0.0, 1.0);
  }
  const auto number = static_cast<double>(tests.size());
  const double error = 2.0 * std::sqrt(alpha * (1.0 - alpha) / number);
  return std::isnan(by_lot) ? share_up_to(tests, next) >= alpha - error
                            : by_lot / number >= smallest;
}

std::string words_of(const Row& row, const Cell& cell) {
  const auto given = static_cast<double>(cell.outcomes.size());
  if (2.0 * given < cell.studies) {
    return "–";
  }
  const double missing = 1.0 - given / cell.studies;
  const std::string without = missing >= 0.005 ? fmt::format(" ({:.0f} %)", 100.0 * missing) : "";
  const bool is_size = row.kind == Kind::size;
  double share = 0.0;
  if (is_size) {
    share = share_up_to(cell.outcomes, alpha);
  } else {
    for (const Outcome& one : cell.outcomes) {
      share += one.value / given;
    }
  }
  constexpr double rounding = 1e-9;
  const double low = (is_size ? 0.03 : 0.93) - rounding;
  const double high = (is_size ? 0.07 : 0.97) + rounding;
  const bool is_discrete = is_size && share < low && is_as_near_as_can_be(cell.outcomes, low);
  const char* const mark = is_discrete ? "°" : share < low || share > high ? "!" : "";
  return fmt::format("{:.3f}{}{}", share, mark, without);
}

Cell cell_of(const Row& row, const StudyDraw& draw, int studies) {
  Cell cell{{}, studies};
  for (int study = 0; study < studies; ++study) {
    try {
      if (const auto outcome = row.study(draw)) {
        cell.outcomes.push_back(*outcome);
      }
    } catch (const tapstudy::core::NotEstimable&) {  // which the report says
    }
  }
  return cell;
}

void print(const Row& row, int studies, std::uint64_t seed) {
  const std::size_t kinds = row.by == By::people ? 1 : 3;
  std::vector<std::string> words(numbers.size() * kinds);
  tapstudy::analysis::parallel_for(words.size(), 0, [&](std::size_t i) {
    Rng rng{1000 * seed + i};
    StudyDraw draw{numbers[i / kinds], rng};
    if (row.by == By::guessers) {
      draw.guesser = guessers[i % kinds];
    } else if (row.by == By::correlations) {
      draw.intraclass_correlation = correlations[i % kinds];
    }
    words[i] = words_of(row, cell_of(row, draw, studies));
  });
  fmt::print("| {} | {}, {} |", row.task, row.kind == Kind::size ? "size" : "coverage",
             row.statistic);
  for (std::size_t i = 0; i < words.size(); i += kinds) {
    fmt::print(" {} |", fmt::join(words.begin() + static_cast<std::ptrdiff_t>(i),
                                  words.begin() + static_cast<std::ptrdiff_t>(i + kinds), " "));
  }
  fmt::print("\n");
  std::fflush(stdout);
}
}  // namespace

int main(int argc, char** argv) {
  const int studies = argc > 1 ? std::atoi(argv[1]) : 2000;
  const int tracks = argc > 2 ? std::atoi(argv[2]) : 200;
  const std::string word = argc > 3 ? argv[3] : "";
  fmt::print("| task | {} studies a cell, {} where thresholds are fitted | N = 3 | 5 | 8 | 20 |\n",
             studies, tracks);
  fmt::print("|---|---|---|---|---|---|\n");
  std::uint64_t seed = 1;
  for (const auto rows : {rows_of_discrimination, rows_of_identification, rows_of_choices,
                          rows_of_scales, rows_of_shares, rows_of_means, rows_of_levels}) {
    for (const Row& row : rows()) {
      if ((row.task + ", " + row.statistic).find(word) != std::string::npos) {
        print(row, row.cost == Cost::much ? tracks : studies, seed);
      }
      ++seed;
    }
  }
  return 0;
}
