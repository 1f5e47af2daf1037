// inference_bench [STUDIES [SECONDS [WORD]]]: how often tests of people who feel nothing give
// p <= .05, how often 95 % intervals hold the truth where people differ, and how long those of
// shares are in proportion to t's, as a table in Markdown. A cell is of STUDIES studies (2000), or
// of fewer, which are told, where a line has taken SECONDS of the processors' time (20). With WORD
// only lines that hold it. Of three numbers in a cell those of tests are of indifferent, habitual
// and reluctant guessers, those of intervals of intra-class correlations 0, .1 and .3. "!" marks
// sizes outside .03 to .07, coverages outside .93 to .97 and lengths above 1.15, "°" sizes below
// .03 that discrete answers leave no better choice; in parentheses the share of studies without a
// result. What a line took of the processors' time is told beside the table.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <iterator>
#include <limits>

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

double sum_of(const Cell& cell, double Outcome::*what) {
  double sum = 0.0;
  for (const Outcome& one : cell.outcomes) {
    sum += one.*what;
  }
  return sum;
}

std::string words_of(const Row& row, const Cell& cell) {
  const auto given = static_cast<double>(cell.outcomes.size());
  if (2.0 * given < cell.studies) {
    return "–";
  }
  const double missing = 1.0 - given / cell.studies;
  const std::string without = missing >= 0.005 ? fmt::format(" ({:.0f} %)", 100.0 * missing) : "";
  const bool is_size = row.kind == Kind::size;
  if (row.kind == Kind::width) {
    const double ratio = sum_of(cell, &Outcome::value) / sum_of(cell, &Outcome::of_further);
    constexpr double most = 1.15;
    return fmt::format("{:.2f}{}", ratio, ratio > most ? "!" : "");
  }
  const double share =
      is_size ? share_up_to(cell.outcomes, alpha) : sum_of(cell, &Outcome::value) / given;
  constexpr double rounding = 1e-9;
  const double low = (is_size ? 0.03 : 0.93) - rounding;
  const double high = (is_size ? 0.07 : 0.97) + rounding;
  const bool is_discrete = is_size && share < low && is_as_near_as_can_be(cell.outcomes, low);
  const char* const mark = is_discrete ? "°" : share < low || share > high ? "!" : "";
  return fmt::format("{:.3f}{}{}", share, mark, without);
}

const char* name_of(Kind kind) {
  constexpr std::array names{"size", "coverage", "width"};
  return names.at(static_cast<std::size_t>(kind));
}

void add_study(const Row& row, const StudyDraw& draw, Cell& cell) {
  ++cell.studies;
  try {
    if (const auto outcome = row.study(draw)) {
      cell.outcomes.push_back(*outcome);
    }
  } catch (const tapstudy::core::NotEstimable&) {  // which the report says
  }
}

double seconds_of_processors() {
  constexpr double per_second = CLOCKS_PER_SEC;
  return static_cast<double>(std::clock()) / per_second;
}

struct Limits {
  int studies{};
  double seconds{};  // of a line, beside its first round
};

// The cells of a row. Rounds are of parts that have their own seeds, for cells of many participants
// take as long as all others.
std::vector<Cell> cells_of(const Row& row, const Limits& limits, std::uint64_t seed) {
  constexpr int in_a_part = 5;
  constexpr std::size_t parts_in_a_round = 4;
  const std::size_t kinds = row.by == By::people ? 1 : 3;
  std::vector<Cell> cells(numbers.size() * kinds);
  std::uint64_t part = 0;
  double end = std::numeric_limits<double>::infinity();
  while (cells.front().studies < limits.studies && seconds_of_processors() < end) {
    std::vector<Cell> found(cells.size() * parts_in_a_round);
    tapstudy::analysis::parallel_for(found.size(), 0, [&](std::size_t i) {
      const std::size_t cell = i / parts_in_a_round;
      Rng rng{1'000'000 * seed + part + i};
      StudyDraw draw{numbers[cell / kinds], rng};
      if (row.by == By::guessers) {
        draw.guesser = guessers[cell % kinds];
      } else if (row.by == By::correlations) {
        draw.intraclass_correlation = correlations[cell % kinds];
      }
      for (int study = 0; study < in_a_part; ++study) {
        add_study(row, draw, found[i]);
      }
    });
    for (std::size_t i = 0; i < found.size(); ++i) {
      Cell& cell = cells[i / parts_in_a_round];
      cell.studies += found[i].studies;
      std::ranges::copy(found[i].outcomes, std::back_inserter(cell.outcomes));
    }
    end = part == 0 ? seconds_of_processors() + limits.seconds : end;
    part += found.size();
  }
  return cells;
}

void print(const Row& row, const Limits& limits, std::uint64_t seed) {
  const double begin = seconds_of_processors();
  const std::vector<Cell> cells = cells_of(row, limits, seed);
  std::vector<std::string> words;
  std::ranges::transform(cells, std::back_inserter(words),
                         [&](const Cell& cell) { return words_of(row, cell); });
  fmt::print("| {} | {}, {} | {} |", row.task, name_of(row.kind), row.statistic,
             cells.front().studies);
  const auto in_a_column = static_cast<std::ptrdiff_t>(words.size() / numbers.size());
  for (auto first = words.begin(); first != words.end(); first += in_a_column) {
    fmt::print(" {} |", fmt::join(first, first + in_a_column, " "));
  }
  fmt::print("\n");
  std::fflush(stdout);
  fmt::print(stderr, "{:.1f} s of processors\n", seconds_of_processors() - begin);
}
}  // namespace

int main(int argc, char** argv) {
  const Limits limits{argc > 1 ? std::atoi(argv[1]) : 2000, argc > 2 ? std::atof(argv[2]) : 20.0};
  const std::string word = argc > 3 ? argv[3] : "";
  fmt::print(
      "| task | statistic | studies | N = 3 | 5 | 8 | 20 |\n|---|---|---|---|---|---|---|\n");
  std::uint64_t seed = 1;
  for (const auto rows :
       {rows_of_discrimination, rows_of_identification, rows_of_tables, rows_of_choices,
        rows_of_scales, rows_of_shares, rows_of_means, rows_of_levels}) {
    for (const Row& row : rows()) {
      if ((row.task + ", " + row.statistic).find(word) != std::string::npos) {
        print(row, limits, seed);
      }
      ++seed;
    }
  }
  return 0;
}
