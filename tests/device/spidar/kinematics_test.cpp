#include "device/spidar/kinematics.hpp"

#include <Eigen/LU>
#include <cmath>

#include "core/error.hpp"
#include "device/spidar/string_support.hpp"
#include "device/spidar/tensions.hpp"
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

using device::BoxQp;
using device::Tensions;
using device::TensionSolver;
using device::Wrench;

namespace {
using Qp8 = BoxQp<8>;
const Strings at_rest = strings_at(device::spidar_geometry("X3R"), {});

// |F - F'|² + 1000 |T - T'|² + smoothness |t|² as Springhead weighs it.
Qp8 weighed(const Wrench& wanted, double smoothness, double torque_weight) {
  const auto force = at_rest.pull.leftCols<3>();
  const auto torque = at_rest.pull.rightCols<3>();
  return {force * force.transpose() + torque_weight * torque * torque.transpose() +
              smoothness * Eigen::Matrix<double, 8, 8>::Identity(),
          force * wanted.force_n + torque_weight * torque * wanted.torque_nm,
          PerString::Constant(0.3), PerString::Constant(20.0)};
}

PerString solved(const Qp8& problem) {
  device::BoxQpSolver<8> solver;
  const auto solution = solver.solve(problem, problem.low);
  REQUIRE(solution.is_optimal);
  return solution.x;
}

PerString listed(std::initializer_list<double> values) {
  PerString all;
  Eigen::Index i = 0;
  for (const double value : values) {
    all[i++] = value;
  }
  return all;
}

// The minimum by trying every way to hold unknowns at their bounds: 3^8 of them.
PerString by_enumeration(const Qp8& problem) {
  PerString best;
  double least = HUGE_VAL;
  for (int way = 0; way < 6561; ++way) {
    PerString x;
    std::vector<Eigen::Index> open;
    for (Eigen::Index i = 0, rest = way; i < 8; ++i, rest /= 3) {
      x[i] = rest % 3 == 0 ? problem.low[i] : problem.high[i];
      if (rest % 3 == 2) {
        x[i] = 0.0;
        open.push_back(i);
      }
    }
    if (!open.empty()) {
      const Eigen::VectorXd pull = (problem.c - problem.Q * x)(open);
      const Eigen::VectorXd inside =
          Eigen::MatrixXd{problem.Q(open, open)}.partialPivLu().solve(pull);
      x(open) = inside;
    }
    const bool is_inside =
        ((x - problem.low).array() >= -1e-9).all() && ((problem.high - x).array() >= -1e-9).all();
    const double value = 0.5 * x.dot(problem.Q * x) - problem.c.dot(x);
    if (is_inside && value < least) {
      least = value;
      best = x;
    }
  }
  return best;
}
}  // namespace

TEST_CASE("the reference's tensions come out to their last printed digit", "[device][spidar]") {
  struct Case {
    Wrench wanted;
    double smoothness;
    double torque_weight;
    PerString tension_n;
  };
  const Case one = GENERATE(
      Case{{{3, 0, 0}, {0, 0, 0}},
           1e-3,
           1000.0,
           listed({0.305136, 0.309390, 2.067358, 0.3, 0.305136, 0.309390, 2.067358, 0.3})},
      Case{{{0, 0, 0}, {0, 0.05, 0}},
           1e-3,
           1000.0,
           listed({2.211881, 0.3, 1.789202, 0.635668, 2.211881, 0.3, 1.789202, 0.635668})},
      Case{{{60, 0, 0}, {0, 0, 0}}, 1e-3, 1000.0, listed({0.3, 0.3, 20, 0.3, 0.3, 0.3, 20, 0.3})},
      Case{{{3, 0, 0}, {0, 0, 0}},
           0.3,
           6.0,
           listed({0.3, 0.3, 1.705539, 0.3, 0.3, 0.3, 1.705539, 0.3})});
  const PerString found = solved(weighed(one.wanted, one.smoothness, one.torque_weight));
  CAPTURE(found.transpose());
  CHECK((found - one.tension_n).cwiseAbs().maxCoeff() < 5.1e-7);
}

TEST_CASE("what the reference's tensions do to the grip is the reference's", "[device][spidar]") {
  const PerString pushed = solved(weighed({{3, 0, 0}, {0, 0, 0}}, 1e-3, 1000.0));
  const core::Vec3 force_n = at_rest.pull.leftCols<3>().transpose() * pushed;
  CHECK((force_n - core::Vec3{2.99756, 0, -0.00320}).cwiseAbs().maxCoeff() < 5.1e-6);
  const PerString turned = solved(weighed({{0, 0, 0}, {0, 0.05, 0}}, 1e-3, 1000.0));
  CHECK(at_rest.pull.col(4).dot(turned) == Approx(0.049713).margin(5.1e-7));
  const PerString most = solved(weighed({{60, 0, 0}, {0, 0, 0}}, 1e-3, 1000.0));
  CHECK(at_rest.pull.col(0).dot(most) == Approx(33.34567).margin(5.1e-6));
}

TEST_CASE("the active set finds what enumeration finds on a thousand problems",
          "[device][spidar][slow]") {
  const auto geometry = device::spidar_geometry("X3R");
  core::Rng rng{4};
  for (int i = 0; i < 1000; ++i) {
    const Strings strings = strings_at(geometry, testing::random_pose(rng, 0.02, 0.3));
    Eigen::Matrix<double, 8, 6> effect = strings.pull;
    effect.rightCols<3>() /= 0.03;
    Eigen::Matrix<double, 6, 1> wanted;
    wanted << testing::random_vector(rng, 15.0), testing::random_vector(rng, 5.0);
    const Qp8 problem{effect * effect.transpose() + 1e-3 * Eigen::Matrix<double, 8, 8>::Identity(),
                      effect * wanted, PerString::Constant(0.3), PerString::Constant(8.0)};
    CHECK((solved(problem) - by_enumeration(problem)).cwiseAbs().maxCoeff() < 1e-7);
  }
}

TEST_CASE("a force the strings can make is made exactly, without torque", "[device][spidar]") {
  core::Rng rng{5};
  const auto geometry = device::spidar_geometry(GENERATE("X3R", "X3L"));
  TensionSolver solver{{0.3, 10.0}};
  for (int i = 0; i < 1000; ++i) {
    const Strings strings = strings_at(geometry, testing::random_pose(rng, 0.01, 0.1));
    const Wrench wanted{testing::random_vector(rng, 3.0), core::Vec3::Zero()};
    const Tensions found = solver.solve(strings, wanted);
    CHECK(found.share == Approx(1.0).epsilon(1e-9));
    CHECK((found.achieved.force_n - wanted.force_n).norm() < 1e-5);
    CHECK(found.achieved.torque_nm.norm() < 1e-6);
    CHECK(found.tension_n.minCoeff() >= 0.3);
    CHECK(found.tension_n.maxCoeff() <= 10.0);
  }
}

TEST_CASE("the largest forces along the axes are the reference's", "[device][spidar]") {
  struct Case {
    double max_n;
    core::Vec3 direction;
    double limit_n;
  };
  const Case one = GENERATE(Case{5.0, {1, 0, 0}, 7.95}, Case{5.0, {-1, 0, 0}, 7.66},
                            Case{5.0, {0, 1, 0}, 6.88}, Case{5.0, {0, 0, 1}, 7.66},
                            Case{10.0, {1, 0, 0}, 16.4}, Case{10.0, {0, -1, 0}, 14.2},
                            Case{20.0, {1, 0, 0}, 33.3}, Case{20.0, {0, 1, 0}, 28.8});
  TensionSolver solver{{0.3, one.max_n}};
  const Tensions found = solver.solve(at_rest, {1000.0 * one.direction, core::Vec3::Zero()});
  CHECK(found.achieved.force_n.dot(one.direction) == Approx(one.limit_n).epsilon(4e-3));
}

TEST_CASE("a force that is too large loses size, not direction", "[device][spidar]") {
  core::Rng rng{6};
  const auto geometry = device::spidar_geometry("X3R");
  TensionSolver solver{{0.3, 5.0}};
  int shortened = 0;
  for (int i = 0; i < 1000; ++i) {
    const Strings strings = strings_at(geometry, testing::random_pose(rng, 0.01, 0.1));
    const Wrench wanted{testing::random_vector(rng, 30.0), core::Vec3::Zero()};
    const Tensions found = solver.solve(strings, wanted);
    shortened += found.share < 0.999 ? 1 : 0;
    CHECK((found.achieved.force_n - found.share * wanted.force_n).norm() < 1e-3);
    CHECK(found.achieved.torque_nm.norm() < 1e-4);
    CHECK(found.tension_n.maxCoeff() <= 5.0);
  }
  CHECK(shortened > 500);
}

TEST_CASE("strings hold a grip still near the middle and not when it is turned far",
          "[device][spidar]") {
  const auto geometry = device::spidar_geometry("X3R");
  CHECK(closure_margin(at_rest) > 0.1);
  core::Rng rng{7};
  int held = 0;
  for (int i = 0; i < 500; ++i) {
    core::Vec3 axis = testing::random_vector(rng, 1.0);
    const device::Pose turned{core::Vec3::Zero(), device::rotation_of(0.9 * axis.normalized())};
    held += closure_margin(strings_at(geometry, turned)) > 0.0 ? 1 : 0;
  }
  CHECK(held == 0);  // as the reference's table says: 0 % at 0.9 rad
}

TEST_CASE("where the margin is positive the grip can be held still, where not it cannot",
          "[device][spidar]") {
  core::Rng rng{8};
  const auto geometry = device::spidar_geometry("X3R");
  for (int i = 0; i < 300; ++i) {
    const Strings strings = strings_at(geometry, testing::random_pose(rng, 0.04, 0.6));
    const double margin = closure_margin(strings);
    TensionSolver solver{{0.3, 1e4}};
    const Tensions idle = solver.solve(strings, {});
    if (std::abs(margin) > 5e-3) {
      CHECK((idle.residual_n < 1e-3) == (margin > 0.0));
    }
  }
}

TEST_CASE("pose and tensions take no memory", "[device][spidar][realtime]") {
  const auto geometry = device::spidar_geometry("X3R");
  const PerString length_m = at_rest.length_m;
  TensionSolver solver{{0.3, 10.0}};
  const testing::AllocationCount allocations;
  const auto found = find_pose(geometry, length_m, {}, 3);
  const Strings strings = strings_at(geometry, found.pose);
  const Tensions tensions = solver.solve(strings, {{1.0, 2.0, 3.0}, core::Vec3::Zero()});
  const double margin = closure_margin(strings);
  const std::size_t count = allocations.count();
  CHECK(tensions.share * margin > 0.0);
  CHECK(count == 0);
}
