#include "analysis/modal/response/normal_equations.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include "core/algebra/lapack.hpp"
namespace tapstudy::analysis {
double AngleMap::angle(double frequency_hz) const {
  return std::numbers::pi * (frequency_hz - low_hz) / (high_hz - low_hz);
}

std::complex<double> AngleMap::pole_of_root(const std::complex<double>& root) const {
  const std::complex<double> log = std::log(root) * 2.0 * (high_hz - low_hz);
  return log + std::complex<double>{0.0, 2.0 * std::numbers::pi * low_hz};
}

namespace {
// cos and sin of all multiples 0 ... order of the lines' angles: a row for each line.
struct Harmonics {
  Eigen::MatrixXd cosines;
  Eigen::MatrixXd sines;
};

Harmonics harmonics_of(const Eigen::ArrayXd& frequency_hz, int order) {
  const AngleMap map{frequency_hz[0], frequency_hz[frequency_hz.size() - 1]};
  Harmonics harmonics{Eigen::MatrixXd(frequency_hz.size(), order + 1),
                      Eigen::MatrixXd(frequency_hz.size(), order + 1)};
  for (Eigen::Index line = 0; line < frequency_hz.size(); ++line) {
    const double angle = map.angle(frequency_hz[line]);
    for (Eigen::Index k = 0; k <= order; ++k) {
      harmonics.cosines(line, k) = std::cos(static_cast<double>(k) * angle);
      harmonics.sines(line, k) = std::sin(static_cast<double>(k) * angle);
    }
  }
  return harmonics;
}

// Re sum over lines of v z^l for l = -order ... order, of columns v.
class LagSums {
 public:
  LagSums(const Harmonics& harmonics, const Eigen::MatrixXcd& columns)
      : even_{harmonics.cosines.transpose() * columns.real()},
        odd_{harmonics.sines.transpose() * columns.imag()} {}
  double at(Eigen::Index column, Eigen::Index lag) const {
    return lag < 0 ? even_(-lag, column) + odd_(-lag, column)
                   : even_(lag, column) - odd_(lag, column);
  }

 private:
  Eigen::MatrixXd even_;
  Eigen::MatrixXd odd_;
};

// The lower triangular L with L L' = R. What rounding makes of a singular R is held above 0.
Eigen::MatrixXd cholesky(Eigen::MatrixXd R) {
  const Eigen::Index n = R.rows();
  const double least = 1e-13 * R(0, 0);
  for (Eigen::Index k = 0; k < n; ++k) {
    R(k, k) = std::sqrt(std::max(R(k, k), least));
    R.col(k).tail(n - k - 1) /= R(k, k);
    for (Eigen::Index j = k + 1; j < n; ++j) {
      R.col(j).tail(n - j) -= R(j, k) * R.col(k).tail(n - j);
    }
  }
  return R;
}

void solve_lower(const Eigen::MatrixXd& L, Eigen::MatrixXd& columns) {
  for (Eigen::Index k = 0; k < L.rows(); ++k) {
    columns.row(k) /= L(k, k);
    const Eigen::Index below = L.rows() - k - 1;
    columns.bottomRows(below).noalias() -= L.col(k).tail(below) * columns.row(k);
  }
}

// Of each output a row of responses, divided by its root mean square.
Eigen::MatrixXcd scaled_outputs(const FrequencyResponses& responses, const ResponseGrid& grid) {
  const auto inputs = std::ssize(grid.columns.front());
  Eigen::MatrixXcd outputs(responses.values.rows(), inputs * std::ssize(grid.columns));
  Eigen::Index at = 0;
  for (const std::vector<Eigen::Index>& columns : grid.columns) {
    outputs.middleCols(at, inputs) = responses.values(Eigen::all, columns);
    outputs.middleCols(at, inputs) /= outputs.middleCols(at, inputs).norm();
    at += inputs;
  }
  return outputs;
}

Eigen::MatrixXcd products_of_inputs(const Eigen::MatrixXcd& outputs, Eigen::Index inputs) {
  Eigen::MatrixXcd products = Eigen::MatrixXcd::Zero(outputs.rows(), inputs * inputs);
  for (Eigen::Index at = 0; at < outputs.cols(); at += inputs) {
    for (Eigen::Index r = 0; r < inputs; ++r) {
      for (Eigen::Index s = 0; s < inputs; ++s) {
        products.col(r * inputs + s) +=
            outputs.col(at + r).conjugate().cwiseProduct(outputs.col(at + s));
      }
    }
  }
  return products;
}

// L^-1 S_o of all outputs side by side.
Eigen::MatrixXd reduced_numerators(const Harmonics& harmonics, const Eigen::MatrixXcd& outputs,
                                   Eigen::Index inputs, Eigen::Index powers) {
  const LagSums sums{harmonics, outputs};
  const LagSums ones{harmonics, Eigen::MatrixXcd::Ones(outputs.rows(), 1)};
  Eigen::MatrixXd R(powers, powers);
  for (Eigen::Index j = 0; j < powers; ++j) {
    for (Eigen::Index k = 0; k < powers; ++k) {
      R(j, k) = ones.at(0, k - j);
    }
  }
  const Eigen::Index outputs_count = outputs.cols() / inputs;
  Eigen::MatrixXd S(powers, powers * outputs.cols());
  for (Eigen::Index o = 0; o < outputs_count; ++o) {
    for (Eigen::Index k = 0; k < powers; ++k) {
      for (Eigen::Index r = 0; r < inputs; ++r) {
        for (Eigen::Index j = 0; j < powers; ++j) {
          S(j, (o * powers + k) * inputs + r) = -sums.at(o * inputs + r, k - j);
        }
      }
    }
  }
  solve_lower(cholesky(R), S);
  return S;
}

Eigen::MatrixXd squares_of_denominator(const Harmonics& harmonics, const Eigen::MatrixXcd& outputs,
                                       Eigen::Index inputs, Eigen::Index powers) {
  const LagSums sums{harmonics, products_of_inputs(outputs, inputs)};
  Eigen::MatrixXd T(powers * inputs, powers * inputs);
  for (Eigen::Index j = 0; j < powers; ++j) {
    for (Eigen::Index k = 0; k < powers; ++k) {
      for (Eigen::Index r = 0; r < inputs; ++r) {
        for (Eigen::Index s = 0; s < inputs; ++s) {
          T(j * inputs + r, k * inputs + s) = sums.at(r * inputs + s, k - j);
        }
      }
    }
  }
  return T;
}

// A_1 ... of A_0 = 1.
Eigen::MatrixXd monic_solution(const Eigen::MatrixXd& D, Eigen::Index inputs) {
  const Eigen::Index unknowns = D.rows() - inputs;
  return -core::pseudo_inverse(D.bottomRightCorner(unknowns, unknowns)) *
         D.bottomLeftCorner(unknowns, inputs);
}
}  // namespace

NormalEquations::NormalEquations(const FrequencyResponses& responses, const ResponseGrid& grid,
                                 int max_order)
    : inputs_{std::ssize(grid.columns.front())} {
  const Eigen::Index powers = max_order + 1;
  const Harmonics harmonics = harmonics_of(responses.frequency_hz, max_order);
  const Eigen::MatrixXcd outputs = scaled_outputs(responses, grid);
  const Eigen::MatrixXd reduced = reduced_numerators(harmonics, outputs, inputs_, powers);
  Eigen::MatrixXd D = squares_of_denominator(harmonics, outputs, inputs_, powers);
  const Eigen::Index of_output = powers * inputs_;
  Eigen::MatrixXd row(std::ssize(grid.columns), of_output);
  for (Eigen::Index power = 0; power < powers; ++power) {
    // L of a lower order is a corner of L: a further power adds one row of L^-1 S_o
    for (Eigen::Index o = 0; o < row.rows(); ++o) {
      row.row(o) = reduced.row(power).segment(o * of_output, of_output);
    }
    D.noalias() -= row.transpose() * row;
    if (power > 0) {
      const Eigen::Index size = (power + 1) * inputs_;
      denominators_.push_back(monic_solution(D.topLeftCorner(size, size), inputs_));
    }
  }
}
}  // namespace tapstudy::analysis
