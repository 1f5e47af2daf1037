#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// counts[row][column], none negative, all rows as long.
using CountTable = std::vector<std::vector<std::int64_t>>;

struct TableTotals {
  std::vector<std::int64_t> rows;
  std::vector<std::int64_t> columns;
  std::int64_t all{};
};
// Throws InvalidInput for a table without cells, with rows of different lengths, or with a count
// below 0.
TableTotals totals_of(const CountTable& table);

// The table without the rows and columns whose total is 0.
CountTable without_empty_lines(const CountTable& table);

// Cell by cell. Throws InvalidInput if their shapes differ or there is none.
CountTable sum_of(const std::vector<CountTable>& tables);

// Throws InvalidInput, as totals_of does, and if there are not as many rows as columns.
TableTotals totals_of_square(const CountTable& table);

// A stimulus or response: its name in the data, its label for people, its factor levels.
struct Item {
  std::string name;
  std::string label;
  std::map<std::string, std::string> factors{};
  std::string right{};      // of a stimulus: the response that is right, if not its own name
  std::string technique{};  // by which a stimulus was rendered; empty: not known
  // False for a response that is right for no stimulus ("unsure").
  bool is_alternative{true};
  bool is_answered_by(const std::string& response) const {
    return response == (right.empty() ? name : right);
  }
};

inline std::int64_t alternatives_among(const std::vector<Item>& responses) {
  return std::ranges::count(responses, true, &Item::is_alternative);
}

// counts[i][j]: how often stimulus i was answered with response j.
struct ConfusionMatrix {
  std::vector<Item> stimuli;
  std::vector<Item> responses;
  std::vector<std::vector<std::int64_t>> counts;

  ConfusionMatrix(std::vector<Item> of_stimuli, std::vector<Item> of_responses);
  // Throws InvalidInput if either is not in the matrix.
  void add(const std::string& stimulus, const std::string& response, std::int64_t times = 1);
  std::int64_t row_total(std::size_t stimulus) const;
  std::int64_t total() const;
  std::int64_t alternatives() const { return alternatives_among(responses); }
  // The share of all answers that name an alternative; 1 if there are none.
  double share_of_alternatives() const;
  // The share of right answers of somebody who guesses among the alternatives, and says as often as
  // these participants did what is none of them.
  double chance() const { return share_of_alternatives() / static_cast<double>(alternatives()); }
};

// Proportion of answers that are right for the presented stimulus.
Proportion overall_accuracy(const ConfusionMatrix& matrix);
// Proportion of answers whose level of the factor is that of the stimulus.
Proportion factor_accuracy(const ConfusionMatrix& matrix, const std::string& factor);
// The same, only among answers that are correct in another factor.
Proportion conditional_accuracy(const ConfusionMatrix& matrix, const std::string& factor,
                                const std::string& given);
// Probability that a guess as that of ConfusionMatrix::chance agrees in the factor, given that it
// agrees in another (given may be empty), with stimuli weighted by how often they were presented.
double factor_chance(const ConfusionMatrix& matrix, const std::string& factor,
                     const std::string& given);
// The factors that every stimulus has a level of, and not all the same one. A response without a
// level agrees with none.
std::vector<std::string> factors_of(const ConfusionMatrix& matrix);
// The factors of which all stimuli have the same level.
std::vector<std::string> factors_of_one_level(const ConfusionMatrix& matrix);
}  // namespace tapstudy::analysis
