#include "analysis/statistics/contingency/information_transfer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "analysis/statistics/resampling/replicates.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
int occupied(const std::vector<std::int64_t>& totals) {
  return static_cast<int>(std::ranges::count_if(totals, [](auto total) { return total > 0; }));
}

double plug_in_bits(const CountTable& table, const TableTotals& totals) {
  const auto n = static_cast<double>(totals.all);
  double bits = 0.0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (std::size_t j = 0; j < table[i].size(); ++j) {
      if (table[i][j] > 0) {
        const auto cell = static_cast<double>(table[i][j]);
        bits += cell / n *
                std::log2(cell * n / static_cast<double>(totals.rows[i]) /
                          static_cast<double>(totals.columns[j]));
      }
    }
  }
  return bits;
}

TableTotals answered_totals(const CountTable& table) {
  TableTotals totals = totals_of(table);
  if (totals.all == 0) {
    throw core::InvalidInput{"information transfer takes one answer or more"};
  }
  return totals;
}
constexpr std::size_t fewest_participants = 5;

// Tukey 1958, of a function of the pooled Miller-Madow information.
template <class Function>
Interval jackknife(const std::vector<CountTable>& participants, const CountTable& all,
                   Function of) {
  const auto n = static_cast<double>(participants.size());
  const double whole = of(information_transfer(all).miller_madow_bits);
  std::vector<double> pseudo_values;
  for (const CountTable& left_out : participants) {
    CountTable rest = all;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      std::ranges::transform(rest[i], left_out[i], rest[i].begin(), std::minus{});
    }
    pseudo_values.push_back(n * whole -
                            (n - 1.0) * of(information_transfer(rest).miller_madow_bits));
  }
  const MeanAndSpread spread = mean_and_spread(pseudo_values);
  const double reach = t_quantile(0.975, n - 1.0) * spread.standard_deviation / std::sqrt(n);
  return {whole - reach, whole + reach};
}
}  // namespace

InformationTransfer information_transfer(const CountTable& table) {
  const TableTotals totals = answered_totals(table);
  InformationTransfer result{plug_in_bits(table, totals), 0.0, totals.all, 0};
  for (const auto& row : table) {
    result.occupied_cells += occupied(row);
  }
  const double correction =
      (occupied(totals.rows) + occupied(totals.columns) - result.occupied_cells - 1) /
      (2.0 * static_cast<double>(totals.all) * std::numbers::ln2);
  result.miller_madow_bits = result.bits + correction;
  return result;
}

std::int64_t fewest_answers_for_information(const CountTable& table) {
  const TableTotals totals = totals_of(table);
  const auto classes =
      static_cast<std::int64_t>(std::max(totals.rows.size(), totals.columns.size()));
  return 5 * classes * classes;
}

GuessedInformation guessed_information(const NullTables& tables, int draws, std::uint64_t seed,
                                       unsigned threads) {
  if (draws < 1) {
    throw core::InvalidInput{"a null distribution takes one draw or more"};
  }
  const double observed = plug_in_bits(tables.observed, answered_totals(tables.observed));
  const auto guessed = replicates(
      draws,
      [&](std::uint64_t own_seed) {
        const CountTable table = tables.draw(own_seed);
        return plug_in_bits(table, totals_of(table));
      },
      seed, threads);
  const double mean =
      std::accumulate(guessed.begin(), guessed.end(), 0.0) / static_cast<double>(draws);
  return {mean, quantile(guessed, 0.5), quantile(guessed, 0.95), monte_carlo_p(guessed, observed),
          draws};
}

std::optional<Interval> information_interval(const std::vector<CountTable>& participants) {
  const CountTable all = sum_of(participants);
  const double answers = static_cast<double>(answered_totals(all).all);
  if (participants.size() < fewest_participants) {
    return std::nullopt;
  }
  const double most = std::log2(static_cast<double>(std::min(all.size(), all.front().size())));
  const double nearest = 0.5 / answers;  // to 0 and 1
  const auto share = [&](double bits) { return std::clamp(bits / most, nearest, 1.0 - nearest); };
  const auto direct = jackknife(participants, all, [](double bits) { return bits; });
  const auto logit = jackknife(
      participants, all, [&](double bits) { return std::log(share(bits) / (1.0 - share(bits))); });
  if (!(direct.high > direct.low)) {
    return std::nullopt;
  }
  const auto back = [&](double value) { return most / (1.0 + std::exp(-value)); };
  return Interval{std::max(0.0, std::min(direct.low, back(logit.low))),
                  std::max({0.0, direct.high, back(logit.high)})};
}
}  // namespace tapstudy::analysis
