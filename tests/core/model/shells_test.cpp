// Plates of shell elements, against theory, CalculiX and tetrahedra.
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/model/discrete_body.hpp"
#include "core/model/joints/joints.hpp"
#include "core/model/modes/modal_solver.hpp"
#include "core/model/plate_model.hpp"
#include "core/model/refinement/refinement.hpp"
#include "core/model/shells/shell_elements.hpp"
#include "support/calculix.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using namespace tapstudy::core;

namespace {
const Material steel{2.1e11, 7850.0, 0.3, ConstantDamping{0.01}};
constexpr std::array all_sides{Side::left, Side::right, Side::front, Side::back};

double rigidity_n_m(double thickness_m, const Material& material = steel) {
  return material.youngs_modulus_pa * std::pow(thickness_m, 3) /
         (12.0 * (1.0 - std::pow(material.poissons_ratio, 2)));
}
// sqrt(D / rho h) / 2 pi a²
double unit_hz(double width_m, double thickness_m) {
  return std::sqrt(rigidity_n_m(thickness_m) / (steel.density_kg_per_m3 * thickness_m)) /
         (2.0 * std::numbers::pi * width_m * width_m);
}
PlateSpec sheet_of(const Vec3& size_m, double shell_width_m, double band_hz) {
  PlateSpec sheet{{Box{size_m}, {}, {}}, steel, band_hz};
  sheet.mesh.order = 2;
  sheet.mesh.shell_width_m = shell_width_m;
  return sheet;
}
Fixation held_along(Side side, std::array<bool, 3> axes = {true, true, true}) {
  Fixation fixation;
  fixation.shape = RegionShape::side;
  fixation.side = side;
  fixation.constrained_axes = axes;
  return fixation;
}
void clamp(PlateSpec& plate) {
  for (const Side side : all_sides) {
    plate.fixations.push_back(held_along(side));
  }
}
// Held across the plate and along the rim, free to turn about it.
void support(PlateSpec& plate) {
  for (const Side side : all_sides) {
    const bool is_across_x = side == Side::left || side == Side::right;
    plate.fixations.push_back(held_along(side, {!is_across_x, is_across_x, true}));
  }
}
Fixation disc_at(const Vec3& at_m, double radius_m) {
  Fixation fixation;
  fixation.shape = RegionShape::disc;
  fixation.at_m = at_m;
  fixation.radius_m = radius_m;
  return fixation;
}
Fixation middle_of(const Face face) {
  Fixation point;
  point.face = face;
  return point;
}
void check_first(const Eigen::ArrayXd& found_hz, const std::vector<double>& expected_hz,
                 double tolerance) {
  REQUIRE(static_cast<std::size_t>(found_hz.size()) >= expected_hz.size());
  for (std::size_t i = 0; i < expected_hz.size(); ++i) {
    CAPTURE(i);
    CHECK(found_hz[static_cast<Eigen::Index>(i)] == Approx(expected_hz[i]).epsilon(tolerance));
  }
}

// Mindlin 1951: (k² - rho w² / s G) (D k² - rho h³ w² / 12) = rho h w² for waves sin sin, with s
// the share of shear; where s and h³ / 12 vanish, Navier's solution.
double supported_hz(const Vec3& size_m, int m, int n) {
  const double k2 =
      std::pow(std::numbers::pi, 2) * (std::pow(m / size_m.x(), 2) + std::pow(n / size_m.y(), 2));
  const double rho = steel.density_kg_per_m3;
  const double h = size_m.z();
  const double shear_pa =
      5.0 / 6.0 * steel.youngs_modulus_pa / (2.0 * (1.0 + steel.poissons_ratio));
  const double a = rho * rho * std::pow(h, 3) / (12.0 * shear_pa);
  const double b = rho * h + k2 * (rigidity_n_m(h) * rho / shear_pa + rho * std::pow(h, 3) / 12.0);
  const double c = rigidity_n_m(h) * k2 * k2;
  return std::sqrt(2.0 * c / (b + std::sqrt(b * b - 4.0 * a * c))) / (2.0 * std::numbers::pi);
}
}  // namespace

TEST_CASE("a sheet of shells on simple supports has the frequencies of Navier and Mindlin",
          "[core][model][shell]") {
  const double thickness_m = GENERATE(0.0001, 0.001, 0.005);
  CAPTURE(thickness_m);
  const Vec3 size_m{0.3, 0.2, thickness_m};
  std::vector<double> expected_hz;
  for (int m = 1; m < 8; ++m) {
    for (int n = 1; n < 8; ++n) {
      expected_hz.push_back(supported_hz(size_m, m, n));
    }
  }
  std::ranges::sort(expected_hz);
  expected_hz.resize(10);
  PlateSpec sheet = sheet_of(size_m, 0.07, 1.01 * expected_hz.back());
  support(sheet);
  const PlateModel built = build_plate_model(sheet);
  CAPTURE(built.body.modes.report.dofs, built.body.modes.report.tets);
  check_first(built.modal.frequency_hz, expected_hz, 0.002);
  CHECK(built.body.modes.report.order() == shell_order);
  const double most = built.modal.shape.col(0).cwiseAbs().maxCoeff();  // at the middle, of sin sin
  CHECK(most == Approx(2.0 / std::sqrt(steel.density_kg_per_m3 * size_m.prod())).epsilon(0.02));
}

// omega a² sqrt(rho h / D), in the limit of thin plates (Leissa 1969, Vibration of Plates, table
// 4.22 has 35.99, 73.41, 108.3, 131.6, 132.3, the upper bounds of beam functions).
TEST_CASE("a clamped sheet has Leissa's frequencies on an automatic mesh of shells",
          "[core][model][shell]") {
  const double thickness_m = GENERATE(0.0002, 0.001);
  CAPTURE(thickness_m);
  PlateSpec sheet = sheet_of({0.15, 0.15, thickness_m}, 1.0, 212.0 * unit_hz(0.15, thickness_m));
  sheet.mesh = {};
  sheet.mesh.is_automatic = true;
  sheet.mesh.accuracy = 0.005;
  clamp(sheet);
  const PlateModel built = build_plate_model(sheet);
  std::vector<double> expected_hz{35.985, 73.394, 73.394, 108.22, 131.58,
                                  132.20, 165.00, 165.00, 210.52, 210.52};
  std::ranges::for_each(expected_hz, [&](double& of) { of *= unit_hz(0.15, thickness_m); });
  CAPTURE(built.body.modes.report.dofs, built.body.modes.report.tets);
  check_first(built.modal.frequency_hz, expected_hz, 0.005);
  CHECK(built.body.modes.report.order() == shell_order);
  CHECK(2.0 * frequency_errors(built.body.modes, steel, sheet.band_limit_hz).largest() <= 0.005);
}

// nu 0.3; a thin plate by the Ritz method with 18 Legendre polynomials each way, which agrees with
// Gorman 1978 (Free vibration analysis of the completely free rectangular plate).
TEST_CASE("a free sheet has six rigid motions, its whole mass and a thin plate's frequencies",
          "[core][model][shell]") {
  constexpr double thickness_m = 0.0005;
  const PlateSpec sheet = sheet_of({0.2, 0.2, thickness_m}, 0.1, 70.0 * unit_hz(0.2, thickness_m));
  const PlateModel built = build_plate_model(sheet);
  CHECK(built.body.modes.report.rigid_body_modes == 6);
  CHECK(built.body.modes.report.counted_in_band ==
        6 + static_cast<int>(built.modal.frequency_hz.size()));
  std::vector<double> expected_hz{13.468, 19.596, 24.270, 34.801, 34.801,
                                  61.093, 61.093, 63.687, 69.265};
  std::ranges::for_each(expected_hz, [&](double& of) { of *= unit_hz(0.2, thickness_m); });
  check_first(built.modal.frequency_hz, expected_hz, 0.005);

  const DiscreteBody body = discretised(sheet, steel, {}, {}, {});
  const RigidMotions motions{body.mesh};
  for (Eigen::Index motion = 0; motion < 6; ++motion) {
    Eigen::VectorXd of_nodes(body.displacement.rows());
    for (Eigen::Index i = 0; i < of_nodes.size(); ++i) {
      of_nodes[i] = motions.displacement(body.mesh.nodes_m.row(i / 3).transpose(), i % 3)[motion];
    }
    const SparseMatrix displacement = body.displacement;
    const SparseMatrix normal = displacement.transpose() * displacement;
    const Eigen::VectorXd unknowns =
        Eigen::SimplicialLDLT<SparseMatrix>{normal}.solve(displacement.transpose() * of_nodes);
    CHECK((displacement * unknowns - of_nodes).norm() < 1e-9 * of_nodes.norm());
    const Eigen::VectorXd forces_n = body.matrices.stiffness() * unknowns;
    CHECK(forces_n.norm() < 1e-9 * body.matrices.K.norm() * unknowns.norm());
    if (motion < 3) {
      const double mass_kg = unknowns.dot(body.matrices.mass() * unknowns);
      CHECK(mass_kg == Approx(steel.density_kg_per_m3 * 0.2 * 0.2 * thickness_m).epsilon(1e-9));
    }
  }
}

// w = 0.0116 and 0.0056 P a² / D (Timoshenko & Woinowsky-Krieger 1959, articles 34 and 44).
TEST_CASE("a square sheet gives way to a force at its middle as Timoshenko says",
          "[core][model][shell]") {
  const auto [is_clamped, share] = GENERATE(std::pair{true, 0.00560}, std::pair{false, 0.01160});
  CAPTURE(is_clamped);
  constexpr double thickness_m = 0.0005;
  PlateSpec sheet = sheet_of({0.2, 0.2, thickness_m}, 0.05, 1.0);
  is_clamped ? clamp(sheet) : support(sheet);
  const DiscreteBody body = discretised(sheet, steel, {}, {middle_of(Face::top)}, {});
  const auto middle = nodes_of(middle_of(Face::top), body.mesh, sheet.shape);
  REQUIRE(middle.size() == 1);
  Eigen::VectorXd force_n = Eigen::VectorXd::Zero(body.displacement.rows());
  force_n[3 * middle[0] + 2] = 1.0;
  const Eigen::VectorXd deflection =
      body.displacement * Eigen::SimplicialLDLT<SparseMatrix>{body.matrices.K}
                              .solve(body.displacement.transpose() * force_n)
                              .eval();
  CHECK(deflection[3 * middle[0] + 2] ==
        Approx(share * 0.2 * 0.2 / rigidity_n_m(thickness_m)).epsilon(0.005));
}

TEST_CASE("the mesh on which shells are seen fills the plate and its faces",
          "[core][mesh][shell]") {
  const Fixation screw = disc_at({0.05, 0.02, 0.0}, 0.01);
  const Vec3 size_m{0.3, 0.2, 0.002};
  const DiscreteBody body = discretised(sheet_of(size_m, 0.1, 1.0), steel, {}, {screw}, {});
  CHECK(volume_m3(body.mesh) == Approx(size_m.prod()).epsilon(1e-9));
  for (Eigen::Index tet = 0; tet < body.mesh.tets.rows(); ++tet) {
    CHECK(tet_volume_m3(body.mesh, tet) > 0.0);
  }
  TriangleSurface surface{body.mesh.nodes_m, body.mesh.surface.leftCols<3>()};
  CHECK(volume_m3(surface) == Approx(size_m.prod()).epsilon(1e-9));  // closed, outward
  std::map<std::array<int, 3>, int> tets_with;                       // a face
  const auto face_of = [](const auto& row, const std::array<int, 3>& corners) {
    std::array<int, 3> face{row[corners[0]], row[corners[1]], row[corners[2]]};
    std::ranges::sort(face);
    return face;
  };
  for (const auto& row : body.mesh.tets.rowwise()) {
    for (const std::array<int, 3>& corners : tet_faces) {
      ++tets_with[face_of(row, corners)];
    }
  }
  CHECK(std::ranges::count(tets_with, 1, &std::pair<const std::array<int, 3>, int>::second) ==
        body.mesh.surface.rows());
  for (const auto& row : body.mesh.surface.rowwise()) {
    CHECK(tets_with[face_of(row, {0, 1, 2})] == 1);
  }
  double area_m2 = 0.0;
  for (Eigen::Index triangle = 0; triangle < body.mesh.surface.rows(); ++triangle) {
    area_m2 += triangle_area_m2(body.mesh, triangle);
  }
  CHECK(area_m2 == Approx(2.0 * (0.3 * 0.2 + 0.3 * 0.002 + 0.2 * 0.002)).epsilon(1e-9));
  const double held_m2 = held_areas_m2(body.mesh, Box{size_m}, {screw}).front();
  CHECK(held_m2 ==
        Approx(2.0 * 2.0 * std::numbers::sqrt2 * 0.01 * 0.01).epsilon(0.01));  // octagons
}

TEST_CASE("a sheet on springs rises and falls with its mass, and stiff springs hold it as a clamp",
          "[core][model][shell]") {
  constexpr double thickness_m = 0.001;
  const double first_hz = 35.985 * unit_hz(0.15, thickness_m);
  PlateSpec soft = sheet_of({0.15, 0.15, thickness_m}, 0.08, first_hz);
  const double mass_kg = steel.density_kg_per_m3 * 0.15 * 0.15 * thickness_m;
  Fixation bed = held_along(Side::bottom);
  bed.springs_n_per_m = Vec3{0.0, 0.0, 1000.0};
  soft.fixations = {bed};
  const Eigen::ArrayXd on_bed_hz = build_plate_model(soft).modal.frequency_hz;
  REQUIRE(on_bed_hz.size() >= 1);
  CHECK(on_bed_hz[0] ==
        Approx(std::sqrt(1000.0 / mass_kg) / (2.0 * std::numbers::pi)).epsilon(1e-4));

  PlateSpec stiff = sheet_of({0.15, 0.15, thickness_m}, 0.08, 2.5 * first_hz);
  clamp(stiff);
  const Eigen::ArrayXd clamped_hz = build_plate_model(stiff).modal.frequency_hz;
  for (Fixation& rim : stiff.fixations) {
    rim.springs_n_per_m = Vec3{1e15, 1e15, 1e15};
  }
  const Eigen::ArrayXd sprung_hz = build_plate_model(stiff).modal.frequency_hz;
  REQUIRE(clamped_hz.size() == sprung_hz.size());
  CHECK((sprung_hz / clamped_hz - 1.0).abs().maxCoeff() < 1e-3);
}

TEST_CASE("what holds one face of a sheet leaves it to turn about that face",
          "[core][model][shell]") {
  const Vec3 size_m{0.2, 0.1, 0.001};
  PlateSpec sheet = sheet_of(size_m, 0.1, 1.0);
  Fixation edge;
  edge.shape = RegionShape::box;
  edge.low_m = {-0.1, -0.05, -0.001};
  edge.high_m = {-0.1, 0.05, -0.001};
  sheet.fixations = {edge};
  const DiscreteBody body = discretised(sheet, steel, {}, {}, {});
  const auto lower = nodes_of(edge, body.mesh, sheet.shape);
  REQUIRE(lower.size() >= 5);
  const Eigen::MatrixXd rows{body.displacement};
  for (const Eigen::Index node : lower) {
    CHECK(rows.middleRows<3>(3 * node).isZero(0.0));
    CHECK(rows.middleRows<2>(3 * (node + 2)).isApprox(2.0 * rows.middleRows<2>(3 * (node + 1))));
    CHECK_FALSE(rows.middleRows<2>(3 * (node + 2)).isZero(0.0));
    CHECK(rows.row(3 * (node + 2) + 2).isZero(0.0));
  }
}

TEST_CASE("two equal sheets joined by springs have the modes of one, moving together",
          "[core][model][shell]") {
  constexpr double thickness_m = 0.001;
  PlateSpec sheet = sheet_of({0.15, 0.12, thickness_m}, 0.15, 50.0 * unit_hz(0.15, thickness_m));
  const auto end = [](std::size_t body, Face face) {
    JointSpring::End joined{body, disc_at({0.03, 0.02, 0.0}, 0.01)};
    joined.region.face = face;
    return joined;
  };
  Joints joints{{JoinedBody{sheet, steel}},
                {{end(0, Face::bottom), end(1, Face::top), {0.0, 0.0, 1e4}, 0.0}}};
  PlateSpec joined = sheet;
  joined.joints = std::make_shared<const Joints>(joints);
  const PlateModel both = build_plate_model(joined, {}, ErrorEstimation::wanted);
  const Eigen::ArrayXd found_hz = both.modal.frequency_hz;
  const DiscreteBody alone = discretised(sheet, steel, {}, {end(0, Face::top).region}, {});
  const Eigen::ArrayXd alone_hz =
      solve_modes(alone.matrices, sheet.band_limit_hz).omega_rad_s / (2.0 * std::numbers::pi);
  REQUIRE(alone_hz.size() >= 3);
  CHECK(found_hz.size() > alone_hz.size());
  for (const double hz : alone_hz) {
    CHECK((found_hz / hz - 1.0).abs().minCoeff() < 1e-6);
  }
  CHECK(both.body.modes.kinetic_share.row(0).isConstant(0.5, 1e-6));
  const FrequencyErrors errors = frequency_errors(both.body.modes, steel, sheet.band_limit_hz);
  CHECK(errors.not_estimated.empty());
  CHECK(errors.relative.maxCoeff() > 1e-5);

  // With a block of tetrahedra as the other body the error of both counts.
  joints.bodies[0] = JoinedBody{{Box{{0.1, 0.1, 0.03}}, {{}, 1}, {}}, steel};
  joined.joints = std::make_shared<const Joints>(joints);
  const PlateModel on_block = build_plate_model(joined, {}, ErrorEstimation::wanted);
  const FrequencyErrors mixed = frequency_errors(on_block.body.modes, steel, sheet.band_limit_hz);
  CHECK(mixed.not_estimated.empty());
  CHECK(mixed.relative.maxCoeff() > 0.0);
}

namespace {
// A free sheet of S8R, eight nodes each.
std::string calculix_sheet(const Vec3& size_m, int across_x, int across_y, int modes) {
  const auto number = [&](int i, int j) { return 1 + i + j * (2 * across_x + 1); };
  std::string text = "*NODE, NSET=ALL\n";
  for (int j = 0; j <= 2 * across_y; ++j) {
    for (int i = 0; i <= 2 * across_x; ++i) {
      if (i % 2 == 1 && j % 2 == 1) {
        continue;
      }
      text += fmt::format("{},{:.12g},{:.12g},0\n", number(i, j), 0.5 * i * size_m.x() / across_x,
                          0.5 * j * size_m.y() / across_y);
    }
  }
  text += "*ELEMENT, TYPE=S8R, ELSET=SHEET\n";
  for (int j = 0; j < 2 * across_y; j += 2) {
    for (int i = 0; i < 2 * across_x; i += 2) {
      text +=
          fmt::format("{},{},{},{},{},{},{},{},{}\n", number(i, j), number(i, j), number(i + 2, j),
                      number(i + 2, j + 2), number(i, j + 2), number(i + 1, j),
                      number(i + 2, j + 1), number(i + 1, j + 2), number(i, j + 1));
    }
  }
  return text +
         fmt::format(
             "*MATERIAL, NAME=M\n*ELASTIC\n{},{}\n*DENSITY\n{}\n*SHELL SECTION, ELSET=SHEET, "
             "MATERIAL=M\n{}\n*STEP\n*FREQUENCY\n{}\n*END STEP\n",
             steel.youngs_modulus_pa, steel.poissons_ratio, steel.density_kg_per_m3, size_m.z(),
             modes);
}
}  // namespace

TEST_CASE("CalculiX finds the frequencies of a sheet with its shells S8R",
          "[core][model][calculix][shell][slow]") {
  const Vec3 size_m{0.2, 0.14, 0.001};
  std::vector<double> theirs_hz = testing::calculix_hz(calculix_sheet(size_m, 20, 14, 16), 16);
  REQUIRE(theirs_hz.size() == 16);
  theirs_hz.erase(theirs_hz.begin(), theirs_hz.begin() + 6);  // motions of the rigid body
  const PlateSpec sheet = sheet_of(size_m, 0.05, 1.02 * theirs_hz.back());
  check_first(build_plate_model(sheet).modal.frequency_hz, theirs_hz, 0.002);
}

// Cubic ones, which are 0.3 % too high with these, as those of a finer mesh tell.
TEST_CASE("a clamped sheet of three millimetres has the frequencies of tetrahedra",
          "[core][model][shell][slow]") {
  const double hz = unit_hz(0.15, 0.003);
  PlateSpec sheet = sheet_of({0.15, 0.15, 0.003}, 0.075, 110.0 * hz);
  clamp(sheet);
  const PlateModel shells = build_plate_model(sheet);
  sheet.mesh = {{1.414, 6e-8, 8.0}, 3};
  const PlateModel solid = build_plate_model(sheet);
  REQUIRE(shells.modal.frequency_hz.size() == 4);
  REQUIRE(solid.modal.frequency_hz.size() == 4);
  CHECK((solid.modal.frequency_hz / shells.modal.frequency_hz - 1.0).abs().maxCoeff() < 0.007);
  CHECK(20 * shells.body.modes.report.dofs < solid.body.modes.report.dofs);
}

TEST_CASE("shells are for plates that are thin beside their width", "[core][model][shell]") {
  CHECK_THROWS_WITH(build_plate_model(sheet_of({0.1, 0.3, 0.01}, 0.05, 1000.0)),
                    Contains("at least 40 times wider than thick"));
}
