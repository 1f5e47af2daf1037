#include "analysis/modal/modes/assignment.hpp"

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
    Search search{cost_.cols()};
    for (Eigen::Index from_row = row; from_row != none;) {
      const Eigen::Index nearest = nearest_column(from_row, search);
      search.length = search.distance[nearest];
      search.is_reached[place(nearest)] = true;
      search.from_column = nearest;
      from_row = row_of_[place(nearest)];
    }
    adjust(row, search);
    for (Eigen::Index column = search.from_column; column != none;) {
      const Eigen::Index earlier = search.before[place(column)];
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
  struct Search {
    explicit Search(Eigen::Index columns)
        : distance{Eigen::VectorXd::Constant(columns, std::numeric_limits<double>::infinity())},
          before(static_cast<std::size_t>(columns), none),
          is_reached(static_cast<std::size_t>(columns), false) {}
    Eigen::VectorXd distance;          // to each column
    std::vector<Eigen::Index> before;  // the column from which it is reached
    std::vector<bool> is_reached;
    Eigen::Index from_column{none};  // reached last
    double length{0.0};              // of the path to it
  };

  static std::size_t place(Eigen::Index index) { return static_cast<std::size_t>(index); }

  // The nearest of the columns not reached yet, once they can be reached from this row.
  Eigen::Index nearest_column(Eigen::Index from_row, Search& search) const {
    Eigen::Index nearest = none;
    for (Eigen::Index column = 0; column < cost_.cols(); ++column) {
      if (search.is_reached[place(column)]) {
        continue;
      }
      const double by_here =
          search.length + cost_(from_row, column) - of_rows_[from_row] - of_columns_[column];
      if (by_here < search.distance[column]) {
        search.distance[column] = by_here;
        search.before[place(column)] = search.from_column;
      }
      if (nearest == none || search.distance[column] < search.distance[nearest]) {
        nearest = column;
      }
    }
    return nearest;
  }

  // Prices at which every assigned column is the cheapest of its row.
  void adjust(Eigen::Index row, const Search& search) {
    of_rows_[row] += search.length;
    for (Eigen::Index column = 0; column < cost_.cols(); ++column) {
      if (!search.is_reached[place(column)]) {
        continue;
      }
      const double saved = search.length - search.distance[column];
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
