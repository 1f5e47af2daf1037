#include <Eigen/Geometry>

#include "core/haptics/haptic_state.hpp"
#include "support/catch.hpp"
using namespace tapstudy::core;

namespace {
const Placement placement{{0.01, -0.02, 0.03}, 0.1};
}

TEST_CASE("along the normal plate and device agree one to one", "[core][placement]") {
  const HandState hand{{0.01, -0.015, 0.03}, {0.0, -0.3, 0.0}};
  const HandState seen = placement.to_plate(hand);
  CHECK(seen.position_m.isApprox(Vec3{0.0, 0.0, 0.005}));
  CHECK(seen.velocity_m_s.isApprox(Vec3{0.0, 0.0, -0.3}));
}

TEST_CASE("sideways a centimetre of device is ten of plate", "[core][placement]") {
  const HandState right{{0.02, -0.02, 0.03}, Vec3::Zero()};
  CHECK(placement.to_plate(right).position_m.isApprox(Vec3{0.1, 0.0, 0.0}));
  const HandState towards_participant{{0.01, -0.02, 0.04}, Vec3::Zero()};
  CHECK(placement.to_plate(towards_participant).position_m.isApprox(Vec3{0.0, -0.1, 0.0}));
}

TEST_CASE("a point of the plate is found again where the device meets it", "[core][placement]") {
  const Vec3 point_m{0.12, -0.2, 0.004};
  CHECK(placement.to_plate({placement.point_to_device(point_m), {}}).position_m.isApprox(point_m));
}

TEST_CASE("forces turn with the frames, keep their size and their handedness",
          "[core][placement]") {
  const Vec3 x = Placement::force_to_device({1.0, 0.0, 0.0});
  const Vec3 y = Placement::force_to_device({0.0, 1.0, 0.0});
  const Vec3 z = Placement::force_to_device({0.0, 0.0, 1.0});
  CHECK(z == Vec3{0.0, 1.0, 0.0});  // out of the plate is up
  CHECK(x.cross(y).isApprox(z));
}
