#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
#include "core/model/elements/assembly.hpp"
#include "core/model/elements/tet_element.hpp"
#include "core/model/plate_model.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
using namespace tapstudy;
using Matrix3 = Eigen::Matrix3d;
using Nodes = Eigen::Matrix<double, Eigen::Dynamic, 3>;

namespace {
core::TetCorners slanted_corners() {
  core::TetCorners corners;
  corners << 0.1, 0.0, 0.02, 1.1, 0.1, 0.0, 0.3, 0.9, -0.1, 0.2, 0.3, 0.7;
  return corners;
}
double volume(const core::TetCorners& c) {
  const Eigen::RowVector3d a = c.row(1) - c.row(0);
  const Eigen::RowVector3d b = c.row(2) - c.row(0);
  return a.cross(b).dot(c.row(3) - c.row(0)) / 6.0;
}
// The element of the given order as dynamic matrices, so that one law reads the same for both.
struct Element {
  Nodes nodes;
  Eigen::MatrixXd stiffness;
  Eigen::MatrixXd mass;
};
Element element(int order) {
  const core::TetCorners c = slanted_corners();
  Nodes nodes{order == 1 ? 4 : 10, 3};
  nodes.topRows<4>() = c;
  if (order == 1) {
    const auto tet = core::tet_element<4>(c, core::ElasticStiffness{testing::mdf()},
                                          testing::mdf().density_kg_per_m3);
    return {nodes, tet.stiffness, tet.mass};
  }
  const std::vector<std::pair<int, int>> edges{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  for (std::size_t e = 0; e < edges.size(); ++e) {
    nodes.row(static_cast<Eigen::Index>(4 + e)) =
        0.5 * (c.row(edges[e].first) + c.row(edges[e].second));
  }
  const auto tet = core::tet_element<10>(c, core::ElasticStiffness{testing::mdf()},
                                         testing::mdf().density_kg_per_m3);
  return {nodes, tet.stiffness, tet.mass};
}
// Displacements u = G x of the nodes.
Eigen::VectorXd displaced(const Nodes& nodes, const Matrix3& gradient) {
  const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> u = nodes * gradient.transpose();
  return u.reshaped<Eigen::RowMajor>();
}
Eigen::VectorXd shifted(const Nodes& nodes, Eigen::Index axis) {
  return Eigen::Vector3d::Unit(axis).replicate(nodes.rows(), 1);
}
}  // namespace

TEST_CASE("moving or turning an element as a whole stores no energy", "[core][element]") {
  const Element tet = element(GENERATE(1, 2));
  const double scale = tet.stiffness.norm();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    CHECK((tet.stiffness * shifted(tet.nodes, axis)).norm() < 1e-12 * scale);
    Matrix3 spin = Matrix3::Zero();
    spin((axis + 1) % 3, (axis + 2) % 3) = 1.0;
    spin((axis + 2) % 3, (axis + 1) % 3) = -1.0;
    CHECK((tet.stiffness * displaced(tet.nodes, spin)).norm() < 1e-12 * scale);
  }
}

TEST_CASE("apart from those six the stiffness is positive", "[core][element]") {
  const Element tet = element(GENERATE(1, 2));
  const Eigen::VectorXd values = core::symmetric_eigenpairs(tet.stiffness).values;
  const double largest = values.maxCoeff();
  CHECK(values[5] < 1e-9 * largest);
  CHECK(values[6] > 1e-6 * largest);
}

TEST_CASE("a constant strain stores the energy of Hooke's law (patch test)", "[core][element]") {
  const Element tet = element(GENERATE(1, 2));
  Matrix3 gradient;
  gradient << 1e-3, 2e-4, -1e-4, 3e-4, -5e-4, 7e-4, 2e-4, 1e-4, 4e-4;
  const Matrix3 strain = 0.5 * (gradient + gradient.transpose());
  const double shear = 2.5e9 / (2.0 * 1.25);
  const double lame = 2.5e9 * 0.25 / (1.25 * 0.5);
  const double density =
      0.5 * lame * strain.trace() * strain.trace() + shear * strain.squaredNorm();
  const Eigen::VectorXd u = displaced(tet.nodes, gradient);
  CHECK(0.5 * u.dot(tet.stiffness * u) == Approx(density * volume(slanted_corners())));
}

TEST_CASE("a quadratic displacement stores its exact energy in an element of order 2",
          "[core][element]") {
  // u = (x² / 2, 0, 0): strain xx = x, energy density (lambda / 2 + shear) x²
  const Element tet = element(2);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(30);
  for (Eigen::Index i = 0; i < 10; ++i) {
    u[3 * i] = 0.5 * tet.nodes(i, 0) * tet.nodes(i, 0);
  }
  const double shear = 2.5e9 / (2.0 * 1.25);
  const double lame = 2.5e9 * 0.25 / (1.25 * 0.5);
  const Eigen::Vector4d x = slanted_corners().col(0);
  const double x_squared = volume(slanted_corners()) / 20.0 * (x.squaredNorm() + x.sum() * x.sum());
  CHECK(0.5 * u.dot(tet.stiffness * u) == Approx((0.5 * lame + shear) * x_squared));
}

TEST_CASE("an element's mass is its density times its volume", "[core][element]") {
  const Element tet = element(GENERATE(1, 2));
  CHECK(tet.mass.sum() == Approx(610.0 * volume(slanted_corners())));
}

TEST_CASE("the consistent mass gives a linear velocity field its exact kinetic energy",
          "[core][element]") {
  // the integral of x² over a tetrahedron is V/20 (sum of x_i² + (sum of x_i)²)
  const Element tet = element(GENERATE(1, 2));
  const Eigen::VectorXd velocity = tet.nodes.col(0);
  const Eigen::Vector4d x = slanted_corners().col(0);
  const double exact = volume(slanted_corners()) / 20.0 * (x.squaredNorm() + x.sum() * x.sum());
  CHECK(velocity.dot(tet.mass * velocity) == Approx(610.0 * exact));
}

TEST_CASE("a mass of order 2 is positive for every motion", "[core][element]") {
  CHECK(core::symmetric_eigenpairs(element(2).mass).values.minCoeff() > 0.0);
}

// Which motions of a body nothing resists.
TEST_CASE("motions that nothing resists are counted beside those that thousands of nodes resist",
          "[core][model]") {
  for (const double nodes : {1.0, 1e2, 1e4, 1e6}) {
    Eigen::MatrixXd resisting(12, 9);
    for (Eigen::Index i = 0; i < resisting.size(); ++i) {
      resisting(i) = std::sin(1.0 + 7.3 * static_cast<double>(i * i));
    }
    const Eigen::MatrixXd sum = nodes * resisting * resisting.transpose();
    CAPTURE(nodes);
    CHECK(core::unresisted(sum) == 3);
  }
}

TEST_CASE("a screw's head resists all motions of a large plate", "[core][model]") {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Identity(6, 6);
  sum.bottomRightCorner(3, 3) *= 1e-5;  // a lever of 3 mm on a plate of a metre
  CHECK(core::unresisted(sum) == 0);
}

// Bodies on springs: what a rigid body on an elastic foundation does, and where springs become
// constraints.
namespace {
const core::Vec3 size_m{0.3, 0.2, 0.05};

core::PlateSpec block(int order, double tet_volume_m3) {
  core::PlateSpec spec{
      {core::Box{size_m}, {}, {}}, {200e9, 7800.0, 0.3, core::RayleighDamping{}}, 100.0};
  spec.mesh.order = order;
  spec.mesh.size.max_tet_volume_m3 = tet_volume_m3;
  return spec;
}
core::Fixation bottom() {
  core::Fixation fixation;
  fixation.shape = core::RegionShape::side;
  fixation.side = core::Side::bottom;
  return fixation;
}
core::Fixation bottom_on(const core::Vec3& springs_n_per_m) {
  core::Fixation fixation = bottom();
  fixation.springs_n_per_m = springs_n_per_m;
  return fixation;
}
double hz(double stiffness, double inertia) {
  return std::sqrt(stiffness / inertia) / (2.0 * std::numbers::pi);
}
}  // namespace

// k / A per area under a base of a × b: k up and down, k a²/12 in rocking about the base's middle
// line; without sideways stiffness the body rocks about its centre of mass, m (a² + h²) / 12.
TEST_CASE("a stiff block on a soft foundation bounces and rocks as a rigid body, on any mesh",
          "[core][model]") {
  const double k = 2e5;
  const auto [order, volume_m3] =
      GENERATE(table<int, double>({{1, 1e-4}, {1, 2e-6}, {2, 1e-4}, {2, 1e-5}}));
  CAPTURE(order, volume_m3);
  core::PlateSpec spec = block(order, volume_m3);
  spec.fixations = {bottom_on({0.0, 0.0, k})};
  const core::PlateModel built = core::build_plate_model(spec);
  const double mass_kg = 7800.0 * size_m.prod();
  const auto rocking_hz = [&](double edge_m) {
    return hz(k * edge_m * edge_m / 12.0,
              mass_kg * (edge_m * edge_m + size_m.z() * size_m.z()) / 12.0);
  };
  std::array<double, 3> expected{hz(k, mass_kg), rocking_hz(size_m.x()), rocking_hz(size_m.y())};
  std::ranges::sort(expected);
  CHECK(built.body.modes.report.rigid_body_modes == 3);  // along x, along y, about z
  REQUIRE(built.modal.frequency_hz.size() == 3);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(built.modal.frequency_hz[static_cast<Eigen::Index>(i)] ==
          Approx(expected.at(i)).epsilon(1e-4));
  }
}

// k / A per area under a disc: k r²/4 in rocking about any of its diameters.
TEST_CASE("a block on a soft disc rocks as on the disc itself, on any mesh", "[core][model]") {
  const double k = 2e5;
  const double radius_m = 0.03;
  const auto [order, volume_m3] =
      GENERATE(table<int, double>({{1, 1e-4}, {1, 2e-6}, {2, 1e-4}, {2, 1e-5}}));
  CAPTURE(order, volume_m3);
  core::PlateSpec spec = block(order, volume_m3);
  core::Fixation pad;
  pad.shape = core::RegionShape::disc;
  pad.face = core::Face::bottom;
  pad.radius_m = radius_m;
  pad.springs_n_per_m = core::Vec3{0.0, 0.0, k};
  spec.fixations = {pad};
  const core::PlateModel built = core::build_plate_model(spec);
  const double mass_kg = 7800.0 * size_m.prod();
  const auto rocking_hz = [&](double edge_m) {
    return hz(k * radius_m * radius_m / 4.0,
              mass_kg * (edge_m * edge_m + size_m.z() * size_m.z()) / 12.0);
  };
  REQUIRE(built.modal.frequency_hz.size() == 3);
  CHECK(built.modal.frequency_hz[0] == Approx(rocking_hz(size_m.x())).epsilon(2e-3));
  CHECK(built.modal.frequency_hz[1] == Approx(rocking_hz(size_m.y())).epsilon(2e-3));
  CHECK(built.modal.frequency_hz[2] == Approx(hz(k, mass_kg)).epsilon(1e-3));
}

// So fine that the region, whose triangles end within its rim, has thousands of nodes.
namespace {
core::PlateSpec sheet_with(const core::Fixation& fixation) {
  core::PlateSpec spec = block(2, 1.5e-7);
  spec.shape = core::Box{{size_m.x(), size_m.y(), 0.005}};
  spec.fixations = {fixation};
  return spec;
}
core::Fixation wide_disc() {
  core::Fixation disc;
  disc.shape = core::RegionShape::disc;
  disc.face = core::Face::through;
  disc.radius_m = 0.09;
  return disc;
}
}  // namespace

TEST_CASE("a region of thousands of nodes is the disc itself on soft springs, and clamped on rigid",
          "[core][model]") {
  const double k = 2e3;
  core::Fixation pad = wide_disc();
  pad.springs_n_per_m = core::Vec3{0.0, 0.0, k};
  const core::PlateModel soft = core::build_plate_model(sheet_with(pad));
  const double mass_kg = 7800.0 * size_m.x() * size_m.y() * 0.005;
  const auto rocking_hz = [&](double edge_m) {
    return hz(k * pad.radius_m * pad.radius_m / 4.0,
              mass_kg * (edge_m * edge_m + 0.005 * 0.005) / 12.0);
  };
  REQUIRE(soft.modal.frequency_hz.size() == 3);
  CHECK(soft.modal.frequency_hz[0] == Approx(rocking_hz(size_m.x())).epsilon(2e-3));
  CHECK(soft.modal.frequency_hz[1] == Approx(rocking_hz(size_m.y())).epsilon(2e-3));
  CHECK(soft.modal.frequency_hz[2] == Approx(hz(k, mass_kg)).epsilon(1e-3));
  core::PlateSpec spec = sheet_with(wide_disc());
  spec.band_limit_hz = 800.0;
  const Eigen::ArrayXd held_hz = core::build_plate_model(spec).modal.frequency_hz;
  REQUIRE(held_hz.size() >= 2);
  pad.springs_n_per_m = core::Vec3::Constant(1e16);
  spec.fixations = {pad};
  const Eigen::ArrayXd sprung_hz = core::build_plate_model(spec).modal.frequency_hz;
  REQUIRE(sprung_hz.size() == held_hz.size());
  CHECK((sprung_hz / held_hz - 1.0).abs().maxCoeff() < 1e-4);
}

TEST_CASE("springs lower every frequency below that of the constraint that they become in the end",
          "[core][model][slow]") {
  core::PlateSpec spec = block(2, 2e-5);
  spec.band_limit_hz = 25000.0;
  spec.fixations = {bottom()};
  const Eigen::ArrayXd held_hz = core::build_plate_model(spec).modal.frequency_hz;
  REQUIRE(held_hz.size() >= 3);
  double before_hz = 0.0;
  for (const double k : {1e8, 1e10, 1e12, 1e16}) {
    spec.fixations = {bottom_on({k, k, k})};
    const Eigen::ArrayXd sprung_hz = core::build_plate_model(spec).modal.frequency_hz;
    CHECK((sprung_hz.head(held_hz.size()) < held_hz).all());
    CHECK(sprung_hz[0] > before_hz);
    before_hz = sprung_hz[0];
  }
  CHECK(before_hz == Approx(held_hz[0]).epsilon(1e-3));
}

// Regions that cut through triangles, and hold nodes inside the body and single ones.
TEST_CASE("springs without bound become the rigid fixation of the same region, on any mesh",
          "[core][model]") {
  const int order = GENERATE(1, 2);
  const core::RegionShape shape = GENERATE(core::RegionShape::disc, core::RegionShape::ball);
  CAPTURE(order, static_cast<int>(shape));
  core::PlateSpec spec = block(order, 2e-5);
  spec.material = testing::mdf();
  spec.band_limit_hz = 1500.0;
  spec.fixations.clear();
  core::Fixation& foot = spec.fixations.emplace_back();
  foot.shape = shape;
  foot.at_m = {0.04, 0.03, shape == core::RegionShape::ball ? -0.05 : 0.0};
  foot.radius_m = 0.047;
  foot.face = core::Face::through;
  const Eigen::ArrayXd held_hz = core::build_plate_model(spec).modal.frequency_hz;
  REQUIRE(held_hz.size() >= 2);
  for (const auto& [k, close] : {std::pair{1e14, 1e-3}, {1e16, 1e-5}}) {
    spec.fixations.front().springs_n_per_m = core::Vec3{k, k, k};
    const Eigen::ArrayXd sprung_hz = core::build_plate_model(spec).modal.frequency_hz;
    REQUIRE(sprung_hz.size() == held_hz.size());
    CHECK((sprung_hz / held_hz - 1.0).abs().maxCoeff() < close);
  }
}

TEST_CASE("a support smaller than the elements shares its spring out over its nodes",
          "[core][model]") {
  core::PlateSpec plate = testing::paper_plate(4, testing::mdf());
  const double mass_kg = 610.0 * 0.6 * 0.6 * 0.05;
  for (core::Fixation& corner : plate.fixations) {
    corner.springs_n_per_m = core::Vec3{0.0, 0.0, 100.0};  // of both its nodes
  }
  plate.band_limit_hz = 1.0;
  const Eigen::ArrayXd found_hz = core::build_plate_model(plate).modal.frequency_hz;
  REQUIRE(found_hz.size() == 1);  // rocking is faster: the corners are far out
  CHECK(found_hz[0] == Approx(hz(400.0, mass_kg)).epsilon(1e-4));
}

TEST_CASE("a spring that no node is held by is refused", "[core][model]") {
  core::PlateSpec spec = block(1, 1e-4);
  core::Fixation fixation;
  fixation.shape = core::RegionShape::ball;
  fixation.at_m = {1.0, 0.0, 0.0};
  fixation.radius_m = 0.1;
  fixation.springs_n_per_m = core::Vec3{1.0, 1.0, 1.0};
  spec.fixations = {fixation};
  CHECK_THROWS_AS(core::build_plate_model(spec), core::ModelError);
}
