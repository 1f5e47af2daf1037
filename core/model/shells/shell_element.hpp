#pragma once
#include <Eigen/Core>
#include <vector>

#include "core/model/elements/material.hpp"
#include "core/model/shells/lagrange.hpp"
#include "core/model/shells/triangulation.hpp"
namespace tapstudy::core {
// The unknowns of a shell at each place of its lattice: the displacement of its middle along x, y
// and z, and by which vector it turns times half of its thickness; the upper face moves beyond the
// middle by that vector's cross product with the normal. What turns about the normal moves nothing.
inline constexpr int shell_unknowns = 6;

// Degenerated solid elements (Ahmad, Irons & Zienkiewicz 1970, Analysis of thick and thin shell
// structures by curved finite elements): triangles, flat or curved, of polynomials of one order for
// places, normals and unknowns. Displacements vary linearly through the thickness; no stress across
// it, and 5/6 of the energy of transverse shear, whose stress is a parabola: of a flat sheet
// Reissner's and Mindlin's plate with the motion in its plane. From order 4 on these hold smooth
// deflections whose shear vanishes, so that thin plates do not lock (Suri, Babuška & Schwab 1995,
// Locking effects in the finite element approximation of plate models). Motions of the rigid body
// are without strain.
class ShellElements {
 public:
  ShellElements(const Material& material, double thickness_m, int order);

  // Of the unknowns of each place in turn; of flat triangles integrated exactly.
  struct Matrices {
    Eigen::MatrixXd stiffness;  // N/m
    Eigen::MatrixXd mass;       // kg
  };
  // Throws ModelError where the sheet is bent more tightly than its thickness allows.
  Matrices of(const TriangleSurface::Points& places_m,
              const TriangleSurface::Points& directors) const;

 private:
  using Tensor = Eigen::Matrix<double, 9, 9>;  // C_ijkl, row 3 i + j, column 3 k + l
  struct Point {
    double weight;  // of a triangle's area of 1
    Functions functions;
  };
  struct Lamina;
  Lamina lamina_at(const Point& point, double height, const TriangleSurface::Points& places_m,
                   const TriangleSurface::Points& directors) const;
  Eigen::Matrix<double, 5, 5> elasticity_in(const Eigen::Matrix3d& axes) const;

  Tensor elasticity_pa_;
  double density_kg_per_m3_;
  double thickness_m_;
  std::vector<Point> points_;
};
}  // namespace tapstudy::core
