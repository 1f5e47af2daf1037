#include "analysis/similarity/scaling.hpp"

#include <algorithm>
#include <cmath>

#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
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
