// The free cube by the Ritz method that Demarest 1971 (J. Acoust. Soc. Am. 49, 768) introduced for
// it: displacements as products of Legendre polynomials, whose integrals have closed forms.
#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <vector>

#include "core/model/plate_model.hpp"
#include "support/catch.hpp"
using namespace tapstudy;

namespace {
constexpr int highest_degree = 11;

// Over [-1, 1]: of P_i P_j, P_i P_j', P_i' P_j, P_i' P_j'.
double integral(int i, bool is_derived_i, int j, bool is_derived_j) {
  const bool is_even = (i + j) % 2 == 0;
  if (is_derived_i && is_derived_j) {
    const int least = std::min(i, j);
    return is_even ? least * (least + 1.0) : 0.0;
  }
  if (is_derived_j) {
    return i < j && !is_even ? 2.0 : 0.0;
  }
  if (is_derived_i) {
    return integral(j, false, i, true);
  }
  return i == j ? 2.0 / (2.0 * i + 1.0) : 0.0;
}

using Degrees = std::array<int, 3>;

// Of one function derived along axis a times another derived along b; -1: not derived.
double integral(const Degrees& f, int a, const Degrees& g, int b) {
  double product = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    product *= integral(f.at(i), axis == a, g.at(i), axis == b);
  }
  return product;
}

std::vector<Degrees> basis() {
  std::vector<Degrees> all;
  for (int i = 0; i <= highest_degree; ++i) {
    for (int j = 0; i + j <= highest_degree; ++j) {
      for (int k = 0; i + j + k <= highest_degree; ++k) {
        all.push_back({i, j, k});
      }
    }
  }
  return all;
}

// Natural angular frequencies [rad/s], the six zero ones included, of a cube of 2 m side with
// density 1, by Hooke's law between every two functions and axes.
Eigen::ArrayXd free_cube(double lambda, double shear) {
  const std::vector<Degrees> functions = basis();
  const auto count = static_cast<Eigen::Index>(functions.size());
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(3 * count, 3 * count);
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(3 * count, 3 * count);
  for (Eigen::Index m = 0; m < count; ++m) {
    for (Eigen::Index n = 0; n < count; ++n) {
      const Degrees& f = functions[static_cast<std::size_t>(m)];
      const Degrees& g = functions[static_cast<std::size_t>(n)];
      const double laplace = integral(f, 0, g, 0) + integral(f, 1, g, 1) + integral(f, 2, g, 2);
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
          stiffness(a * count + m, b * count + n) = lambda * integral(f, a, g, b) +
                                                    shear * integral(f, b, g, a) +
                                                    (a == b ? shear * laplace : 0.0);
        }
        mass(a * count + m, a * count + n) = integral(f, -1, g, -1);
      }
    }
  }
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>{stiffness, mass,
                                                                   Eigen::EigenvaluesOnly}
      .eigenvalues()
      .array()
      .max(0.0)
      .sqrt();
}
}  // namespace

TEST_CASE("a free cube rings as Demarest's Ritz method says, mode by mode", "[core][model][slow]") {
  const double poisson = GENERATE(0.0, 0.3);
  const core::Material material{1.0, 1.0, poisson, {}};
  core::PlateSpec cube{{core::Box{{2.0, 2.0, 2.0}}, {}, {}}, material, 0.32};
  cube.mesh.order = 2;
  cube.mesh.size.max_tet_volume_m3 = 8.0 / 2000.0;
  const core::PlateModel ours = core::build_plate_model(cube);
  CHECK(ours.body.modes.report.rigid_body_modes == 6);
  const Eigen::Index modes = ours.modal.frequency_hz.size();
  REQUIRE(modes >= 10);
  const double shear = 1.0 / (2.0 * (1.0 + poisson));
  const Eigen::ArrayXd ritz =
      free_cube(poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), shear) / (2.0 * M_PI);
  for (Eigen::Index i = 0; i < modes; ++i) {
    CAPTURE(poisson, i, ours.modal.frequency_hz[i]);
    // both come from above (Rayleigh); the polynomials have settled to 1e-4
    CHECK(ours.modal.frequency_hz[i] > (1.0 - 1e-4) * ritz[i + 6]);
    CHECK(ours.modal.frequency_hz[i] < 1.002 * ritz[i + 6]);
  }
}
