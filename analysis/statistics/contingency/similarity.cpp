#include "analysis/statistics/contingency/similarity.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/resampling/replicates.hpp"
#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::size_t most_classes = 40;

constexpr int most_rounds = 50'000;
constexpr double tolerance = 1e-12;  // of a round's largest change, relative

// Fitted counts are rows_i columns_j symmetric_ij.
struct Factors {
  Eigen::VectorXd rows;
  Eigen::VectorXd columns;
  Eigen::MatrixXd symmetric;
  Eigen::MatrixXd fitted() const { return rows.asDiagonal() * symmetric * columns.asDiagonal(); }
};

Eigen::MatrixXd as_matrix(const CountTable& table) {
  const auto size = static_cast<Eigen::Index>(table.size());
  Eigen::MatrixXd counts(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      counts(i, j) =
          static_cast<double>(table[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]);
    }
  }
  return counts;
}

// One round of proportional fitting; the largest relative change.
double fit_once(const Eigen::MatrixXd& counts, Factors& factors) {
  const auto change_of = [](const Eigen::ArrayXd& ratio) { return (ratio - 1.0).abs().maxCoeff(); };
  const Eigen::ArrayXd row_ratio =
      counts.rowwise().sum().array() / factors.fitted().rowwise().sum().array();
  factors.rows.array() *= row_ratio;
  const Eigen::ArrayXd column_ratio = counts.colwise().sum().transpose().array() /
                                      factors.fitted().colwise().sum().transpose().array();
  factors.columns.array() *= column_ratio;
  const Eigen::MatrixXd fitted = factors.fitted();
  double change = std::max(change_of(row_ratio), change_of(column_ratio));
  for (Eigen::Index i = 0; i < counts.rows(); ++i) {
    for (Eigen::Index j = 0; j < counts.cols(); ++j) {
      const double pair = counts(i, j) + counts(j, i);
      const double ratio = pair == 0.0 ? 0.0 : pair / (fitted(i, j) + fitted(j, i));
      factors.symmetric(i, j) *= ratio;
      change = std::max(change, pair == 0.0 ? 0.0 : std::abs(ratio - 1.0));
    }
  }
  return change;
}

// Iterates until the fit has settled; returns the change in the last round.
double fit(const Eigen::MatrixXd& counts, Factors& factors) {
  double change = 1.0;
  for (int round = 0; round < most_rounds && change > tolerance; ++round) {
    change = fit_once(counts, factors);
  }
  return change;
}

Factors unfitted(Eigen::Index size) {
  return {Eigen::VectorXd::Ones(size), Eigen::VectorXd::Ones(size),
          Eigen::MatrixXd::Ones(size, size)};
}

double deviance(const Eigen::MatrixXd& counts, const Eigen::MatrixXd& fitted) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < counts.rows(); ++i) {
    for (Eigen::Index j = 0; j < counts.cols(); ++j) {
      sum += counts(i, j) > 0.0 ? 2.0 * counts(i, j) * std::log(counts(i, j) / fitted(i, j)) : 0.0;
    }
  }
  return std::max(0.0, sum);
}

int never_confused(const Eigen::MatrixXd& counts) {
  int pairs = 0;
  for (Eigen::Index i = 0; i < counts.rows(); ++i) {
    for (Eigen::Index j = i + 1; j < counts.cols(); ++j) {
      pairs += counts(i, j) + counts(j, i) == 0.0 ? 1 : 0;
    }
  }
  return pairs;
}

void take_parameters(const Factors& factors, SimilarityChoice& result) {
  const Eigen::VectorXd own = factors.symmetric.diagonal().cwiseSqrt();
  const Eigen::VectorXd biases = factors.columns.cwiseProduct(own);
  for (Eigen::Index i = 0; i < own.size(); ++i) {
    result.biases.push_back(biases(i) / biases.sum());
    result.similarities.emplace_back();
    for (Eigen::Index j = 0; j < own.size(); ++j) {
      result.similarities.back().push_back(factors.symmetric(i, j) / (own(i) * own(j)));
    }
  }
}

std::string refusal_of(const CountTable& table) {
  if (table.size() < 2 || table.size() > most_classes) {
    return "the similarity-choice model takes 2 to 40 classes";
  }
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i][i] == 0) {
      return "a class was never answered right, so that its similarities have no bound";
    }
  }
  return "";
}
}  // namespace

SimilarityChoice similarity_choice(const CountTable& table) {
  totals_of_square(table);
  SimilarityChoice result;
  result.refusal = refusal_of(table);
  if (!result.refusal.empty()) {
    return result;
  }
  const Eigen::MatrixXd counts = as_matrix(table);
  const Eigen::Index size = counts.rows();
  Factors factors = unfitted(size);
  constexpr double close_enough = 1e-6;
  if (!(fit(counts, factors) < close_enough)) {
    result.refusal = "the fit of the similarity-choice model does not settle";
    return result;
  }
  take_parameters(factors, result);
  result.g_squared = deviance(counts, factors.fitted());
  const int classes = static_cast<int>(size);
  result.degrees_of_freedom =
      std::max(0, (classes - 1) * (classes - 2) / 2 - never_confused(counts));
  result.p = result.degrees_of_freedom > 0
                 ? chi_squared_p(result.g_squared, result.degrees_of_freedom)
                 : 1.0;
  return result;
}

namespace {
constexpr std::int64_t most_answers = 5000;
constexpr int draws = 999;

// A Markov chain over the tables of the same totals of rows, columns and pairs; each has its
// conditional probability under quasi-symmetry, proportional to 1 / product of n_ij!.
class Chain {
 public:
  Chain(const CountTable& table, core::Rng& rng) : table_{table}, order_(table.size()), rng_{rng} {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
  }

  // All that differs between the tables of G²: sum of n ln n.
  double statistic() const {
    double sum = 0.0;
    for (const auto& row : table_) {
      for (const std::int64_t count : row) {
        sum += count > 0 ? static_cast<double>(count) * std::log(static_cast<double>(count)) : 0.0;
      }
    }
    return sum;
  }

  void step() {
    const std::size_t most = std::min<std::size_t>(order_.size(), longest_cycle);
    const std::size_t length = 3 + rng_.below(static_cast<std::uint32_t>(most - 2));
    for (std::size_t i = 0; i < length; ++i) {  // the first ones of a shuffle
      std::swap(order_[i], order_[i + rng_.below(static_cast<std::uint32_t>(order_.size() - i))]);
    }
    double ratio = 1.0;  // of probabilities
    for (std::size_t i = 0; i < length; ++i) {
      const std::size_t from = order_[i];
      const std::size_t to = order_[(i + 1) % length];
      ratio *= static_cast<double>(table_[to][from]) / static_cast<double>(table_[from][to] + 1);
    }
    if (rng_.uniform() >= ratio) {
      return;
    }
    for (std::size_t i = 0; i < length; ++i) {
      const std::size_t from = order_[i];
      const std::size_t to = order_[(i + 1) % length];
      ++table_[from][to];
      --table_[to][from];
    }
  }

 private:
  static constexpr std::size_t longest_cycle = 6;
  CountTable table_;
  std::vector<std::size_t> order_;
  core::Rng& rng_;
};

std::vector<double> statistics_of(const CountTable& table, int count, std::int64_t steps_between,
                                  core::Rng& rng) {
  Chain chain{table, rng};
  std::vector<double> statistics;
  for (int draw = 0; draw < count; ++draw) {
    for (std::int64_t step = 0; step < steps_between; ++step) {
      chain.step();
    }
    statistics.push_back(chain.statistic());
  }
  return statistics;
}
}  // namespace

ConditionalFit conditional_fit(const CountTable& table, const SimilarityChoice& model,
                               std::uint64_t seed) {
  const TableTotals totals = totals_of_square(table);
  if (totals.all > most_answers || table.size() < 3) {
    return {model.p, 0};
  }
  core::Rng rng{core::derived_seed(seed, core::Purpose::resampling)};
  const auto steps = std::max<std::int64_t>(100, totals.all);
  // the chain is reversible: backward is as forward
  const auto after = static_cast<int>(rng.below(draws + 1));
  std::vector<double> drawn = statistics_of(table, after, steps, rng);
  const std::vector<double> before = statistics_of(table, draws - after, steps, rng);
  drawn.insert(drawn.end(), before.begin(), before.end());
  return {monte_carlo_p(drawn, Chain{table, rng}.statistic()), draws};
}

namespace {
Eigen::MatrixXd checked(const std::vector<std::vector<double>>& distances) {
  const auto size = static_cast<Eigen::Index>(distances.size());
  Eigen::MatrixXd table(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const std::vector<double>& row = distances[static_cast<std::size_t>(i)];
    if (static_cast<Eigen::Index>(row.size()) != size) {
      throw core::InvalidInput{"distances are a square table"};
    }
    for (Eigen::Index j = 0; j < size; ++j) {
      table(i, j) = row[static_cast<std::size_t>(j)];
    }
  }
  if (!table.allFinite() || (table.array() < 0.0).any() ||
      (table - table.transpose()).cwiseAbs().maxCoeff() > 1e-9 ||
      table.diagonal().cwiseAbs().maxCoeff() > 0.0) {
    throw core::InvalidInput{"distances are finite, symmetric, not below 0, and 0 to themselves"};
  }
  return table;
}
}  // namespace

ScaledMap classical_scaling(const std::vector<std::vector<double>>& distances, int dimensions) {
  if (distances.empty()) {
    throw core::InvalidInput{"a map has one point or more"};
  }
  const Eigen::MatrixXd table = checked(distances);
  const Eigen::Index size = table.rows();
  if (dimensions < 1 || dimensions > size) {
    throw core::InvalidInput{"a map has one dimension or more, and no more than points"};
  }
  const Eigen::MatrixXd squares = table.cwiseAbs2();
  const Eigen::VectorXd means = squares.rowwise().mean();
  Eigen::MatrixXd products(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      products(i, j) = -0.5 * (squares(i, j) - means(i) - means(j) + means.mean());
    }
  }
  const core::EigenPairs pairs = core::symmetric_eigenpairs(products);
  const double all = pairs.values.cwiseAbs().sum();
  ScaledMap map;
  map.points.assign(static_cast<std::size_t>(size), {});
  for (Eigen::Index d = 0; d < dimensions; ++d) {
    const Eigen::Index place = size - 1 - d;  // they ascend
    const double eigenvalue = pairs.values(place);
    const Eigen::VectorXd axis = pairs.vectors.col(place);
    const double sign = axis.maxCoeff() < -axis.minCoeff() ? -1.0 : 1.0;
    const double length = sign * std::sqrt(std::max(0.0, eigenvalue));
    map.eigenvalues.push_back(eigenvalue);
    map.explained += all > 0.0 ? std::max(0.0, eigenvalue) / all : 0.0;
    for (Eigen::Index i = 0; i < size; ++i) {
      map.points[static_cast<std::size_t>(i)].push_back(length * axis(i));
    }
  }
  return map;
}

std::vector<std::vector<double>> distances_of(
    const std::vector<std::vector<double>>& similarities) {
  std::vector<std::vector<double>> distances = similarities;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    for (std::size_t j = 0; j < distances[i].size(); ++j) {
      const double similarity = similarities[i][j];
      if (!(similarity > 0.0)) {
        throw core::InvalidInput{"a distance takes a similarity above 0"};
      }
      distances[i][j] = i == j ? 0.0 : std::max(0.0, -std::log(similarity));
    }
  }
  return distances;
}
}  // namespace tapstudy::analysis
