#include "device/spidar/tensions.hpp"

#include <Eigen/LU>
#include <cmath>

#include "device/spidar/string_support.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
using namespace tapstudy;
using device::BoxQp;
using device::PerString;
using device::Strings;
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
