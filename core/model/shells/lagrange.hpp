#pragma once
#include <Eigen/Core>
namespace tapstudy::core {
// Polynomials of one order on a triangle by their values at evenly spaced places. Place (i, j), i
// steps towards the second corner and j towards the third, has the number `column_of`.
constexpr Eigen::Index column_of(Eigen::Index order, Eigen::Index i, Eigen::Index j) {
  return j * (order + 1) - j * (j - 1) / 2 + i;
}
constexpr Eigen::Index places_of_triangle(Eigen::Index order) {
  return column_of(order, 0, order) + 1;
}

// The polynomials that are 1 at one place and 0 at the others, at (x, y): the shares of the second
// and the third corner.
struct Functions {
  Eigen::VectorXd values;
  Eigen::VectorXd x_slopes;
  Eigen::VectorXd y_slopes;
};
Functions functions_at(double x, double y, int order);
}  // namespace tapstudy::core
