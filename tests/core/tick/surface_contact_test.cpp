#include "core/tick/surface_contact.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "core/rng.hpp"
#include "core/tick/plate_contact.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
#include "support/surfaces.hpp"
using namespace tapstudy::core;
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
