// The estimate of a model's discretisation error, by elements of the next order.
#include "core/model/error_estimate.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/algebra/dense_solvers.hpp"
#include "core/model/elements/enrichment.hpp"
#include "core/model/elements/tet_element.hpp"
#include "core/model/joints/joints.hpp"
#include "core/model/model_cache.hpp"
#include "core/model/plate_model.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
#include "support/surfaces.hpp"
using namespace tapstudy;
using namespace tapstudy::core;

namespace {
Fixation clamped(Side which) {
  Fixation fixation;
  fixation.shape = RegionShape::side;
  fixation.side = which;
  return fixation;
}
struct Body {
  const char* name;
  Shape shape;
  int order;
  MeshSize size;
  std::vector<Fixation> fixations;
  Material material;
  double band_limit_hz;
  double fine_tet_m3;  // of the reference
  PlateSpec spec() const { return {{shape, {size, order}, fixations}, material, band_limit_hz}; }
};
Material of(double youngs_modulus_pa, double density, double poisson) {
  return {youngs_modulus_pa, density, poisson, ConstantDamping{0.02}};
}
MeshSize up_to(double volume_m3, double flattening = 1.0) {
  return {1.414, volume_m3, flattening};
}
const Material mdf = of(2.5e9, 610.0, 0.25);
const Material aluminium = of(7e10, 2700.0, 0.33);

// A cubic displacement field of a tetrahedron, u = (x^2 y, y z^2 - x^3, x y z), its gradient, and
// the functions of TetElement<20> by their definition.
Eigen::Vector3d field(const Eigen::Vector3d& p) {
  const double x = p.x();
  const double y = p.y();
  const double z = p.z();
  return {x * x * y, y * z * z - x * x * x, x * y * z};
}
Eigen::Matrix3d slope(const Eigen::Vector3d& p) {
  const double x = p.x();
  const double y = p.y();
  const double z = p.z();
  Eigen::Matrix3d g;
  g << 2 * x * y, x * x, 0, -3 * x * x, z * z, 2 * y * z, y * z, x * z, x * y;
  return g;
}
Eigen::RowVectorXd functions(const Eigen::Vector4d& l) {
  Eigen::RowVectorXd n(20);
  for (Eigen::Index i = 0; i < 4; ++i) {
    n[i] = l[i] * (2.0 * l[i] - 1.0);
  }
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [i, j] = tet_edges.at(e);
    n[static_cast<Eigen::Index>(4 + e)] = 4.0 * l[i] * l[j];
    n[static_cast<Eigen::Index>(10 + e)] = l[i] * l[j] * (l[i] - l[j]);
  }
  for (std::size_t f = 0; f < 4; ++f) {
    const auto [i, j, k] = tet_faces.at(f);
    n[static_cast<Eigen::Index>(16 + f)] = l[i] * l[j] * l[k];
  }
  return n;
}
}  // namespace

TEST_CASE("a cubic displacement stores its exact energies in an element of order 3",
          "[core][element]") {
  TetCorners corners;
  corners << 0.1, 0.0, 0.02, 1.1, 0.1, 0.0, 0.3, 0.9, -0.1, 0.2, 0.3, 0.7;
  const TetElement<20> element =
      tet_element<20>(corners, core::ElasticStiffness{mdf}, mdf.density_kg_per_m3);
  const double lambda = mdf.youngs_modulus_pa * 0.25 / (1.25 * 0.5);
  const double shear = mdf.youngs_modulus_pa / 2.5;
  // Gauss's rule of five points a direction, in the collapsed coordinates of Stroud (1971).
  const std::array<double, 5> at{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                 0.9061798459386640};
  const std::array<double, 5> weight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                     0.4786286704993665, 0.2369268850561891};
  const double volume =
      std::abs((corners.bottomRows<3>().rowwise() - corners.row(0)).determinant()) / 6.0;
  double strain_j = 0.0;
  double kinetic_j = 0.0;
  Eigen::MatrixXd fit(125, 20);
  Eigen::MatrixXd values(125, 3);
  Eigen::Index row = 0;
  for (std::size_t a = 0; a < 5; ++a) {
    for (std::size_t b = 0; b < 5; ++b) {
      for (std::size_t c = 0; c < 5; ++c, ++row) {
        const double u = 0.5 + 0.5 * at[a];
        const double v = 0.5 + 0.5 * at[b];
        const double w = 0.5 + 0.5 * at[c];
        const Eigen::Vector4d l{u, v * (1 - u), w * (1 - u) * (1 - v), (1 - u) * (1 - v) * (1 - w)};
        const double share =
            6.0 * volume * 0.125 * weight[a] * weight[b] * weight[c] * (1 - u) * (1 - u) * (1 - v);
        const Eigen::Vector3d place = corners.transpose() * l;
        const Eigen::Matrix3d strain = 0.5 * (slope(place) + slope(place).transpose());
        strain_j +=
            share * (0.5 * lambda * std::pow(strain.trace(), 2) + shear * strain.squaredNorm());
        kinetic_j += share * 0.5 * mdf.density_kg_per_m3 * field(place).squaredNorm();
        fit.row(row) = functions(l);
        values.row(row) = field(place);
      }
    }
  }
  const Eigen::MatrixXd nodal =
      core::SymmetricFactors{fit.transpose() * fit}.solve_columns(fit.transpose() * values);
  const Eigen::VectorXd x = nodal.reshaped<Eigen::RowMajor>();
  CHECK(0.5 * x.dot(element.stiffness * x) == Approx(strain_j).epsilon(1e-8));
  double mass_j = 0.0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    mass_j += 0.5 * nodal.col(axis).dot(element.mass * nodal.col(axis));
  }
  CHECK(mass_j == Approx(kinetic_j).epsilon(1e-8));
}

TEST_CASE("the enlarged space contains the given one, with its constraints and springs",
          "[core][model]") {
  const int order = GENERATE(1, 2);
  Plate plate{
      Box{{0.2, 0.1, 0.03}}, {up_to(1e-4), order}, {clamped(Side::left), clamped(Side::bottom)}};
  plate.fixations[0].constrained_axes = {true, false, true};
  plate.fixations[1].springs_n_per_m = Vec3{1e4, 2e4, 5e6};
  const DiscreteBody body = discretised(plate, mdf, plate.mesh.size, {}, {});
  const EnrichedBody larger =
      enriched(body.mesh, mdf, body.dofs, spring_supports(body.mesh, plate.shape, plate.fixations));
  CHECK(larger.matrices.K.rows() == enriched_dofs(body.mesh, body.dofs));
  CHECK(larger.matrices.K.rows() > body.matrices.K.rows());
  const auto restricted = [&](const SparseMatrix& lower) {
    const SparseMatrix whole = lower.selfadjointView<Eigen::Lower>();
    return Eigen::MatrixXd{larger.prolongation.transpose() * whole * larger.prolongation};
  };
  const Eigen::MatrixXd K{SparseMatrix{body.matrices.stiffness()}};
  const Eigen::MatrixXd M{SparseMatrix{body.matrices.mass()}};
  CHECK((restricted(larger.matrices.K) - K).norm() < 1e-10 * K.norm());
  CHECK((restricted(larger.matrices.M) - M).norm() < 1e-10 * M.norm());
}

// The laws that an estimate must keep, whatever the body: below the error, and near it.
TEST_CASE("the estimated error is within half and twice the error against a much finer mesh",
          "[core][model][slow]") {
  const std::vector<Body> bodies{
      {"foam cube",
       Box{{0.1, 0.1, 0.1}},
       2,
       {},
       {clamped(Side::bottom)},
       of(1e5, 30.0, 0.1),
       350.0,
       5e-6},
      {"wood block",
       Box{{0.3, 0.1, 0.05}},
       2,
       {},
       {clamped(Side::left)},
       of(1e10, 600.0, 0.3),
       5000.0,
       8e-6},
      {"large cube",
       Box{{10, 10, 10}},
       2,
       {},
       {clamped(Side::bottom)},
       of(1e9, 1000.0, 0.3),
       60.0,
       5.0},
      {"thick block of linear elements",
       Box{{0.1, 0.1, 0.1}},
       1,
       up_to(1e-5),
       {clamped(Side::bottom)},
       mdf,
       9000.0,
       5e-6},
      {"free bar", Box{{0.3, 0.05, 0.03}}, 2, {}, {}, aluminium, 6000.0, 2e-6},
      {"sheet of flat elements",
       Box{{0.2, 0.2, 0.01}},
       2,
       up_to(1e-5, 4.0),
       {clamped(Side::left)},
       aluminium,
       500.0,
       5e-7}};
  for (const Body& body : bodies) {
    PlateSpec spec = body.spec();
    const BodyModes coarse = solve_body(body_of(spec), {}, ErrorEstimation::wanted).modes;
    spec.mesh.order = 2;
    spec.mesh.size = up_to(body.fine_tet_m3);
    const ModalModel fine = build_plate_model(spec).modal;
    const FrequencyErrors errors = frequency_errors(coarse, spec.material, spec.band_limit_hz);
    const Eigen::ArrayXd hz = coarse.kappa_rad_per_m / kappa_rad_per_m(1.0, spec.material);
    REQUIRE(errors.relative.size() == hz.size());
    REQUIRE(hz.size() > 0);
    REQUIRE(fine.frequency_hz.size() >= hz.size());
    CHECK(errors.modes_at_least <= fine.frequency_hz.size());
    for (Eigen::Index i = 0; i < hz.size(); ++i) {
      INFO(body.name << ", mode " << i + 1 << ", " << hz[i] << " Hz, estimated "
                     << errors.relative[i]);
      const double error = hz[i] / fine.frequency_hz[i] - 1.0;
      CHECK(errors.relative[i] < 1.05 * error + 0.002);
      CHECK(errors.relative[i] > 0.5 * std::min(error, 0.5) - 0.002);
    }
  }
}

TEST_CASE("modes that a coarse mesh puts above the band are counted", "[core][model]") {
  PlateSpec plate = testing::paper_plate(4, mdf);
  plate.band_limit_hz = 270.0;
  const PlateModel coarse = build_plate_model(plate, {}, ErrorEstimation::wanted);
  CHECK(coarse.modal.frequency_hz.size() == 0);
  CHECK(frequency_errors(coarse.body.modes, mdf, 270.0).modes_at_least > 0);
}

TEST_CASE("a weak spring to another body leaves the estimate as it is", "[core][model]") {
  const PlateSpec alone{
      {Box{{0.2, 0.1, 0.02}}, {up_to(1e-5), 2}, {clamped(Side::left)}}, mdf, 800.0};
  PlateSpec joined = alone;
  const JoinedBody ballast{Plate{Box{{0.02, 0.02, 0.02}}, {up_to(1e-5), 2}, {}},
                           of(1e12, 100.0, 0.3)};
  JointSpring spring;
  spring.from = {0, clamped(Side::right)};
  spring.to = {1, clamped(Side::left)};
  spring.stiffness_n_per_m = {1.0, 1.0, 1.0};
  joined.joints = std::make_shared<const Joints>(Joints{{ballast}, {spring}});
  const Eigen::ArrayXd errors =
      frequency_errors(solve_body(body_of(alone), {}, ErrorEstimation::wanted).modes, mdf, 800.0)
          .relative;
  const Eigen::ArrayXd of_joined =
      frequency_errors(solve_body(body_of(joined), {}, ErrorEstimation::wanted).modes, mdf, 800.0)
          .relative;
  REQUIRE(errors.size() > 1);
  REQUIRE(of_joined.size() > errors.size());  // the ballast's on its spring
  CHECK(of_joined.tail(1)[0] == Approx(errors.tail(1)[0]).epsilon(0.1));
}

TEST_CASE("a frequency that the next order finds higher is off as one that it finds lower",
          "[core][model]") {
  BodyModes modes;
  modes.kappa_rad_per_m = Eigen::Array2d{1.0, 2.0} * kappa_rad_per_m(1.0, mdf);
  modes.estimate.kappa_rad_per_m = Eigen::Array2d{1.25, 1.9} * kappa_rad_per_m(1.0, mdf);
  const FrequencyErrors errors = frequency_errors(modes, mdf, 10.0);
  CHECK(errors.largest() == Approx(0.2));
  CHECK(errors.is_either_way);
}

TEST_CASE("what is not estimated says why, and a stored model keeps its estimate",
          "[core][model][cache]") {
  const PlateSpec cube{
      {Box{{1.0, 1.0, 1.0}}, {up_to(0.2), 2}, {clamped(Side::bottom)}}, mdf, 1000.0};
  BodyModes modes = solve_body(body_of(cube), {}, ErrorEstimation::wanted).modes;
  CHECK(modes.estimate.not_estimated.empty());
  const auto kept = decoded(encoded(modes));
  REQUIRE(kept);
  CHECK((kept->estimate.kappa_rad_per_m == modes.estimate.kappa_rad_per_m).all());
  modes.estimate = {{}, "too large", 0.0, "held by two nodes"};
  CHECK(decoded(encoded(modes))->estimate.not_estimated == "too large");
  CHECK(decoded(encoded(modes))->estimate.held_in_part == "held by two nodes");
  CHECK(frequency_errors(modes, mdf, 1000.0).not_estimated == "too large");
  CHECK(frequency_errors(modes, mdf, 1000.0).relative.size() == 0);
}

TEST_CASE("each round of refining has more tetrahedra, however fine the given triangles are",
          "[core][model][slow]") {
  PlateSpec block{
      {Solid{testing::box_surface({0.1, 0.06, 0.05}, 6)}, {{}, 2}, {clamped(Side::left)}},
      of(1e9, 1000.0, 0.3),
      5000.0};
  block.mesh.accuracy = 0.02;
  const BodyModes modes = solve_body(body_of(block), {}, ErrorEstimation::wanted).modes;
  const auto& rounds = modes.report.refinement;
  REQUIRE(rounds.size() >= 3);
  for (std::size_t i = 1; i < rounds.size(); ++i) {
    CHECK(rounds[i].tets > 1.3 * rounds[i - 1].tets);
  }
  CHECK(frequency_errors(modes, block.material, block.band_limit_hz).largest() <= 0.02);
}

TEST_CASE("an error beyond what the next order can tell is a bound", "[core][model]") {
  CHECK(describe_error(0.032) == "3.2 %");
  CHECK(describe_error(0.51) == "over 50 %");
}
