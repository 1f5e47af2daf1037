#include "core/model/shells/shell_element.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
#include "core/model/elements/elastic_stiffness.hpp"
namespace tapstudy::core {
namespace {
constexpr Eigen::Index pair_of(Eigen::Index i, Eigen::Index j) {
  return 3 * i + j;
}

Eigen::Matrix<double, 9, 9> elasticity_of(const Material& material) {
  const ElasticStiffness solid{material};
  Eigen::Matrix<double, 9, 9> elasticity;
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

// The strains 11, 22, 12, 13 and 23, twice those of shear, of a motion along `direction` whose size
// has this gradient, both in the lamina's axes.
Eigen::Matrix<double, 5, 1> strain_of(const Vec3& direction, const Vec3& gradient) {
  Eigen::Matrix<double, 5, 1> strain;
  strain << direction[0] * gradient[0], direction[1] * gradient[1],
      direction[0] * gradient[1] + direction[1] * gradient[0],
      direction[0] * gradient[2] + direction[2] * gradient[0],
      direction[1] * gradient[2] + direction[2] * gradient[1];
  return strain;
}
}  // namespace

// Gauss's points of a square, moved together towards one corner: one degree more.
ShellElements::ShellElements(const Material& material, double thickness_m, int order)
    : elasticity_pa_{elasticity_of(material)},
      density_kg_per_m3_{material.density_kg_per_m3},
      thickness_m_{thickness_m} {
  const auto [at, weights] = gauss_quadrature(order + 1);
  for (Eigen::Index s = 0; s < at.size(); ++s) {
    for (Eigen::Index r = 0; r < at.size(); ++r) {
      const double x = at[s];
      points_.push_back(
          {2.0 * (1.0 - x) * weights[s] * weights[r], functions_at(x, at[r] * (1.0 - x), order)});
    }
  }
}

// The surface at one height in a sheet: rows of `axes` are two directions along it and its normal,
// of `slopes` the gradients of the two shares of corners and of the height, in half thicknesses.
struct ShellElements::Lamina {
  Eigen::Matrix3d axes;
  Eigen::Matrix3d slopes;
  double volume_m3{};  // that the point of integration stands for
};

ShellElements::Lamina ShellElements::lamina_at(const Point& point, double height,
                                               const TriangleSurface::Points& places_m,
                                               const TriangleSurface::Points& directors) const {
  const double half_m = 0.5 * thickness_m_;
  const auto slope = [&](const Eigen::VectorXd& by) -> Vec3 {
    return (places_m.transpose() * by + height * half_m * (directors.transpose() * by));
  };
  Eigen::Matrix3d tangents;
  tangents.col(0) = slope(point.functions.x_slopes);
  tangents.col(1) = slope(point.functions.y_slopes);
  tangents.col(2) = half_m * (directors.transpose() * point.functions.values);
  Lamina lamina;
  lamina.volume_m3 = 0.5 * point.weight * tangents.determinant();
  if (!(lamina.volume_m3 > 0.0)) {
    const Vec3 at_m = places_m.transpose() * point.functions.values;
    throw ModelError{fmt::format(
        "shells: at ({:.4g}, {:.4g}, {:.4g}) m the sheet is bent more tightly than its thickness "
        "allows",
        at_m.x(), at_m.y(), at_m.z())};
  }
  lamina.axes.row(0) = tangents.col(0).normalized().transpose();
  lamina.axes.row(2) = tangents.col(0).cross(tangents.col(1)).normalized().transpose();
  lamina.axes.row(1) = lamina.axes.row(2).cross(lamina.axes.row(0));
  lamina.slopes = tangents.inverse();
  return lamina;
}

// Without stress across the lamina, C_ijkl - C_ij33 C_33kl / C_3333, and with the share of shear.
// Where the material's axes leave the lamina, stretching it shears it across, too: that shear is
// odd in bending, which the director, straight across the sheet, cannot follow. It is free of
// stress, as the faces are: stiffnesses within the lamina are those of the inverse of its
// compliances (Lekhnitskii, Anisotropic Plates, 1968).
Eigen::Matrix<double, 5, 5> ShellElements::elasticity_in(const Eigen::Matrix3d& axes) const {
  constexpr double share_of_shear = 5.0 / 6.0;
  constexpr std::array<Eigen::Index, 5> strains{pair_of(0, 0), pair_of(1, 1), pair_of(0, 1),
                                                pair_of(0, 2), pair_of(1, 2)};
  constexpr Eigen::Index across = pair_of(2, 2);
  Tensor turn;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      turn.row(pair_of(i, j)) =
          (axes.row(i).transpose() * axes.row(j)).reshaped<Eigen::RowMajor>().transpose();
    }
  }
  Tensor turned = turn * elasticity_pa_ * turn.transpose();
  turned -= (turned.col(across) * turned.row(across) / turned(across, across)).eval();
  const Eigen::Matrix<double, 5, 5> elasticity = turned(strains, strains);
  const Eigen::Matrix2d of_shear = elasticity.bottomRightCorner<2, 2>();
  const Eigen::Matrix<double, 3, 2> between = elasticity.topRightCorner<3, 2>();
  Eigen::Matrix<double, 5, 5> result = Eigen::Matrix<double, 5, 5>::Zero();
  result.topLeftCorner<3, 3>() =
      elasticity.topLeftCorner<3, 3>() - between * of_shear.inverse() * between.transpose();
  result.bottomRightCorner<2, 2>() = share_of_shear * of_shear;
  return result;
}

ShellElements::Matrices ShellElements::of(const TriangleSurface::Points& places_m,
                                          const TriangleSurface::Points& directors) const {
  const double gauss_height = 1.0 / std::sqrt(3.0);
  const Eigen::Index count = places_m.rows();
  const auto laminas = static_cast<Eigen::Index>(2 * points_.size());
  Eigen::MatrixXd strains(5 * laminas, shell_unknowns * count);
  Eigen::MatrixXd stresses(5 * laminas, shell_unknowns * count);
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(3 * laminas, shell_unknowns * count);
  Eigen::Index row = 0;
  for (const Point& point : points_) {
    for (const double height : {-gauss_height, gauss_height}) {
      const auto [axes, slopes, volume_m3] = lamina_at(point, height, places_m, directors);
      auto strain = strains.middleRows<5>(5 * row);
      auto motion = motions.middleRows<3>(3 * row);
      const double root_mass = std::sqrt(density_kg_per_m3_ * volume_m3);
      for (Eigen::Index place = 0; place < count; ++place) {
        const double value = point.functions.values[place];
        const Vec3 by_x{point.functions.x_slopes[place], point.functions.y_slopes[place], 0.0};
        const Vec3 of_middle = axes * (slopes.transpose() * by_x);
        const Vec3 of_turn =
            axes * (slopes.transpose() * Vec3{height * by_x[0], height * by_x[1], value});
        const Vec3 director = directors.row(place);
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
          const Eigen::Index middle = shell_unknowns * place + axis;
          const Vec3 beyond = Vec3::Unit(axis).cross(director);
          strain.col(middle) = strain_of(axes.col(axis), of_middle);
          strain.col(middle + 3) = strain_of(axes * beyond, of_turn);
          motion(axis, middle) = root_mass * value;
          motion.col(middle + 3) = root_mass * height * value * beyond;
        }
      }
      stresses.middleRows<5>(5 * row) = volume_m3 * elasticity_in(axes) * strain;
      ++row;
    }
  }
  return {strains.transpose() * stresses, motions.transpose() * motions};
}
}  // namespace tapstudy::core
