#include "analysis/similarity/similarity_choice.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "analysis/statistics/distributions.hpp"
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

// Until it has settled; the last round's change.
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
}  // namespace tapstudy::analysis
