#include "analysis/statistics/confusion_matrix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "core/error.hpp"
namespace tapstudy::analysis {
TableTotals totals_of(const CountTable& table) {
  if (table.empty() || table.front().empty()) {
    throw core::InvalidInput{"a table of counts has one row and one column or more"};
  }
  TableTotals totals{std::vector<std::int64_t>(table.size()),
                     std::vector<std::int64_t>(table.front().size()), 0};
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].size() != totals.columns.size()) {
      throw core::InvalidInput{"the rows of a table of counts are of one length"};
    }
    for (std::size_t j = 0; j < table[i].size(); ++j) {
      if (table[i][j] < 0) {
        throw core::InvalidInput{"counts are not below 0"};
      }
      totals.rows[i] += table[i][j];
      totals.columns[j] += table[i][j];
      totals.all += table[i][j];
    }
  }
  return totals;
}

CountTable without_empty_lines(const CountTable& table) {
  const TableTotals totals = totals_of(table);
  CountTable kept;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (totals.rows[i] == 0) {
      continue;
    }
    kept.emplace_back();
    for (std::size_t j = 0; j < table[i].size(); ++j) {
      if (totals.columns[j] > 0) {
        kept.back().push_back(table[i][j]);
      }
    }
  }
  return kept;
}

CountTable sum_of(const std::vector<CountTable>& tables) {
  if (tables.empty()) {
    throw core::InvalidInput{"a sum of tables takes one table or more"};
  }
  CountTable sum = tables.front();
  for (std::size_t t = 1; t < tables.size(); ++t) {
    if (tables[t].size() != sum.size()) {
      throw core::InvalidInput{"tables that are added have one shape"};
    }
    for (std::size_t i = 0; i < sum.size(); ++i) {
      if (tables[t][i].size() != sum[i].size()) {
        throw core::InvalidInput{"tables that are added have one shape"};
      }
      for (std::size_t j = 0; j < sum[i].size(); ++j) {
        sum[i][j] += tables[t][i][j];
      }
    }
  }
  return sum;
}

TableTotals totals_of_square(const CountTable& table) {
  TableTotals totals = totals_of(table);
  if (totals.rows.size() != totals.columns.size()) {
    throw core::InvalidInput{"this table of counts has as many rows as columns"};
  }
  return totals;
}

namespace {
std::size_t place_of(const std::vector<Item>& items, const std::string& name, const char* kind) {
  const auto found = std::ranges::find(items, name, &Item::name);
  if (found == items.end()) {
    throw core::InvalidInput{fmt::format("{} '{}' is not part of this matrix", kind, name)};
  }
  return static_cast<std::size_t>(found - items.begin());
}

using Agrees = std::function<bool(const Item& stimulus, const Item& response)>;

Proportion counted(const ConfusionMatrix& matrix, const Agrees& is_success, const Agrees& counts) {
  Proportion proportion;
  for (std::size_t i = 0; i < matrix.stimuli.size(); ++i) {
    for (std::size_t j = 0; j < matrix.responses.size(); ++j) {
      if (!counts(matrix.stimuli[i], matrix.responses[j])) {
        continue;
      }
      const std::int64_t n = matrix.counts[i][j];
      proportion.trials += n;
      proportion.successes += is_success(matrix.stimuli[i], matrix.responses[j]) ? n : 0;
    }
  }
  return proportion;
}

bool always(const Item& /*stimulus*/, const Item& /*response*/) {
  return true;
}

Agrees same_level(const std::string& factor) {
  return [factor](const Item& stimulus, const Item& response) {
    const auto level = response.factors.find(factor);
    return level != response.factors.end() && stimulus.factors.at(factor) == level->second;
  };
}

// The factors of every stimulus whose number of different levels is wanted.
std::vector<std::string> factors_where(const ConfusionMatrix& matrix,
                                       const std::function<bool(std::size_t levels)>& is_wanted) {
  std::map<std::string, std::map<std::string, std::size_t>> stimuli_at;  // factor → level → count
  for (const Item& item : matrix.stimuli) {
    for (const auto& [factor, level] : item.factors) {
      ++stimuli_at[factor][level];
    }
  }
  std::vector<std::string> names;
  for (const auto& [factor, levels] : stimuli_at) {
    std::size_t stimuli = 0;
    for (const auto& [level, count] : levels) {
      stimuli += count;
    }
    if (stimuli == matrix.stimuli.size() && is_wanted(levels.size())) {
      names.push_back(factor);
    }
  }
  return names;
}
}  // namespace

ConfusionMatrix::ConfusionMatrix(std::vector<Item> of_stimuli, std::vector<Item> of_responses)
    : stimuli{std::move(of_stimuli)},
      responses{std::move(of_responses)},
      counts(stimuli.size(), std::vector<std::int64_t>(responses.size(), 0)) {}

void ConfusionMatrix::add(const std::string& stimulus, const std::string& response,
                          std::int64_t times) {
  counts.at(place_of(stimuli, stimulus, "stimulus"))
      .at(place_of(responses, response, "response")) += times;
}

std::int64_t ConfusionMatrix::row_total(std::size_t stimulus) const {
  return std::accumulate(counts.at(stimulus).begin(), counts.at(stimulus).end(), std::int64_t{0});
}

std::int64_t ConfusionMatrix::total() const {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < stimuli.size(); ++i) {
    sum += row_total(i);
  }
  return sum;
}

double ConfusionMatrix::share_of_alternatives() const {
  std::int64_t named = 0;
  for (const std::vector<std::int64_t>& row : counts) {
    for (std::size_t j = 0; j < responses.size(); ++j) {
      named += responses[j].is_alternative ? row[j] : 0;
    }
  }
  const std::int64_t all = total();
  return all > 0 ? static_cast<double>(named) / static_cast<double>(all) : 1.0;
}

Proportion overall_accuracy(const ConfusionMatrix& matrix) {
  return counted(
      matrix,
      [](const Item& stimulus, const Item& response) {
        return stimulus.is_answered_by(response.name);
      },
      always);
}

Proportion factor_accuracy(const ConfusionMatrix& matrix, const std::string& factor) {
  return counted(matrix, same_level(factor), always);
}

Proportion conditional_accuracy(const ConfusionMatrix& matrix, const std::string& factor,
                                const std::string& given) {
  return counted(matrix, same_level(factor), same_level(given));
}

double factor_chance(const ConfusionMatrix& matrix, const std::string& factor,
                     const std::string& given) {
  const Agrees agrees = same_level(factor);
  const Agrees counts = given.empty() ? Agrees{always} : same_level(given);
  double agreeing = 0.0;
  double possible = 0.0;
  for (std::size_t i = 0; i < matrix.stimuli.size(); ++i) {
    for (const Item& response : matrix.responses) {
      if (response.is_alternative && counts(matrix.stimuli[i], response)) {
        const auto weight = static_cast<double>(matrix.row_total(i));
        possible += weight;
        agreeing += agrees(matrix.stimuli[i], response) ? weight : 0.0;
      }
    }
  }
  const double share = given.empty() ? matrix.share_of_alternatives() : 1.0;
  return possible > 0.0 ? share * agreeing / possible : 0.0;
}

std::vector<std::string> factors_of(const ConfusionMatrix& matrix) {
  return factors_where(matrix, [](std::size_t levels) { return levels > 1; });
}

std::vector<std::string> factors_of_one_level(const ConfusionMatrix& matrix) {
  return factors_where(matrix, [](std::size_t levels) { return levels == 1; });
}
}  // namespace tapstudy::analysis
