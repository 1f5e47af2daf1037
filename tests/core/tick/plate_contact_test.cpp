#include "core/tick/plate_contact.hpp"

#include <vector>

#include "core/placement.hpp"
#include "core/rng.hpp"
#include "support/catch.hpp"
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
