#include "core/model/shells/shell_element.hpp"

#include <cmath>

#include "core/algebra/lapack.hpp"
#include "core/model/elements/elastic_stiffness.hpp"
namespace tapstudy::core {
namespace {
using Elasticity = Eigen::Matrix<double, 9, 9>;

constexpr Eigen::Index pair_of(Eigen::Index i, Eigen::Index j) {
  return 3 * i + j;
}

// Without stress across the plate: C_ijkl - C_ij33 C_33kl / C_3333; and with the share of shear.
Elasticity elasticity_of_plate(const Material& material) {
  constexpr double share_of_shear = 5.0 / 6.0;
  const ElasticStiffness solid{material};
  Elasticity elasticity;
  for (Eigen::Index j = 0; j < 3; ++j) {
    for (Eigen::Index l = 0; l < 3; ++l) {
      const Eigen::Matrix3d block =
          solid.block(Eigen::Vector3d::Unit(j) * Eigen::RowVector3d::Unit(l));
      for (Eigen::Index i = 0; i < 3; ++i) {
        for (Eigen::Index k = 0; k < 3; ++k) {
          elasticity(pair_of(i, j), pair_of(k, l)) = block(i, k);
        }
      }
    }
  }
  constexpr Eigen::Index across = pair_of(2, 2);
  elasticity -=
      (elasticity.col(across) * elasticity.row(across) / elasticity(across, across)).eval();
  for (const Eigen::Index axis : {Eigen::Index{0}, Eigen::Index{1}}) {
    for (const Eigen::Index shear : {pair_of(axis, 2), pair_of(2, axis)}) {
      elasticity.row(shear) *= std::sqrt(share_of_shear);
      elasticity.col(shear) *= std::sqrt(share_of_shear);
    }
  }
  return elasticity;
}

struct Quadrature {
  Eigen::VectorXd at;       // in 0 to 1
  Eigen::VectorXd weights;  // of sum 1
};

// Gauss's, of the Legendre polynomials' Jacobi matrix (Golub & Welsch 1969).
Quadrature gauss_quadrature(int points) {
  Eigen::MatrixXd jacobi = Eigen::MatrixXd::Zero(points, points);
  for (int k = 1; k < points; ++k) {
    jacobi(k, k - 1) = k / std::sqrt(4.0 * k * k - 1.0);
  }
  const EigenPairs pairs = symmetric_eigenpairs(jacobi);
  return {(0.5 * (1.0 + pairs.values.array())).matrix(),
          pairs.vectors.row(0).array().square().matrix().transpose()};
}

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

struct Functions {
  Eigen::VectorXd values;
  std::array<Eigen::VectorXd, 3> slopes;  // by the barycentric coordinates
};

// Lagrange's on the lattice: products of one polynomial in each coordinate (Silvester 1969).
Functions functions_at(const Eigen::Vector3d& l, const Lattice& lattice) {
  const int order = lattice.order;
  const Eigen::Index count = lattice.places_of_triangle();
  Functions functions{Eigen::VectorXd(count),
                      {Eigen::VectorXd(count), Eigen::VectorXd(count), Eigen::VectorXd(count)}};
  for (int j = 0; j <= order; ++j) {
    for (int i = 0; i <= order - j; ++i) {
      const Function a = along(l[0], order - i - j, order);
      const Function b = along(l[1], i, order);
      const Function c = along(l[2], j, order);
      const Eigen::Index column = lattice.column_of(i, j);
      functions.values[column] = a.value * b.value * c.value;
      functions.slopes[0][column] = a.slope * b.value * c.value;
      functions.slopes[1][column] = a.value * b.slope * c.value;
      functions.slopes[2][column] = a.value * b.value * c.slope;
    }
  }
  return functions;
}
}  // namespace

ShellElements::ShellElements(const Material& material, double thickness_m, int order)
    : elasticity_pa_{elasticity_of_plate(material)},
      density_kg_per_m3_{material.density_kg_per_m3},
      thickness_m_{thickness_m},
      integrals_{integrals_of(order)} {}

// Gauss's points of a square, moved together towards one corner: one degree more.
ShellElements::Integrals ShellElements::integrals_of(int order) {
  const Quadrature quadrature = gauss_quadrature(order + 1);
  const Lattice lattice{order, {}, {}};
  const Eigen::Index count = lattice.places_of_triangle();
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(count, count);
  Integrals integrals{zero, {zero, zero, zero}, {}};
  integrals.slopes.fill({zero, zero, zero});
  for (Eigen::Index s = 0; s < quadrature.at.size(); ++s) {
    for (Eigen::Index r = 0; r < quadrature.at.size(); ++r) {
      const double x = quadrature.at[s];
      const double y = quadrature.at[r] * (1.0 - x);
      const double weight = 2.0 * (1.0 - x) * quadrature.weights[s] * quadrature.weights[r];
      const auto [values, slopes] = functions_at({1.0 - x - y, x, y}, lattice);
      integrals.values += weight * values * values.transpose();
      for (std::size_t i = 0; i < 3; ++i) {
        integrals.slopes_by_values.at(i) += weight * slopes.at(i) * values.transpose();
        for (std::size_t j = 0; j < 3; ++j) {
          integrals.slopes.at(i).at(j) += weight * slopes.at(i) * slopes.at(j).transpose();
        }
      }
    }
  }
  return integrals;
}

// Along which axis an unknown moves, and whether in proportion to the height over the middle.
struct ShellElements::Motion {
  Eigen::Index axis{};
  bool is_bending{};
};

// The integrals through the thickness t: of 1 by 1, 1 by the slope 2 / t of the height over half of
// t, and of this height and its slope by themselves.
Eigen::MatrixXd ShellElements::stiffness_of(const Motion& a, const Motion& b,
                                            const InPlane& integrals) const {
  constexpr Eigen::Index z = 2;
  const auto modulus_pa = [&](Eigen::Index i, Eigen::Index j) {
    return elasticity_pa_(pair_of(a.axis, i), pair_of(b.axis, j));
  };
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(integrals.values.rows(), integrals.values.cols());
  for (std::size_t i = 0; i < 2; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (a.is_bending && !b.is_bending) {
      block += 2.0 * modulus_pa(z, row) * integrals.slopes_by_values.at(i).transpose();
    } else if (b.is_bending && !a.is_bending) {
      block += 2.0 * modulus_pa(row, z) * integrals.slopes_by_values.at(i);
    } else {
      const double height_m = a.is_bending ? thickness_m_ / 3.0 : thickness_m_;
      block += height_m * (modulus_pa(row, 0) * integrals.slopes.at(i).at(0) +
                           modulus_pa(row, 1) * integrals.slopes.at(i).at(1));
    }
  }
  if (a.is_bending && b.is_bending) {
    block += 4.0 / thickness_m_ * modulus_pa(z, z) * integrals.values;
  }
  return block;
}

ShellElements::InPlane ShellElements::in_plane(const Corners& corners_m) const {
  const Eigen::RowVector2d to_second = corners_m.row(1) - corners_m.row(0);
  const Eigen::RowVector2d to_third = corners_m.row(2) - corners_m.row(0);
  const double twice_m2 = to_second[0] * to_third[1] - to_second[1] * to_third[0];
  Corners gradients;  // of the barycentric coordinates
  gradients << to_second[1] - to_third[1], to_third[0] - to_second[0],  //
      to_third[1], -to_third[0],                                        //
      -to_second[1], to_second[0];
  gradients /= twice_m2;
  const double area_m2 = 0.5 * twice_m2;
  const Eigen::MatrixXd zero =
      Eigen::MatrixXd::Zero(integrals_.values.rows(), integrals_.values.cols());
  InPlane integrals{area_m2 * integrals_.values, {zero, zero}, {}};
  integrals.slopes.fill({zero, zero});
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double slope = area_m2 * gradients(static_cast<Eigen::Index>(i),  //
                                               static_cast<Eigen::Index>(axis));
      integrals.slopes_by_values.at(axis) += slope * integrals_.slopes_by_values.at(i);
      for (std::size_t j = 0; j < 3; ++j) {
        const auto row = static_cast<Eigen::Index>(j);
        integrals.slopes.at(axis).at(0) +=
            slope * gradients(row, 0) * integrals_.slopes.at(i).at(j);
        integrals.slopes.at(axis).at(1) +=
            slope * gradients(row, 1) * integrals_.slopes.at(i).at(j);
      }
    }
  }
  return integrals;
}

ShellElements::Matrices ShellElements::of(const Corners& corners_m) const {
  constexpr std::array<Motion, shell_unknowns> motions{
      {{0, false}, {1, false}, {2, false}, {0, true}, {1, true}}};
  const InPlane integrals = in_plane(corners_m);
  const Eigen::Index count = integrals.values.rows();
  const Eigen::MatrixXd zero =
      Eigen::MatrixXd::Zero(shell_unknowns * count, shell_unknowns * count);
  Matrices element{zero, zero};
  const auto all_of = [count](std::size_t unknown) {
    return Eigen::seqN(static_cast<Eigen::Index>(unknown), count, Eigen::fix<shell_unknowns>);
  };
  for (std::size_t a = 0; a < motions.size(); ++a) {
    for (std::size_t b = 0; b < motions.size(); ++b) {
      element.stiffness(all_of(a), all_of(b)) =
          stiffness_of(motions.at(a), motions.at(b), integrals);
    }
    const double height_m = motions.at(a).is_bending ? thickness_m_ / 3.0 : thickness_m_;
    element.mass(all_of(a), all_of(a)) = density_kg_per_m3_ * height_m * integrals.values;
  }
  return element;
}
}  // namespace tapstudy::core
