#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/model/elements/material.hpp"
#include "core/model/shells/triangulation.hpp"
namespace tapstudy::core {
// The unknowns of a shell at each place of its lattice: the displacement of the middle surface
// along x, y and z, and what the upper surface's has beyond it along x and y. Displacements vary
// linearly through the thickness, and along z not at all (Reissner 1945, Mindlin 1951, with the
// motion in the plane): no stress across, and 5/6 of the energy of transverse shear, whose stress
// is a parabola.
inline constexpr int shell_unknowns = 5;

// Flat triangles of polynomials of one order for all unknowns. From order 4 on these hold smooth
// deflections whose shear vanishes, so that thin plates do not lock (Suri, Babuška & Schwab 1995,
// Locking effects in the finite element approximation of plate models).
class ShellElements {
 public:
  ShellElements(const Material& material, double thickness_m, int order);

  // Of the unknowns of each place in turn; integrated exactly.
  struct Matrices {
    Eigen::MatrixXd stiffness;  // N/m
    Eigen::MatrixXd mass;       // kg
  };
  using Corners = Eigen::Matrix<double, 3, 2>;
  Matrices of(const Corners& corners_m) const;

 private:
  // Of the functions N of a triangle of area 1 and their derivatives by its barycentric
  // coordinates: the integrals of N_a N_b, d_i N_a N_b and d_i N_a d_j N_b.
  struct Integrals {
    Eigen::MatrixXd values;
    std::array<Eigen::MatrixXd, 3> slopes_by_values;
    std::array<std::array<Eigen::MatrixXd, 3>, 3> slopes;
  };
  static Integrals integrals_of(int order);
  // Of one triangle, its derivatives along x and y.
  struct InPlane {
    Eigen::MatrixXd values;
    std::array<Eigen::MatrixXd, 2> slopes_by_values;
    std::array<std::array<Eigen::MatrixXd, 2>, 2> slopes;
  };
  InPlane in_plane(const Corners& corners_m) const;
  struct Motion;
  Eigen::MatrixXd stiffness_of(const Motion& a, const Motion& b, const InPlane& integrals) const;

  Eigen::Matrix<double, 9, 9> elasticity_pa_;  // C_ijkl, row 3 i + j, column 3 k + l
  double density_kg_per_m3_;
  double thickness_m_;
  Integrals integrals_;
};
}  // namespace tapstudy::core
