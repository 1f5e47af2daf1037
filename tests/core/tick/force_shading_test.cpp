// The force of a tip that slides over triangles, as over the smooth surface they stand for.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/rng.hpp"
#include "core/tick/surface_contact.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
#include "support/surfaces.hpp"
using namespace tapstudy::core;
namespace testing = tapstudy::testing;

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
