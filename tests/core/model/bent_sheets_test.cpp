// Sheets by the surface in their middle, against theory, CalculiX and tetrahedra.
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
#include "core/model/discrete_body.hpp"
#include "core/model/joints/joints.hpp"
#include "core/model/modes/modal_solver.hpp"
#include "core/model/plate_model.hpp"
#include "core/model/shells/sheet_body.hpp"
#include "core/model/shells/shell_elements.hpp"
#include "core/model/shells/triangulation.hpp"
#include "support/calculix.hpp"
#include "support/catch.hpp"
#include "support/surfaces.hpp"
using namespace tapstudy;
using namespace tapstudy::core;

namespace {
const Material sheet_steel{2.1e11, 7850.0, 0.3, ConstantDamping{0.01}};

// A grid of `across` by `along` cells, placed by `at` of shares from 0 to 1; points in one place
// are one.
template <class At>
void add_grid(int across, int along, const At& at, std::vector<Eigen::RowVector3d>& points,
              std::vector<Eigen::RowVector3i>& triangles) {
  const auto number = [&](int i, int j) {
    const Eigen::RowVector3d place =
        at(static_cast<double>(i) / across, static_cast<double>(j) / along);
    const auto known =
        std::ranges::find_if(points, [&](const auto& one) { return (one - place).norm() < 1e-9; });
    if (known != points.end()) {
      return static_cast<int>(known - points.begin());
    }
    points.push_back(place);
    return static_cast<int>(points.size()) - 1;
  };
  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < along; ++j) {
      const int a = number(i, j);
      const int b = number(i + 1, j);
      const int c = number(i + 1, j + 1);
      const int d = number(i, j + 1);
      triangles.emplace_back(a, b, c);
      triangles.emplace_back(a, c, d);
    }
  }
}
template <class At>
TriangleSurface grid(int across, int along, const At& at) {
  std::vector<Eigen::RowVector3d> points;
  std::vector<Eigen::RowVector3i> triangles;
  add_grid(across, along, at, points, triangles);
  return testing::surface_of(points, triangles);
}
Eigen::RowVector3d on_tube(double radius_m, double length_m, double turn, double along) {
  const double angle = 2.0 * std::numbers::pi * turn;
  return {length_m * (along - 0.5), radius_m * std::sin(angle), -radius_m * std::cos(angle)};
}
TriangleSurface tube(double radius_m, double length_m, int around, int along) {
  return grid(around, along, [&](double u, double v) { return on_tube(radius_m, length_m, u, v); });
}
// The sides and the floor of a box without a lid, each over two shares.
constexpr int walls_of_box = 5;
Eigen::RowVector3d on_open_box(const Vec3& size_m, int wall, double u, double v) {
  const double x = size_m.x() * (u - 0.5);
  const double y = size_m.y() * (u - 0.5);
  const double z = size_m.z() * v;
  switch (wall) {
    case 0:
      return {x, -0.5 * size_m.y(), z};
    case 1:
      return {0.5 * size_m.x(), y, z};
    case 2:
      return {-x, 0.5 * size_m.y(), z};
    case 3:
      return {-0.5 * size_m.x(), -y, z};
    default:
      return {-x, size_m.y() * (v - 0.5), 0.0};
  }
}
TriangleSurface open_box(const Vec3& size_m, int cells) {
  std::vector<Eigen::RowVector3d> points;
  std::vector<Eigen::RowVector3i> triangles;
  for (int wall = 0; wall < walls_of_box; ++wall) {
    add_grid(
        cells, cells, [&](double u, double v) { return on_open_box(size_m, wall, u, v); }, points,
        triangles);
  }
  return testing::surface_of(points, triangles);
}
// A cap of a sphere up to a polar angle, from its pole upward.
TriangleSurface bowl(double radius_m, double up_to_rad, int rings) {
  return grid(4 * rings, rings, [&](double turn, double up) {
    const double angle = 2.0 * std::numbers::pi * turn;
    const double polar = up_to_rad * up;
    return Eigen::RowVector3d{radius_m * std::sin(polar) * std::cos(angle),
                              -radius_m * std::sin(polar) * std::sin(angle),
                              -radius_m * std::cos(polar)};
  });
}
// Without the triangles that a pole leaves without area.
TriangleSurface without_points(TriangleSurface surface) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < surface.triangles.rows(); ++i) {
    const auto row = surface.triangles.row(i);
    if (row[0] != row[1] && row[1] != row[2] && row[2] != row[0]) {
      kept.push_back(i);
    }
  }
  surface.triangles = surface.triangles(kept, Eigen::all).eval();
  return surface;
}

Fixation ball_at(const Vec3& at_m, double radius_m) {
  Fixation ball;
  ball.shape = RegionShape::ball;
  ball.at_m = at_m;
  ball.radius_m = radius_m;
  return ball;
}
PlateSpec bent(TriangleSurface middle, double thickness_m, double band_hz) {
  PlateSpec sheet{{sheet_body(std::move(middle), thickness_m), {}, {}}, sheet_steel, band_hz};
  sheet.mesh.shell_width_m = widest_shells_m(sheet.shape);
  return sheet;
}
void check_frequencies(const Eigen::ArrayXd& found_hz, const std::vector<double>& expected_hz,
                       double tolerance) {
  const std::vector<double> all_found_hz(found_hz.begin(), found_hz.end());
  CAPTURE(all_found_hz, expected_hz);
  REQUIRE(all_found_hz.size() >= expected_hz.size());
  for (std::size_t i = 0; i < expected_hz.size(); ++i) {
    CAPTURE(i);
    CHECK(found_hz[static_cast<Eigen::Index>(i)] == Approx(expected_hz[i]).epsilon(tolerance));
  }
}
}  // namespace

// Baker 1961, Axisymmetric modes of vibration of thin spherical shells: with W = (w R)² rho / E,
// W² - (n (n + 1) + 1 + 3 nu) W / (1 - nu²) + (n² + n - 2) / (1 - nu²) = 0; each 2 n + 1 times.
TEST_CASE("a closed spherical sheet has the frequencies of its membrane", "[core][model][bent]") {
  constexpr double radius_m = 0.1;
  constexpr double nu = 0.3;
  std::vector<double> expected_hz;
  for (const int n : {2, 3}) {
    const double sum = (n * (n + 1.0) + 1.0 + 3.0 * nu) / (1.0 - nu * nu);
    const double product = (n * n + n - 2.0) / (1.0 - nu * nu);
    const double w2 = 0.5 * (sum - std::sqrt(sum * sum - 4.0 * product));
    const double hz =
        std::sqrt(w2 * sheet_steel.youngs_modulus_pa / sheet_steel.density_kg_per_m3) /
        (2.0 * std::numbers::pi * radius_m);
    expected_hz.insert(expected_hz.end(), static_cast<std::size_t>(2 * n + 1), hz);
  }
  const PlateModel built = build_plate_model(
      bent(testing::sphere_surface(radius_m, 8), 0.001, 1.03 * expected_hz.back()));
  CHECK(built.body.modes.report.rigid_body_modes == 6);
  CHECK(built.modal.frequency_hz.size() == 12);
  check_frequencies(built.modal.frequency_hz, expected_hz, 0.004);
}

namespace {
// Flügge 1962 (Leissa 1973, Vibration of Shells, section 2.1) of a tube whose ends are held round
// and across alone: m half waves along, n waves round.
double tube_hz(double radius_m, double length_m, double thickness_m, int m, int n) {
  const double nu = sheet_steel.poissons_ratio;
  const double l = m * std::numbers::pi * radius_m / length_m;
  const double k = std::pow(thickness_m / radius_m, 2) / 12.0;
  const double less = 0.5 * (1.0 - nu);
  const double more = 0.5 * (1.0 + nu);
  Eigen::Matrix3d stiffness;
  stiffness(0, 0) = l * l + (1.0 + k) * less * n * n;
  stiffness(0, 1) = -more * l * n;
  stiffness(0, 2) = -nu * l + k * (-l * l * l + less * l * n * n);
  stiffness(1, 1) = n * n + (1.0 + 3.0 * k) * less * l * l;
  stiffness(1, 2) = n + k * 0.5 * (3.0 - nu) * l * l * n;
  stiffness(2, 2) = 1.0 + k * (std::pow(l * l + n * n, 2) + 1.0 - 2.0 * n * n);
  stiffness.triangularView<Eigen::StrictlyLower>() = stiffness.transpose();
  const double w2 = core::symmetric_eigenpairs(stiffness).values[0];
  return std::sqrt(w2 * sheet_steel.youngs_modulus_pa /
                   (sheet_steel.density_kg_per_m3 * (1.0 - nu * nu))) /
         (2.0 * std::numbers::pi * radius_m);
}
}  // namespace

TEST_CASE("a tube whose ends keep their shape has the frequencies of Flügge's theory",
          "[core][model][bent]") {
  constexpr double radius_m = 0.05;
  constexpr double length_m = 0.2;
  constexpr double thickness_m = 0.001;
  std::vector<double> expected_hz;
  for (int m = 1; m < 4; ++m) {
    for (int n = 1; n < 9; ++n) {
      const double hz = tube_hz(radius_m, length_m, thickness_m, m, n);
      expected_hz.insert(expected_hz.end(), 2, hz);
    }
  }
  std::ranges::sort(expected_hz);
  expected_hz.resize(10);
  PlateSpec sheet = bent(tube(radius_m, length_m, 28, 8), thickness_m, 1.05 * expected_hz.back());
  for (const Side side : {Side::left, Side::right}) {
    Fixation end;
    end.shape = RegionShape::side;
    end.side = side;
    end.constrained_axes = {false, true, true};
    sheet.fixations.push_back(end);
  }
  const PlateModel built = build_plate_model(sheet);
  CHECK(built.body.modes.report.rigid_body_modes == 1);
  check_frequencies(built.modal.frequency_hz, expected_hz, 0.005);
}

TEST_CASE("a flat surface with a thickness has the frequencies of the plate",
          "[core][model][bent]") {
  const Vec3 size_m{0.2, 0.14, 0.001};
  PlateSpec plate{{Box{size_m}, {}, {}}, sheet_steel, 600.0};
  plate.mesh.shell_width_m = 0.05;
  const PlateSpec surface =
      bent(grid(6, 4,
                [&](double u, double v) {
                  return Eigen::RowVector3d{size_m.x() * (u - 0.5), size_m.y() * (v - 0.5), 0.02};
                }),
           size_m.z(), plate.band_limit_hz);
  CHECK(volume_m3(surface.shape) == Approx(size_m.prod()).epsilon(1e-9));
  const Eigen::ArrayXd of_plate_hz = build_plate_model(plate).modal.frequency_hz;
  const PlateModel of_surface = build_plate_model(surface);
  REQUIRE(of_plate_hz.size() >= 8);
  REQUIRE(of_surface.modal.frequency_hz.size() == of_plate_hz.size());
  CHECK((of_surface.modal.frequency_hz / of_plate_hz - 1.0).abs().maxCoeff() < 3e-3);
}

TEST_CASE("rigid motions strain no bent or folded sheet, and have its mass",
          "[core][model][bent]") {
  constexpr double thickness_m = 0.001;
  const bool is_folded = GENERATE(true, false);
  CAPTURE(is_folded);
  const Vec3 size_m{0.2, 0.15, 0.1};
  const PlateSpec sheet = is_folded ? bent(open_box(size_m, 1), thickness_m, 1.0)
                                    : bent(without_points(bowl(0.1, 1.0, 4)), thickness_m, 1.0);
  const DiscreteBody body = discretised(sheet, sheet_steel, {}, {}, {});
  CHECK(body.matrices.rigid_body_modes == 6);
  const Modes modes = solve_modes(body.matrices, sheet.band_limit_hz);
  CHECK(modes.counted_in_band == 6);
  REQUIRE(modes.rigid_shapes.cols() == 6);
  CHECK((body.matrices.stiffness() * modes.rigid_shapes).norm() <
        1e-8 * body.matrices.K.norm() * modes.rigid_shapes.norm());

  // Twice the energy of moving along one axis with unit speed.
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(body.displacement.cols());
  for (Eigen::Index middle = 1; middle < body.mesh.nodes_m.rows(); middle += layers) {
    for (decltype(body.displacement)::InnerIterator share{body.displacement, 3 * middle + 2}; share;
         ++share) {
      moved[share.col()] = share.value();
    }
  }
  const double area_m2 =
      is_folded ? size_m.x() * size_m.y() + 2.0 * (size_m.x() + size_m.y()) * size_m.z()
                : 2.0 * std::numbers::pi * 0.1 * 0.1 * (1.0 - std::cos(1.0));
  CHECK(moved.dot(body.matrices.mass() * moved) ==
        Approx(sheet_steel.density_kg_per_m3 * area_m2 * thickness_m).epsilon(1e-3));
}

// A patch test: strain that is the same everywhere takes no force inside, on triangles of any form.
TEST_CASE("a flat sheet of uneven triangles under even strain has no force inside",
          "[core][model][bent]") {
  std::vector<Eigen::RowVector3d> points{{0.0, 0.0, 0.0},   {0.24, 0.0, 0.0},  {0.24, 0.12, 0.0},
                                         {0.0, 0.12, 0.0},  {0.04, 0.02, 0.0}, {0.18, 0.03, 0.0},
                                         {0.16, 0.08, 0.0}, {0.08, 0.08, 0.0}};
  std::vector<Eigen::RowVector3i> triangles{{0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7},
                                            {2, 7, 6}, {3, 0, 4}, {3, 4, 7}, {4, 5, 6}, {4, 6, 7}};
  const PlateSpec sheet = bent(testing::surface_of(points, triangles), 0.001, 1.0);
  const DiscreteBody body = discretised(sheet, sheet_steel, {}, {}, {});
  Eigen::VectorXd of_nodes(body.displacement.rows());
  for (Eigen::Index node = 0; node < body.mesh.nodes_m.rows(); ++node) {
    const auto at_m = body.mesh.nodes_m.row(node);
    // Stretched and sheared in its plane, and bent to w = x² + x y with the normals turned.
    of_nodes.segment<3>(3 * node) << at_m.x() + 0.5 * at_m.y(), 0.5 * at_m.x() - at_m.y(), 0.0;
    of_nodes[3 * node] -= at_m.z() * (2.0 * at_m.x() + at_m.y());
    of_nodes[3 * node + 1] -= at_m.z() * at_m.x();
    of_nodes[3 * node + 2] += at_m.x() * (at_m.x() + at_m.y());
  }
  const SparseMatrix displacement = body.displacement;
  const SparseMatrix normal = displacement.transpose() * displacement;
  const Eigen::VectorXd unknowns =
      Eigen::SimplicialLDLT<SparseMatrix>{normal}.solve(displacement.transpose() * of_nodes);
  REQUIRE((displacement * unknowns - of_nodes).norm() < 1e-6 * of_nodes.norm());
  const Eigen::VectorXd forces_n = body.matrices.stiffness() * unknowns;
  double inside_n = 0.0;
  for (Eigen::Index node = 0; node < body.mesh.nodes_m.rows(); ++node) {
    const auto at_m = body.mesh.nodes_m.row(node);
    const bool is_inside =
        at_m.x() > 1e-6 && at_m.x() < 0.24 - 1e-6 && at_m.y() > 1e-6 && at_m.y() < 0.12 - 1e-6;
    for (Eigen::Index axis = 0; is_inside && axis < 3; ++axis) {
      for (decltype(body.displacement)::InnerIterator share{body.displacement, 3 * node + axis};
           share; ++share) {
        inside_n = std::max(inside_n, std::abs(forces_n[share.col()]));
      }
    }
  }
  CHECK(inside_n < 1e-9 * forces_n.cwiseAbs().maxCoeff());
}

namespace {
// Sheets of S8R, eight nodes each, over grids; nodes in one place are one.
class CalculixSheets {
 public:
  template <class At>
  void add(int across, int along, const At& at) {
    for (int i = 0; i < 2 * across; i += 2) {
      for (int j = 0; j < 2 * along; j += 2) {
        const auto node = [&](int right, int up) {
          return number(at(0.5 * (i + right) / across, 0.5 * (j + up) / along));
        };
        elements_ +=
            fmt::format("{},{},{},{},{},{},{},{},{}\n", ++count_, node(0, 0), node(2, 0),
                        node(2, 2), node(0, 2), node(1, 0), node(2, 1), node(1, 2), node(0, 1));
      }
    }
  }
  std::string text(double thickness_m, int modes) const {
    return "*NODE, NSET=ALL\n" + nodes_ + "*ELEMENT, TYPE=S8R, ELSET=SHEET\n" + elements_ +
           fmt::format(
               "*MATERIAL, NAME=M\n*ELASTIC\n{},{}\n*DENSITY\n{}\n*SHELL SECTION, ELSET=SHEET, "
               "MATERIAL=M\n{}\n*STEP\n*FREQUENCY\n{}\n*END STEP\n",
               sheet_steel.youngs_modulus_pa, sheet_steel.poissons_ratio,
               sheet_steel.density_kg_per_m3, thickness_m, modes);
  }

 private:
  int number(const Eigen::RowVector3d& at_m) {
    const std::array<long, 3> key{std::lround(1e8 * at_m.x()), std::lround(1e8 * at_m.y()),
                                  std::lround(1e8 * at_m.z())};
    const auto [known, is_new] = numbers_.try_emplace(key, static_cast<int>(numbers_.size()) + 1);
    if (is_new) {
      nodes_ +=
          fmt::format("{},{:.12g},{:.12g},{:.12g}\n", known->second, at_m.x(), at_m.y(), at_m.z());
    }
    return known->second;
  }
  std::map<std::array<long, 3>, int> numbers_;
  std::string nodes_;
  std::string elements_;
  int count_{0};
};
}  // namespace

TEST_CASE("CalculiX finds the frequencies of a bent and of a folded sheet with its shells S8R",
          "[core][model][calculix][bent][slow]") {
  constexpr double thickness_m = 0.001;
  const bool is_folded = GENERATE(true, false);
  CAPTURE(is_folded);
  const Vec3 size_m{0.2, 0.15, 0.1};
  CalculixSheets calculix;
  if (is_folded) {
    for (int wall = 0; wall < walls_of_box; ++wall) {
      calculix.add(12, 12, [&](double u, double v) { return on_open_box(size_m, wall, u, v); });
    }
  } else {
    calculix.add(40, 16, [](double u, double v) { return on_tube(0.05, 0.2, u, v); });
  }
  std::vector<double> theirs_hz = testing::calculix_hz(calculix.text(thickness_m, 16), 16);
  REQUIRE(theirs_hz.size() == 16);
  theirs_hz.erase(theirs_hz.begin(), theirs_hz.begin() + 6);  // motions of the rigid body
  const PlateSpec sheet = is_folded
                              ? bent(open_box(size_m, 4), thickness_m, 1.02 * theirs_hz.back())
                              : bent(tube(0.05, 0.2, 28, 8), thickness_m, 1.02 * theirs_hz.back());
  // CalculiX joins solid elements along a fold by a rigid knot, as wide as the sheet is thick.
  check_frequencies(build_plate_model(sheet).modal.frequency_hz, theirs_hz,
                    is_folded ? 0.012 : 0.005);
}

TEST_CASE("a bowl is held, sprung and joined to another as other bodies are",
          "[core][model][bent]") {
  PlateSpec sheet = bent(without_points(bowl(0.1, 1.0, 4)), 0.001, 1200.0);
  const Fixation foot = ball_at({0.0, 0.0, -0.1}, 0.03);
  const JointSpring::End from{0, foot};
  const JointSpring::End to{1, foot};
  const Eigen::ArrayXd alone_hz = build_plate_model(sheet).modal.frequency_hz;
  PlateSpec joined = sheet;
  joined.joints = std::make_shared<const Joints>(
      Joints{{JoinedBody{sheet, sheet_steel}}, {{from, to, {1e4, 1e4, 1e4}, 0.0}}});
  const PlateModel both = build_plate_model(joined);
  REQUIRE(alone_hz.size() >= 2);
  for (const double hz : alone_hz) {                                      // moving together
    CHECK((both.modal.frequency_hz / hz - 1.0).abs().minCoeff() < 1e-3);  // has wider triangles
  }
  sheet.fixations = {foot};
  const Eigen::ArrayXd held_hz = build_plate_model(sheet).modal.frequency_hz;
  sheet.fixations[0].springs_n_per_m = Vec3{1e14, 1e14, 1e14};
  const Eigen::ArrayXd sprung_hz = build_plate_model(sheet).modal.frequency_hz;
  REQUIRE(held_hz.size() == sprung_hz.size());
  CHECK((sprung_hz / held_hz - 1.0).abs().maxCoeff() < 2e-3);
}

// Springs between what is held anyway join nothing.
TEST_CASE("the estimated frequencies of two bent sheets are those of each alone, together",
          "[core][model][bent]") {
  const auto on_foot = [](double radius_m) {
    PlateSpec sheet = bent(without_points(bowl(radius_m, 1.1, 2)), 0.0015, 1600.0);
    sheet.fixations = {ball_at({0.0, 0.0, -radius_m}, 0.2 * radius_m)};
    return sheet;
  };
  const auto solved = [](const PlateSpec& sheet) {
    BodyModes modes = build_plate_model(sheet, {}, ErrorEstimation::wanted).body.modes;
    CHECK(modes.estimate.not_estimated.empty());
    return modes;
  };
  PlateSpec joined = on_foot(0.08);
  const PlateSpec other = on_foot(0.06);
  const std::array<BodyModes, 2> alone{solved(joined), solved(other)};
  std::vector<double> expected;
  double largest_drop = 0.0;
  for (const BodyModes& one : alone) {
    const Eigen::ArrayXd& estimated = one.estimate.kappa_rad_per_m;
    REQUIRE(estimated.size() >= one.kappa_rad_per_m.size());
    REQUIRE(one.kappa_rad_per_m.size() >= 2);
    const auto both = one.kappa_rad_per_m.size();
    largest_drop =
        std::max(largest_drop, (one.kappa_rad_per_m / estimated.head(both) - 1.0).maxCoeff());
    expected.insert(expected.end(), estimated.begin(), estimated.begin() + both);
  }
  CHECK(largest_drop > 1e-3);  // else nothing is estimated
  std::ranges::sort(expected);
  const JointSpring::End from{0, joined.fixations[0]};
  const JointSpring::End to{1, other.fixations[0]};
  joined.joints = std::make_shared<const Joints>(
      Joints{{JoinedBody{other, sheet_steel}}, {{from, to, {1.0, 1.0, 1.0}, 0.0}}});
  const Eigen::ArrayXd together = solved(joined).estimate.kappa_rad_per_m;
  CAPTURE(together, expected);
  REQUIRE(together.size() >= std::ssize(expected));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(together[static_cast<Eigen::Index>(i)] == Approx(expected[i]).epsilon(1e-5));
  }
}

namespace {
// A part of a tube, a radian round, 50 times wider than thick; held at its left end, which is bent.
constexpr double panel_width_m = 0.1;
Eigen::RowVector3d on_panel(double round, double along, double above_m) {
  const double radius_m = panel_width_m + above_m;
  return {panel_width_m * (along - 0.5), radius_m * std::sin(round - 0.5),
          -radius_m * std::cos(round - 0.5)};
}

// Bricks of 20 nodes, on places of half an element's steps of which no two are odd.
class CalculixBricks {
 public:
  CalculixBricks(int across, int through, double thickness_m)
      : steps_{2 * across, 2 * across, 2 * through}, thickness_m_{thickness_m} {
    for (int k = 0; k < steps_[2]; k += 2) {
      for (int j = 0; j < steps_[1]; j += 2) {
        for (int i = 0; i < steps_[0]; i += 2) {
          add({i, j, k});
        }
      }
    }
  }
  Eigen::Index unknowns() const { return 3 * static_cast<Eigen::Index>(numbers_.size()) - held_; }
  std::string text(int modes) const {
    return "*NODE, NSET=ALL\n" + nodes_ + "*ELEMENT, TYPE=C3D20, ELSET=PANEL\n" + elements_ +
           "*BOUNDARY\n" + boundary_ +
           fmt::format(
               "*MATERIAL, NAME=M\n*ELASTIC\n{},{}\n*DENSITY\n{}\n*SOLID SECTION, ELSET=PANEL, "
               "MATERIAL=M\n*STEP\n*FREQUENCY\n{}\n*END STEP\n",
               sheet_steel.youngs_modulus_pa, sheet_steel.poissons_ratio,
               sheet_steel.density_kg_per_m3, modes);
  }

 private:
  using Place = std::array<int, 3>;
  void add(const Place& low) {
    constexpr std::array<Place, 20> corners_and_edges{
        {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2},
         {0, 2, 2}, {1, 0, 0}, {2, 1, 0}, {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2},
         {1, 2, 2}, {0, 1, 2}, {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}}};
    elements_ += fmt::format("{}", ++count_);
    for (const Place& from_low : corners_and_edges) {
      // a line of CalculiX has sixteen numbers at most
      elements_ +=
          fmt::format("{}{}", &from_low == &corners_and_edges[10] ? ",\n" : ",",
                      number({low[0] + from_low[0], low[1] + from_low[1], low[2] + from_low[2]}));
    }
    elements_ += '\n';
  }
  int number(const Place& place) {
    const auto [known, is_new] = numbers_.try_emplace(place, static_cast<int>(numbers_.size()) + 1);
    if (is_new) {
      const auto share = [&](std::size_t axis) {
        return static_cast<double>(place.at(axis)) / steps_.at(axis);
      };
      const auto at_m = on_panel(share(0), share(1), thickness_m_ * (share(2) - 0.5));
      nodes_ +=
          fmt::format("{},{:.12g},{:.12g},{:.12g}\n", known->second, at_m.x(), at_m.y(), at_m.z());
      if (place[1] == 0) {
        boundary_ += fmt::format("{},1,3\n", known->second);
        held_ += 3;
      }
    }
    return known->second;
  }

  Place steps_;
  double thickness_m_;
  std::map<Place, int> numbers_;
  std::string nodes_;
  std::string elements_;
  std::string boundary_;
  Eigen::Index held_{0};
  int count_{0};
};
}  // namespace

TEST_CASE(
    "a bent panel has the frequencies of quadratic solid elements, of 20 times fewer unknowns",
    "[core][model][calculix][bent][slow]") {
  constexpr double thickness_m = panel_width_m / 50.0;
  const CalculixBricks bricks{32, 2, thickness_m};
  const std::vector<double> theirs_hz = testing::calculix_hz(bricks.text(10), 10);
  REQUIRE(theirs_hz.size() == 10);
  PlateSpec sheet = bent(grid(4, 4, [](double u, double v) { return on_panel(u, v, 0.0); }),
                         thickness_m, 1.02 * theirs_hz.back());
  Fixation end;
  end.shape = RegionShape::side;
  end.side = Side::left;
  sheet.fixations = {end};
  const PlateModel built = build_plate_model(sheet);
  check_frequencies(built.modal.frequency_hz, theirs_hz, 0.005);
  CAPTURE(built.body.modes.report.dofs, bricks.unknowns());
  CHECK(20 * built.body.modes.report.dofs <= bricks.unknowns());
}

namespace {
Fixation box_round(const Fixation& ball) {
  Fixation box;
  box.shape = RegionShape::box;
  box.low_m = ball.at_m - Vec3::Constant(ball.radius_m);
  box.high_m = ball.at_m + Vec3::Constant(ball.radius_m);
  return box;
}
PlateSpec bowl_on_ball(int rings, double radius_m) {
  PlateSpec sheet = bent(without_points(bowl(0.08, 1.1, rings)), 0.0015, 340.0);
  sheet.fixations = {ball_at({0.0, 0.0, -0.08}, radius_m)};
  return sheet;
}
}  // namespace

TEST_CASE("a sheet is held by all of a small ball or box, however wide its triangles are",
          "[core][model][bent]") {
  const bool is_box = GENERATE(false, true);
  CAPTURE(is_box);
  const auto first_hz = [&](int rings) {
    PlateSpec sheet = bowl_on_ball(rings, 0.006);
    if (is_box) {
      sheet.fixations[0] = box_round(sheet.fixations[0]);
    }
    sheet.band_limit_hz = 500.0;
    return build_plate_model(sheet).modal.frequency_hz[0];
  };
  CHECK(first_hz(3) == Approx(first_hz(5)).epsilon(0.04));
}

// Southwell 1922, of a thin disc held at its centre: lambda² = 3.75, of Poisson's ratio 0.3.
TEST_CASE("a disc of sheet is held at its centre by a vertex in its middle or on a face",
          "[core][model][bent]") {
  constexpr double radius_m = 0.1;
  constexpr double thickness_m = 0.002;
  const Vec3 at_m{0.0, 0.0, GENERATE(0.0, 0.001, -0.001)};
  CAPTURE(at_m.z());
  PlateSpec disc =
      bent(without_points(grid(24, 6,
                               [](double turn, double out) {
                                 const double angle = 2.0 * std::numbers::pi * turn;
                                 return Eigen::RowVector3d{radius_m * out * std::cos(angle),
                                                           radius_m * out * std::sin(angle), 0.0};
                               })),
           thickness_m, 260.0);
  Fixation centre;
  centre.at_m = at_m;
  disc.fixations = {centre};
  const Eigen::ArrayXd found_hz = build_plate_model(disc).modal.frequency_hz;
  const double rigidity_n_m = sheet_steel.youngs_modulus_pa * std::pow(thickness_m, 3) /
                              (12.0 * (1.0 - std::pow(sheet_steel.poissons_ratio, 2)));
  const double umbrella_hz =
      3.75 / (2.0 * std::numbers::pi * radius_m * radius_m) *
      std::sqrt(rigidity_n_m / (sheet_steel.density_kg_per_m3 * thickness_m));
  CAPTURE(found_hz);
  CHECK((found_hz / umbrella_hz - 1.0).abs().minCoeff() < 0.01);
}

TEST_CASE("a vertex that touches no node of a body is told which one is nearest",
          "[core][model][bent]") {
  PlateSpec sheet = bowl_on_ball(3, 0.006);
  sheet.fixations[0].shape = RegionShape::vertex;
  sheet.fixations[0].at_m = {0.0, 0.0, -0.07};
  CHECK_THROWS_WITH(build_plate_model(sheet), Contains("touches no node of the body") &&
                                                  Contains("the nearest is (") &&
                                                  Contains(", -0.07925) m"));
}

TEST_CASE("a region of which a sheet's nodes span but a part is told", "[core][model][bent]") {
  PlateSpec sheet = bowl_on_ball(3, 0.006);
  Fixation& held = sheet.fixations[0];
  const auto told = [&] {
    const DiscreteBody body = discretised(sheet, sheet_steel, {}, {}, {});
    return held_in_part(body.mesh, sheet.shape, sheet.fixations);
  };
  CHECK(told().empty());
  held = box_round(held);
  CHECK(told().empty());
  // A band at the rim, which is 0.036 m below the middle of the sphere.
  held.low_m = {-1.0, -1.0, -0.0385};
  held.high_m = {1.0, 1.0, 0.0};
  REQUIRE(told().size() == 1);
  CHECK_THAT(told().front(), Contains("fixation 1, the box") && Contains("nodes, which span"));
}

TEST_CASE("narrower shells divide a sheet's triangles and leave its frequencies and its folds",
          "[core][model][bent]") {
  PlateSpec sheet = bent(open_box({0.2, 0.15, 0.1}, 1), 0.001, 320.0);
  const PlateModel coarse = build_plate_model(sheet, {}, ErrorEstimation::wanted);
  sheet.mesh.shell_width_m = 0.5 * sheet.mesh.shell_width_m.value();
  const PlateModel fine = build_plate_model(sheet);
  CHECK(fine.body.modes.report.tets > 3 * coarse.body.modes.report.tets);
  const Eigen::Index count = fine.modal.frequency_hz.size();
  REQUIRE(count >= 3);
  const FrequencyErrors errors =
      frequency_errors(coarse.body.modes, sheet_steel, sheet.band_limit_hz);
  const Eigen::Index common = std::min(count, coarse.modal.frequency_hz.size());
  CHECK((coarse.modal.frequency_hz.head(common) >= fine.modal.frequency_hz.head(common) * 0.9999)
            .all());
  CHECK((coarse.modal.frequency_hz.head(common) / fine.modal.frequency_hz.head(common) - 1.0)
            .maxCoeff() < 2.0 * errors.largest() + 1e-4);
}

TEST_CASE("a sheet is no solid, and not folded back on itself", "[core][model][bent]") {
  PlateSpec sheet = bent(tube(0.05, 0.2, 16, 4), 0.001, 500.0);
  sheet.mesh.shell_width_m.reset();
  CHECK_THROWS_WITH(build_plate_model(sheet), Contains("shell elements, no tetrahedra"));
  const TriangleSurface folded_back =
      testing::surface_of({{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.1, 0.0}, {0.0, 0.1, 0.001}},
                          {{0, 1, 2}, {1, 0, 3}});
  CHECK_THROWS_WITH(sheet_body(folded_back, 0.001), Contains("folded back"));
  CHECK_THROWS_WITH(build_plate_model(bent(tube(0.05, 0.2, 16, 4), 0.2, 500.0)),
                    Contains("more tightly than its thickness"));
}
