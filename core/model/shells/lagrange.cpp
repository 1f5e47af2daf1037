#include "core/model/shells/lagrange.hpp"
namespace tapstudy::core {
namespace {
struct Function {
  double value{1.0};
  double slope{0.0};
};

// The polynomial of degree `steps` that is 1 at l = steps / order and 0 at fewer steps.
Function along(double l, int steps, int order) {
  Function function;
  for (int m = 0; m < steps; ++m) {
    const double factor = (order * l - m) / (m + 1.0);
    function.slope = function.slope * factor + function.value * order / (m + 1.0);
    function.value *= factor;
  }
  return function;
}
}  // namespace

// Products of one polynomial in each barycentric coordinate (Silvester 1969).
Functions functions_at(double x, double y, int order) {
  const Eigen::Index count = places_of_triangle(order);
  Functions functions{Eigen::VectorXd(count), Eigen::VectorXd(count), Eigen::VectorXd(count)};
  for (int j = 0; j <= order; ++j) {
    for (int i = 0; i <= order - j; ++i) {
      const Function a = along(1.0 - x - y, order - i - j, order);
      const Function b = along(x, i, order);
      const Function c = along(y, j, order);
      const Eigen::Index column = column_of(order, i, j);
      const double by_first = a.slope * b.value * c.value;
      functions.values[column] = a.value * b.value * c.value;
      functions.x_slopes[column] = a.value * b.slope * c.value - by_first;
      functions.y_slopes[column] = a.value * b.value * c.slope - by_first;
    }
  }
  return functions;
}
}  // namespace tapstudy::core
