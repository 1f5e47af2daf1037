#include "analysis/modal_identification/assignment.hpp"

#include <limits>
namespace tapstudy::analysis {
namespace {
constexpr Eigen::Index none = -1;

class Assigner {
 public:
  explicit Assigner(const Eigen::MatrixXd& cost)
      : cost_{cost},
        row_of_(static_cast<std::size_t>(cost.cols()), none),
        of_rows_{Eigen::VectorXd::Zero(cost.rows())},
        of_columns_{Eigen::VectorXd::Zero(cost.cols())} {}

  // The cheapest way to give one more row a column, others moving up.
  void add(Eigen::Index row) {
    const Eigen::Index columns = cost_.cols();
    Eigen::VectorXd distance =
        Eigen::VectorXd::Constant(columns, std::numeric_limits<double>::infinity());
    std::vector<Eigen::Index> before(static_cast<std::size_t>(columns), none);
    std::vector<bool> is_reached(static_cast<std::size_t>(columns), false);
    Eigen::Index from_column = none;
    double so_far = 0.0;
    for (Eigen::Index from_row = row; from_row != none;) {
      Eigen::Index nearest = none;
      for (Eigen::Index column = 0; column < columns; ++column) {
        if (is_reached[place(column)]) {
          continue;
        }
        const double by_here =
            so_far + cost_(from_row, column) - of_rows_[from_row] - of_columns_[column];
        if (by_here < distance[column]) {
          distance[column] = by_here;
          before[place(column)] = from_column;
        }
        if (nearest == none || distance[column] < distance[nearest]) {
          nearest = column;
        }
      }
      so_far = distance[nearest];
      is_reached[place(nearest)] = true;
      from_column = nearest;
      from_row = row_of_[place(nearest)];
    }
    adjust(row, distance, is_reached, so_far);
    for (Eigen::Index column = from_column; column != none;) {
      const Eigen::Index earlier = before[place(column)];
      row_of_[place(column)] = earlier == none ? row : row_of_[place(earlier)];
      column = earlier;
    }
  }

  std::vector<std::size_t> columns() const {
    std::vector<std::size_t> all(static_cast<std::size_t>(cost_.rows()));
    for (std::size_t column = 0; column < row_of_.size(); ++column) {
      if (row_of_[column] != none) {
        all[place(row_of_[column])] = column;
      }
    }
    return all;
  }

 private:
  static std::size_t place(Eigen::Index index) { return static_cast<std::size_t>(index); }

  // Prices at which every assigned column is the cheapest of its row.
  void adjust(Eigen::Index row, const Eigen::VectorXd& distance,
              const std::vector<bool>& is_reached, double length) {
    of_rows_[row] += length;
    for (Eigen::Index column = 0; column < cost_.cols(); ++column) {
      if (!is_reached[place(column)]) {
        continue;
      }
      const double saved = length - distance[column];
      of_columns_[column] -= saved;
      if (row_of_[place(column)] != none) {
        of_rows_[row_of_[place(column)]] += saved;
      }
    }
  }

  const Eigen::MatrixXd& cost_;
  std::vector<Eigen::Index> row_of_;  // of each column
  Eigen::VectorXd of_rows_;
  Eigen::VectorXd of_columns_;
};
}  // namespace

std::vector<std::size_t> least_cost_assignment(const Eigen::MatrixXd& cost) {
  Assigner assigner{cost};
  for (Eigen::Index row = 0; row < cost.rows(); ++row) {
    assigner.add(row);
  }
  return assigner.columns();
}
}  // namespace tapstudy::analysis
