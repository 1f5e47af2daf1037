#include "core/tick/god_object.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "core/haptics/haptic_state.hpp"
#include "core/random/rng.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
#include "support/surfaces.hpp"
using namespace tapstudy::core;

namespace {
constexpr double plate_release_m = 5e-4;
HandState at(double z_m, double speed_m_s = 0.0, double x_m = 0.0) {
  return {{x_m, 0.0, z_m}, {0.0, 0.0, speed_m_s}};
}
int strikes(const std::vector<double>& heights_m) {
  PlateContact contact{{0.3, 0.3}, plate_release_m};
  int count = 0;
  for (const double z : heights_m) {
    count += contact.tick(at(z)).impact ? 1 : 0;
  }
  return count;
}
}  // namespace

TEST_CASE("a finger that passes the face strikes once, with its speed", "[core][contact]") {
  PlateContact contact{{0.3, 0.3}, plate_release_m};
  contact.tick(at(0.01, -0.3));
  const Contact impact = contact.tick(at(-0.001, -0.3));
  CHECK(impact.impact);
  CHECK(impact.touching);
  CHECK(impact.impact_speed_m_s == Approx(0.3));
  CHECK(impact.penetration_m == Approx(0.001));
  CHECK(impact.god_object_m == Vec3::Zero());
  CHECK_FALSE(contact.tick(at(-0.002, -0.1)).impact);
}

TEST_CASE("chatter inside the release height does not strike again", "[core][contact]") {
  CHECK(strikes({0.01, -1e-4, 1e-4, -1e-4, 2e-4, -1e-4}) == 1);
  CHECK(strikes({0.01, -1e-4, 1e-4, 6e-4, 1e-4, -1e-4}) == 2);
}

TEST_CASE("a finger found below the face is not in contact", "[core][contact][safety]") {
  PlateContact contact{{0.3, 0.3}, plate_release_m};
  CHECK_FALSE(contact.tick(at(-0.01)).touching);
  CHECK_FALSE(contact.tick(at(-0.005)).touching);
  contact.tick(at(0.001));
  CHECK(contact.tick(at(-0.001)).touching);
}

TEST_CASE("a finger that comes in from the side meets no force", "[core][contact][safety]") {
  PlateContact contact{{0.3, 0.3}, plate_release_m};
  contact.tick(at(0.01, 0.0, 0.4));
  contact.tick(at(-0.01, 0.0, 0.4));
  CHECK_FALSE(contact.tick(at(-0.01, 0.0, 0.2)).touching);
}

TEST_CASE("a finger that slides over the edge is free", "[core][contact]") {
  PlateContact contact{{0.3, 0.3}, plate_release_m};
  contact.tick(at(0.01, 0.0, 0.29));
  CHECK(contact.tick(at(-0.001, 0.0, 0.299)).touching);
  CHECK_FALSE(contact.tick(at(-0.001, 0.0, 0.301)).touching);
  CHECK_FALSE(contact.tick(at(-0.001, 0.0, 0.299)).touching);
}

TEST_CASE("a finger on the very edge of a plate lands, wherever the plate is placed",
          "[core][contact]") {
  Rng rng{3};
  const PlateFace face{0.3, 0.2};
  for (int i = 0; i < 200; ++i) {
    const Placement placement{{rng.uniform(), rng.uniform(), rng.uniform()}, 0.05 + rng.uniform()};
    const auto in_plate = [&](double x_m, double y_m, double z_m) {
      return placement.to_plate({placement.point_to_device({x_m, y_m, z_m}), Vec3::Zero()});
    };
    const double y_m = i % 2 == 0 ? 0.2 : 0.4 * rng.uniform() - 0.2;  // a corner, or along an edge
    PlateContact contact{face, plate_release_m};
    contact.tick(in_plate(0.3, y_m, 0.01));
    CHECK(contact.tick(in_plate(0.3, y_m, -0.001)).touching);
  }
}

namespace testing = tapstudy::testing;

namespace {
constexpr double surface_release_m = 5e-4;
HandState at(const Vec3& place_m, const Vec3& velocity_m_s = Vec3::Zero()) {
  return {place_m, velocity_m_s};
}
// Moves straight in small steps, as a hand does, and gives the last contact.
Contact moved(SurfaceContact& contact, const Vec3& from_m, const Vec3& to_m, int steps = 100) {
  for (int i = 0; i < steps; ++i) {
    contact.tick(at(from_m + (to_m - from_m) * i / steps));
  }
  return contact.tick(at(to_m));
}
// Whether the segment passes through the triangle: its ends on either side of the plane, and all
// three edges passed the same way round.
bool is_pierced(const TriangleSurface& surface, const Eigen::RowVector3i& triangle,
                const Vec3& from_m, const Vec3& to_m) {
  const Vec3 way = to_m - from_m;
  std::array<Vec3, 3> corner;
  for (int i = 0; i < 3; ++i) {
    corner.at(static_cast<std::size_t>(i)) = surface.points_m.row(triangle[i]).transpose() - from_m;
  }
  const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  const Vec3 volumes{way.dot(corner[0].cross(corner[1])), way.dot(corner[1].cross(corner[2])),
                     way.dot(corner[2].cross(corner[0]))};
  const bool are_ends_apart = normal.dot(corner[0]) * normal.dot(corner[0] - way) < 0.0;
  return are_ends_apart && ((volumes.array() >= 0.0).all() || (volumes.array() <= 0.0).all());
}
}  // namespace

TEST_CASE("on a box a surface is what a plate is", "[core][contact][surface]") {
  const TriangleTree tree{testing::box_surface({0.6, 0.6, 0.05})};
  SurfaceContact surface{tree, surface_release_m};
  PlateContact plate{{0.3, 0.3}, surface_release_m};
  Rng rng{3};
  for (int tick = 0; tick < 5000; ++tick) {
    const double z = 0.004 * std::sin(0.02 * tick) + 1e-4 * rng.normal();
    const Vec3 place{0.25 * std::sin(0.003 * tick), 0.25 * std::cos(0.002 * tick), z};
    const HandState tip = at(place, {0.0, 0.0, -0.2});
    const Contact a = surface.tick(tip);
    const Contact b = plate.tick(tip);
    REQUIRE(a.touching == b.touching);
    REQUIRE(a.impact == b.impact);
    CHECK(a.impact_speed_m_s == b.impact_speed_m_s);
    CHECK(std::abs(a.penetration_m - b.penetration_m) < 1e-8);
    CHECK((a.god_object_m - b.god_object_m).norm() < 1e-8);
  }
}

TEST_CASE("on a sphere the god-object is the nearest point and pushes outward",
          "[core][contact][surface]") {
  const double radius_m = 0.1;
  const TriangleTree tree{testing::sphere_surface(radius_m, 40)};
  SurfaceContact contact{tree, surface_release_m};
  moved(contact, {0.0, 0.0, 0.12}, {0.0, 0.0, 0.097});
  for (int tick = 0; tick <= 2000; ++tick) {
    const double angle = 0.001 * tick;
    const Vec3 out{std::sin(angle), 0.0, std::cos(angle)};
    const Contact now = contact.tick(at(0.097 * out));
    REQUIRE(now.touching);
    CHECK(std::abs(now.god_object_m.norm() - radius_m) < 1e-3);  // facets
    CHECK(now.normal.dot(out) > 0.95);
  }
}

TEST_CASE("in a concave corner up to three planes hold the god-object",
          "[core][contact][surface]") {
  // a block with a notch: its floor at z = -0.05, its walls at x = 0 and y = 0
  const TriangleTree tree{testing::notched_block()};
  SurfaceContact contact{tree, surface_release_m};
  moved(contact, {0.02, 0.02, 0.02}, {0.02, 0.02, -0.045});
  const Contact corner = moved(contact, {0.02, 0.02, -0.045}, {-0.003, -0.004, -0.055});
  REQUIRE(corner.touching);
  CHECK((corner.god_object_m - Vec3{0.0, 0.0, -0.05}).norm() < 1e-6);
  CHECK(corner.penetration_m == Approx(std::hypot(0.003, 0.004, 0.005)).epsilon(1e-5));
  const Contact edge = moved(contact, {-0.003, -0.004, -0.055}, {-0.003, 0.02, -0.055});
  CHECK((edge.god_object_m - Vec3{0.0, 0.02, -0.05}).norm() < 1e-6);
  const Contact floor = moved(contact, {-0.003, 0.02, -0.055}, {0.02, 0.02, -0.055});
  CHECK((floor.god_object_m - Vec3{0.02, 0.02, -0.05}).norm() < 1e-6);
}

TEST_CASE("nothing pops through: a finger pressed in stays outside wherever it wanders",
          "[core][contact][surface]") {
  const auto surface = GENERATE(testing::sphere_surface(0.1, 12), testing::notched_block(),
                                testing::box_surface({0.1, 0.1, 0.02}));
  const TriangleTree tree{surface};
  SurfaceContact contact{tree, surface_release_m};
  Rng rng{11};
  Vec3 tip{0.02, 0.02, 0.15};
  Vec3 target = tip;
  int touched = 0;
  for (int tick = 0; tick < 20000; ++tick) {
    if (tick % 400 == 0) {
      target = {0.12 * (2 * rng.uniform() - 1), 0.12 * (2 * rng.uniform() - 1),
                0.12 * (2 * rng.uniform() - 1)};
    }
    tip += 0.01 * (target - tip);
    const Contact now = contact.tick(at(tip));
    touched += now.touching ? 1 : 0;
    // from a point outside, an odd number of walls on the way would mean it is inside
    const Vec3 far{0.713, 0.511, 0.932};
    int walls = 0;
    for (const auto& triangle : surface.triangles.rowwise()) {
      walls += is_pierced(surface, triangle, now.god_object_m, far) ? 1 : 0;
    }
    REQUIRE(walls % 2 == 0);
  }
  CHECK(touched > 500);
}

TEST_CASE("a finger found inside a body is not in contact", "[core][contact][surface][safety]") {
  const TriangleTree tree{testing::sphere_surface(0.1, 12)};
  SurfaceContact contact{tree, surface_release_m};
  CHECK_FALSE(contact.tick(at({0.0, 0.0, 0.05})).touching);
  CHECK_FALSE(moved(contact, {0.0, 0.0, 0.05}, {0.0, 0.0, 0.12}).touching);
  CHECK(moved(contact, {0.0, 0.0, 0.12}, {0.0, 0.0, 0.09}).touching);
}

TEST_CASE("chatter on a surface does not strike again", "[core][contact][surface]") {
  const TriangleTree tree{testing::box_surface({0.1, 0.1, 0.02})};
  SurfaceContact contact{tree, surface_release_m};
  int strikes = 0;
  for (const double z : {0.01, -1e-4, 1e-4, -1e-4, 6e-4, -1e-4}) {
    strikes += contact.tick(at({0.0, 0.0, z}, {0.0, 0.0, -0.1})).impact ? 1 : 0;
  }
  CHECK(strikes == 2);
}

TEST_CASE("a tick on a surface never allocates", "[core][contact][surface][realtime]") {
  const TriangleTree tree{testing::sphere_surface(0.1, 40)};
  SurfaceContact contact{tree, surface_release_m};
  const testing::AllocationCount allocations;
  moved(contact, {0.0, 0.0, 0.12}, {0.05, 0.05, 0.05});
  CHECK(allocations.count() == 0);
}

// The force of a tip that slides over triangles, as over the smooth surface they stand for.
namespace {
constexpr double shaded_release_m = 5e-4;
constexpr double stiffness_n_per_m = 3000.0;
constexpr double pressed_m = 10.0 / stiffness_n_per_m;  // 10 N
constexpr double tilt_at_most = 0.012;                  // an edge of the sphere turns by 0.09 rad
constexpr double step_m = 1e-4;                         // 0.1 m/s at 1 kHz

// A curve `depth` below a surface, by a parameter in which it is smooth; out is its outward normal.
struct Curve {
  std::function<Vec3(double)> at;
  std::function<Vec3(double)> out;
  double end{1.0};
};

struct Slide {
  double largest_step{0.0};      // of the force, over the force
  double work_j{0.0};            // of the force on the tip
  double friction_scale_j{0.0};  // force times path
  double largest_tilt{0.0};      // of the force against the smooth surface's normal [rad]
  bool kept_touching{true};
};

// At 0.1 m/s.
Slide slide_along(const TriangleTree& tree, const Curve& curve) {
  SurfaceContact contact{tree, shaded_release_m};
  for (int tick = -100; tick < 0; ++tick) {  // in from above
    contact.tick({curve.at(0.0) - tick * step_m * curve.out(0.0), Vec3::Zero()});
  }
  Slide slide;
  Vec3 force_before = Vec3::Zero();
  Vec3 tip_before = curve.at(0.0);
  double parameter = 0.0;
  while (parameter < curve.end) {
    const Vec3 tip = curve.at(parameter);
    const Contact& now = contact.tick({tip, Vec3::Zero()});
    const Vec3 force = stiffness_n_per_m * now.penetration_m * now.normal;
    slide.kept_touching = slide.kept_touching && now.touching;
    if (parameter > 0.0) {
      slide.largest_step =
          std::max(slide.largest_step, (force - force_before).norm() / force.norm());
      slide.work_j += 0.5 * (force + force_before).dot(tip - tip_before);
      slide.friction_scale_j += force.norm() * (tip - tip_before).norm();
    }
    const Vec3 out = curve.out(parameter);
    slide.largest_tilt =
        std::max(slide.largest_tilt, std::atan2(now.normal.cross(out).norm(), now.normal.dot(out)));
    force_before = force;
    tip_before = tip;
    const double rate = (curve.at(parameter + 1e-6) - tip).norm() / 1e-6;
    parameter += step_m / rate;
  }
  return slide;
}

Curve great_circle(double radius_m, const Vec3& pole) {
  const Vec3 across = pole.unitOrthogonal();
  const Vec3 along = pole.normalized().cross(across);
  const auto out = [=](double u) -> Vec3 {
    return std::cos(2.0 * M_PI * u) * across + std::sin(2.0 * M_PI * u) * along;
  };
  return {[=](double u) -> Vec3 { return (radius_m - pressed_m) * out(u); }, out, 1.0};
}

// Once around the axis and `turns` times around the tube.
Curve around_torus(double radius_m, double tube_m, int turns, double phase) {
  const auto out = [=](double t) -> Vec3 {
    const double u = 2.0 * M_PI * t;
    const double v = turns * u + phase;
    return {std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v)};
  };
  return {[=](double t) -> Vec3 {
            const double u = 2.0 * M_PI * t;
            return Vec3{radius_m * std::cos(u), radius_m * std::sin(u), 0.0} +
                   (tube_m - pressed_m) * out(t);
          },
          out, 1.0};
}

// A rounded ridge along y, and its height and slope.
double ridge_height(double x) {
  return 0.01 * std::exp(-std::pow(x / 0.03, 2));
}
Vec3 ridge_normal(double x) {
  return Vec3{2.0 * x / (0.03 * 0.03) * ridge_height(x), 0.0, 1.0}.normalized();
}
TriangleTree ridge() {
  std::vector<Eigen::Vector2d> profile{{0.0, -0.05}, {-0.1, -0.05}};
  for (int i = 0; i <= 40; ++i) {
    const double x = 0.005 * (i - 20);
    profile.emplace_back(x, ridge_height(x));
  }
  profile.emplace_back(0.1, -0.05);
  return TriangleTree{testing::prism_surface(profile, 10)};
}
Curve over_ridge() {
  const auto out = [](double t) { return ridge_normal(0.16 * t - 0.08); };
  return {[=](double t) -> Vec3 {
            const double x = 0.16 * t - 0.08;
            return Vec3{x, 0.01 + 0.02 * t, ridge_height(x)} - pressed_m * out(t);
          },
          out, 1.0};
}
}  // namespace

TEST_CASE(
    "sliding at 10 N over facets of a sphere, a torus and a ridge steps the force by less than "
    "1 % and does next to no net work",
    "[core][contact][surface][shading]") {
  const auto is_smooth = [](const Slide& slide) {
    CHECK(slide.kept_touching);
    CHECK(slide.largest_step < 0.01);
    CHECK(slide.largest_tilt < tilt_at_most);
    CHECK(std::abs(slide.work_j) < 0.005 * slide.friction_scale_j);
  };
  const TriangleTree sphere{testing::icosphere_surface(0.1, 3)};
  REQUIRE(sphere.surface().triangles.rows() == 1280);
  Rng rng{4};
  for (int i = 0; i < 10; ++i) {
    is_smooth(slide_along(sphere, great_circle(0.1, {rng.normal(), rng.normal(), rng.normal()})));
  }
  const TriangleTree torus{testing::torus_surface(0.1, 0.04, 60, 30)};
  for (const int turns : {0, 1, 3}) {
    for (const double phase : {0.0, 1.0, 2.2, M_PI}) {
      is_smooth(slide_along(torus, around_torus(0.1, 0.04, turns, phase)));
    }
  }
  is_smooth(slide_along(ridge(), over_ridge()));
}

TEST_CASE("a shaded force depends on where the tip is, not on how it came there",
          "[core][contact][surface][shading]") {
  const TriangleTree torus{testing::torus_surface(0.1, 0.04, 40, 20)};
  const Curve curve = around_torus(0.1, 0.04, 2, 0.3);
  SurfaceContact contact{torus, shaded_release_m};
  for (int tick = -100; tick < 0; ++tick) {
    contact.tick({curve.at(0.0) - tick * step_m * curve.out(0.0), Vec3::Zero()});
  }
  std::vector<Vec3> there;
  for (int tick = 0; tick <= 4000; ++tick) {
    const Contact& now = contact.tick({curve.at(1e-4 * tick), Vec3::Zero()});
    there.emplace_back(now.penetration_m * now.normal);
  }
  for (int tick = 4000; tick >= 0; --tick) {
    const Contact& now = contact.tick({curve.at(1e-4 * tick), Vec3::Zero()});
    CHECK((now.penetration_m * now.normal - there.at(static_cast<std::size_t>(tick))).norm() <
          1e-6 * pressed_m);
  }
}

namespace {
// A roof along y whose faces' normals are this far apart.
TriangleTree roof(double angle_rad) {
  const double fall = 0.1 * std::tan(0.5 * angle_rad);
  return TriangleTree{testing::prism_surface(
      {{0.0, -0.3}, {-0.1, -0.3}, {-0.1, -fall}, {0.0, 0.0}, {0.1, -fall}, {0.1, -0.3}}, 4)};
}
// The largest tilt of the force against the nearer of the roof's two faces, sliding across it.
double largest_tilt_over(const TriangleTree& tree, double angle_rad) {
  SurfaceContact contact{tree, shaded_release_m};
  double largest = 0.0;
  int touched = 0;
  for (int tick = 0; tick <= 1000; ++tick) {
    const double x = 0.05 - 1e-4 * tick;
    const double surface = -std::abs(x) * std::tan(0.5 * angle_rad);
    const double below = 0.003 * std::min(1.0, 0.02 * tick - 0.2);
    const Contact& now = contact.tick({{x, 0.03, surface - below}, Vec3::Zero()});
    if (now.touching) {
      ++touched;
      const double tilt = std::atan2(now.normal.head<2>().norm(), now.normal.z());
      largest = std::max(largest, std::abs(tilt - 0.5 * angle_rad));
    }
  }
  CHECK(touched > 900);
  return largest;
}
}  // namespace

TEST_CASE("an edge is rounded if its faces' normals are at most 30 degrees apart, and else sharp",
          "[core][contact][surface][shading]") {
  for (const double degrees : {31.0, 60.0, 120.0}) {
    const double angle_rad = degrees * M_PI / 180.0;
    CHECK(largest_tilt_over(roof(angle_rad), angle_rad) < 1e-6);
  }
  const double angle_rad = 29.0 * M_PI / 180.0;
  CHECK(largest_tilt_over(roof(angle_rad), angle_rad) > 0.9 * 0.5 * angle_rad);
}

TEST_CASE("flat faces between sharp edges are not shaded", "[core][contact][surface][shading]") {
  for (const TriangleTree& tree : {TriangleTree{testing::box_surface({0.6, 0.6, 0.05}, 5)},
                                   TriangleTree{testing::notched_block()}, roof(M_PI / 3.0)}) {
    for (int triangle = 0; triangle < tree.surface().triangles.rows(); ++triangle) {
      CHECK(tree.is_flat(triangle));
    }
  }
}

TEST_CASE("a foot is the place on the triangles whose mean normal points to it from the tip",
          "[core][contact][surface][shading]") {
  const TriangleTree sphere{testing::icosphere_surface(0.1, 2)};
  Rng rng{8};
  for (int i = 0; i < 2000; ++i) {
    const Vec3 out = Vec3{rng.normal(), rng.normal(), rng.normal()}.normalized();
    const Vec3 tip = (0.05 + 0.04 * rng.uniform()) * out;
    int nearby = 0;
    for (int triangle = 1; triangle < sphere.surface().triangles.rows(); ++triangle) {
      nearby =
          sphere.normal(triangle).dot(out) > sphere.normal(nearby).dot(out) ? triangle : nearby;
    }
    const auto foot = sphere.foot_of(tip, nearby);
    REQUIRE(foot);
    CHECK((foot->place_m - foot->depth_m * foot->normal - tip).norm() < 1e-12);
    CHECK(foot->normal.norm() == Approx(1.0));
    // radial, up to the unevenness of an icosphere's triangles
    CHECK(std::atan2(foot->normal.cross(out).norm(), foot->normal.dot(out)) < 0.03);
    Vec3 place = Vec3::Zero();
    for (int corner = 0; corner < 3; ++corner) {
      const double weight = foot->barycentric.at(static_cast<std::size_t>(corner));
      CHECK(weight > -1e-8);
      const int point = sphere.surface().triangles(foot->triangle, corner);
      place += weight * sphere.surface().points_m.row(point).transpose();
    }
    CHECK((place - foot->place_m).norm() < 1e-12);
  }
}

TEST_CASE("a shaded tick never allocates", "[core][contact][surface][shading][realtime]") {
  const TriangleTree sphere{testing::icosphere_surface(0.1, 3)};
  SurfaceContact contact{sphere, shaded_release_m};
  const Curve circle = great_circle(0.1, {1.0, 2.0, 3.0});
  contact.tick({1.2 * circle.at(0.0), Vec3::Zero()});
  const testing::AllocationCount allocations;
  for (int tick = 0; tick < 5000; ++tick) {
    contact.tick({0.097 * circle.out(1e-3 * tick), Vec3::Zero()});
  }
  CHECK(allocations.count() == 0);
  CHECK(contact.now().touching);
}
