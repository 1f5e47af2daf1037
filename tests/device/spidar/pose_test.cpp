#include "device/spidar/pose.hpp"

#include <cmath>

#include "core/error.hpp"
#include "device/spidar/string_support.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
using namespace tapstudy;
using device::FoundPose;
using device::PerString;
using device::Pose;
using device::Strings;

namespace {
// Of the X3R, computed independently in double precision, printed to 1 nm.
const Pose reference_pose{{0.020, 0.010, -0.015}, device::rotation_of({0.2, -0.3, 0.1})};
PerString reference_length_m() {
  PerString length_m;
  length_m << 0.133696836, 0.119886924, 0.091153816, 0.094627627, 0.118942295, 0.109637808,
      0.081524665, 0.087738006;
  return length_m;
}
}  // namespace

TEST_CASE("the strings of an X3R have the lengths of the reference", "[device][spidar]") {
  const auto geometry = device::spidar_geometry("X3R");
  const PerString at_rest = strings_at(geometry, {}).length_m;
  for (Eigen::Index i = 0; i < 8; ++i) {
    CHECK(at_rest[i] == Approx(i % 4 < 2 ? 0.103838 : 0.100311).margin(5e-7));
  }
  const PerString turned = strings_at(geometry, reference_pose).length_m;
  CHECK((turned - reference_length_m()).cwiseAbs().maxCoeff() < 5.1e-10);
}

TEST_CASE("string i changes by -pull . (dp, dtheta)", "[device][spidar]") {
  const auto geometry = device::spidar_geometry(GENERATE("X3R", "X3L"));
  core::Rng rng{1};
  const Pose pose = testing::random_pose(rng, 0.02, 0.3);
  const Strings before = strings_at(geometry, pose);
  constexpr double small = 1e-7;
  for (int axis = 0; axis < 6; ++axis) {
    Pose moved = pose;
    if (axis < 3) {
      moved.position_m[axis] += small;
    } else {
      moved.rotation = device::rotation_of(small * core::Vec3::Unit(axis - 3)) * pose.rotation;
    }
    const PerString change = strings_at(geometry, moved).length_m - before.length_m;
    CHECK((change / small + before.pull.col(axis)).cwiseAbs().maxCoeff() < 1e-6);
  }
}

TEST_CASE("from the middle the pose is found anywhere within 25 mm and 0.5 rad an axis",
          "[device][spidar]") {
  const auto geometry = device::spidar_geometry(GENERATE("X3R", "X3L"));
  core::Rng rng{2};
  for (int i = 0; i < 2000; ++i) {
    const Pose pose = testing::random_pose(rng, 0.025, 0.5);
    const FoundPose found = find_pose(geometry, strings_at(geometry, pose).length_m, {}, 12);
    REQUIRE(found.has_converged);
    CHECK(found.residual_m < 1e-12);
    CHECK((found.pose.position_m - pose.position_m).norm() < 1e-11);
    CHECK(testing::turn_between(found.pose, pose) < 1e-7);  // acos near 1
  }
}

TEST_CASE("a hand that moves is followed without lag in two rounds", "[device][spidar]") {
  const auto geometry = device::spidar_geometry("X3R");
  core::Rng rng{3};
  for (int i = 0; i < 500; ++i) {
    const Pose before = testing::random_pose(rng, 0.02, 0.3);
    const core::Vec3 step_m = testing::random_vector(rng, 0.0005);
    const Pose after{before.position_m + step_m,
                     device::rotation_of(testing::random_vector(rng, 0.005)) * before.rotation};
    const FoundPose found = find_pose(geometry, strings_at(geometry, after).length_m, before, 2);
    CHECK((found.pose.position_m - after.position_m).norm() < 1e-8);
  }
}

TEST_CASE("a string that slipped shows in the residual", "[device][spidar]") {
  const auto geometry = device::spidar_geometry("X3R");
  PerString length_m = reference_length_m();
  const FoundPose good = find_pose(geometry, length_m, {}, 12);
  CHECK(good.residual_m < 1e-9);
  const int slipped = GENERATE(range(0, 8));
  length_m[slipped] += 0.004;
  CHECK(find_pose(geometry, length_m, {}, 12).residual_m > 2e-4);
}

TEST_CASE("lengths rounded to the encoder's steps give the reference's pose", "[device][spidar]") {
  const auto geometry = device::spidar_geometry("X3R");
  constexpr double step_m = 1.66555e-5;
  const PerString at_rest = strings_at(geometry, {}).length_m;
  const PerString steps =
      ((strings_at(geometry, reference_pose).length_m - at_rest) / step_m).array().round();
  const FoundPose found = find_pose(geometry, at_rest + step_m * steps, {}, 12);
  const core::Vec3 turn = device::rotation_vector_rad(found.pose.rotation);
  // within what half a step can do: 3.5 um and 0.22 mrad rms
  CHECK((found.pose.position_m - reference_pose.position_m).norm() < 1.2e-5);
  CHECK((turn - core::Vec3{0.2, -0.3, 0.1}).norm() < 8e-4);
}

TEST_CASE("lengths that no pose has do not hang and are told", "[device][spidar]") {
  const auto geometry = device::spidar_geometry("X3R");
  const double length_m = GENERATE(0.0, 1e9, std::nan(""), HUGE_VAL);
  const FoundPose found = find_pose(geometry, PerString::Constant(length_m), {}, 12);
  CHECK(!(found.has_converged && found.residual_m < 2e-4));
}

TEST_CASE("only geometries that can hold a grip are offered", "[device][spidar]") {
  CHECK_THROWS_WITH(device::spidar_geometry("X3F"), Contains("do not give wrench closure"));
  CHECK_THROWS_WITH(device::spidar_geometry("X9"), Contains("one of: X3R, X3L"));
}
