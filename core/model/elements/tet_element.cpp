#include "core/model/elements/tet_element.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <vector>

#include "core/model/mesh/tet_mesh.hpp"
namespace tapstudy::core {
namespace {
template <int Nodes>
using Gradients = Eigen::Matrix<double, Nodes, 3>;  // one node's shape function per row [1/m]

template <int Nodes>
void add_stiffness(const Gradients<Nodes>& gradients, const ElasticStiffness& elasticity,
                   double volume, TetElement<Nodes>& element) {
  for (Eigen::Index b = 0; b < Nodes; ++b) {
    const Eigen::RowVector3d gb = volume * gradients.row(b);
    for (Eigen::Index a = b; a < Nodes; ++a) {
      element.stiffness.template block<3, 3>(3 * a, 3 * b) +=
          elasticity.block(gradients.row(a).transpose() * gb);
    }
  }
}

template <int Nodes>
void mirror_lower(TetElement<Nodes>& element) {
  element.stiffness.template triangularView<Eigen::StrictlyUpper>() = element.stiffness.transpose();
}

// T10's shape functions are l_i (2 l_i - 1) at corners and 4 l_i l_j on edges; their gradients at
// the barycentric point l, from those of l.
Gradients<10> quadratic_gradients(const Eigen::Vector4d& l, const Gradients<4>& linear) {
  Gradients<10> gradients;
  for (Eigen::Index i = 0; i < 4; ++i) {
    gradients.row(i) = (4.0 * l[i] - 1.0) * linear.row(i);
  }
  for (std::size_t e = 0; e < tet_edges.size(); ++e) {
    const auto [i, j] = tet_edges.at(e);
    gradients.row(static_cast<Eigen::Index>(4 + e)) =
        4.0 * (l[j] * linear.row(i) + l[i] * linear.row(j));
  }
  return gradients;
}

// The integrals of N_a N_b over a tetrahedron of volume 420, from the formula
// integral of L1^p L2^q L3^r L4^s = 6 V p! q! r! s! / (p+q+r+s+3)!
Eigen::Matrix<double, 10, 10> quadratic_mass() {
  Eigen::Matrix<double, 10, 10> mass;
  mass << 6, 1, 1, 1, -4, -6, -4, -4, -6, -6,  //
      1, 6, 1, 1, -4, -4, -6, -6, -4, -6,      //
      1, 1, 6, 1, -6, -4, -4, -6, -6, -4,      //
      1, 1, 1, 6, -6, -6, -6, -4, -4, -4,      //
      -4, -4, -6, -6, 32, 16, 16, 16, 16, 8,   //
      -6, -4, -4, -6, 16, 32, 16, 8, 16, 16,   //
      -4, -6, -4, -6, 16, 16, 32, 16, 8, 16,   //
      -4, -6, -6, -4, 16, 8, 16, 32, 16, 16,   //
      -6, -4, -6, -4, 16, 16, 8, 16, 32, 16,   //
      -6, -6, -4, -4, 8, 16, 16, 16, 16, 32;
  return mass;
}

struct Geometry {
  double volume_m3;
  Gradients<4> gradients;  // of the barycentric coordinates
};

// The shape functions are L_i = a_i + b_i x + c_i y + d_i z.
Geometry geometry_of(const TetCorners& corners_m) {
  Eigen::Matrix4d coordinates;
  coordinates << Eigen::Vector4d::Ones(), corners_m;
  return {coordinates.determinant() / 6.0, coordinates.inverse().bottomRows<3>().transpose()};
}
}  // namespace

template <>
TetElement<4> tet_element<4>(const TetCorners& corners_m, const ElasticStiffness& elasticity,
                             double density_kg_per_m3) {
  const auto [volume, gradients] = geometry_of(corners_m);
  TetElement<4> element;
  element.stiffness.setZero();
  add_stiffness<4>(gradients, elasticity, volume, element);
  mirror_lower(element);
  element.mass.setOnes();
  element.mass.diagonal().setConstant(2.0);
  element.mass *= density_kg_per_m3 * volume / 20.0;
  return element;
}

// The integrand is quadratic over the element: four-point quadrature is exact.
template <>
TetElement<10> tet_element<10>(const TetCorners& corners_m, const ElasticStiffness& elasticity,
                               double density_kg_per_m3) {
  const auto [volume, gradients] = geometry_of(corners_m);
  const double near = (5.0 + 3.0 * std::sqrt(5.0)) / 20.0;
  const double far = (5.0 - std::sqrt(5.0)) / 20.0;
  TetElement<10> element;
  element.stiffness.setZero();
  for (Eigen::Index point = 0; point < 4; ++point) {
    Eigen::Vector4d l = Eigen::Vector4d::Constant(far);
    l[point] = near;
    add_stiffness<10>(quadratic_gradients(l, gradients), elasticity, 0.25 * volume, element);
  }
  mirror_lower(element);
  static const Eigen::Matrix<double, 10, 10> mass = quadratic_mass();
  element.mass = density_kg_per_m3 * volume / 420.0 * mass;
  return element;
}

namespace {
// A polynomial in the barycentric coordinates: the sum of factor l_0^p l_1^q l_2^r l_3^s.
struct Term {
  double factor{};
  std::array<int, 4> powers{};
};
using Polynomial = std::vector<Term>;

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial result;
  for (const Term& x : a) {
    for (const Term& y : b) {
      Term term{x.factor * y.factor, x.powers};
      for (std::size_t i = 0; i < 4; ++i) {
        term.powers.at(i) += y.powers.at(i);
      }
      result.push_back(term);
    }
  }
  return result;
}

Polynomial derivative(const Polynomial& of, std::size_t along) {
  Polynomial result;
  for (Term term : of) {
    term.factor *= term.powers.at(along);
    term.powers.at(along) -= 1;
    if (term.factor != 0.0) {
      result.push_back(term);
    }
  }
  return result;
}

// Over a tetrahedron of volume 1: 6 p! q! r! s! / (p + q + r + s + 3)! for each term.
double integral(const Polynomial& of) {
  double sum = 0.0;
  for (const auto& [factor, powers] : of) {
    double numerator = 6.0;
    int all = 3;
    for (const int power : powers) {
      numerator *= std::tgamma(power + 1.0);
      all += power;
    }
    sum += factor * numerator / std::tgamma(all + 1.0);
  }
  return sum;
}

Polynomial coordinate(int corner, double factor = 1.0) {
  Term term{factor, {}};
  term.powers.at(static_cast<std::size_t>(corner)) = 1;
  return {term};
}

std::vector<Polynomial> cubic_functions() {
  std::vector<Polynomial> functions;
  for (int i = 0; i < 4; ++i) {
    functions.push_back(product(coordinate(i), {coordinate(i, 2.0)[0], {-1.0, {}}}));
  }
  for (const auto& [i, j] : tet_edges) {
    functions.push_back(product(coordinate(i, 4.0), coordinate(j)));
  }
  for (const auto& [i, j] : tet_edges) {
    functions.push_back(
        product(product(coordinate(i), coordinate(j)), {coordinate(i)[0], coordinate(j, -1.0)[0]}));
  }
  for (const auto& [i, j, k] : tet_faces) {
    functions.push_back(product(product(coordinate(i), coordinate(j)), coordinate(k)));
  }
  return functions;
}

// What the element matrices have in common, for a tetrahedron of volume 1: the integrals of
// N_a N_b, and of the derivatives of N_a by l_i times that of N_b by l_j.
struct CubicIntegrals {
  Eigen::Matrix<double, 20, 20> mass;
  std::array<std::array<Eigen::Matrix4d, 20>, 20> slopes;
};

CubicIntegrals cubic_integrals() {
  const std::vector<Polynomial> functions = cubic_functions();
  CubicIntegrals result;
  for (std::size_t a = 0; a < 20; ++a) {
    for (std::size_t b = 0; b < 20; ++b) {
      result.mass(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) =
          integral(product(functions[a], functions[b]));
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
          result.slopes.at(a).at(b)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
              integral(product(derivative(functions[a], i), derivative(functions[b], j)));
        }
      }
    }
  }
  return result;
}
}  // namespace

template <>
TetElement<20> tet_element<20>(const TetCorners& corners_m, const ElasticStiffness& elasticity,
                               double density_kg_per_m3) {
  static const CubicIntegrals integrals = cubic_integrals();
  const auto [volume, gradients] = geometry_of(corners_m);
  TetElement<20> element;
  for (Eigen::Index b = 0; b < 20; ++b) {
    for (Eigen::Index a = b; a < 20; ++a) {
      const Eigen::Matrix4d& slopes =
          integrals.slopes.at(static_cast<std::size_t>(a)).at(static_cast<std::size_t>(b));
      element.stiffness.block<3, 3>(3 * a, 3 * b) =
          elasticity.block(volume * gradients.transpose() * slopes * gradients);
    }
  }
  mirror_lower(element);
  element.mass = density_kg_per_m3 * volume * integrals.mass;
  return element;
}
}  // namespace tapstudy::core
