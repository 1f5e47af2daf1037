#include "core/model/modes/damping.hpp"

#include "core/error.hpp"
#include "core/model/elements/material.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
using namespace tapstudy;

TEST_CASE("two ratios put through eq. 13 come back out of eq. 12", "[core][damping]") {
  const core::TwoRatioDamping wanted{0.17, 0.09};
  const Eigen::ArrayXd omega = Eigen::Array3d{360.0, 900.0, 1560.0};
  const core::RayleighDamping found = core::rayleigh_from_two_ratios(wanted, 360.0, 1560.0);
  const Eigen::ArrayXd ratios = core::damping_ratios(found, omega);
  CHECK(ratios[0] == Approx(0.17));
  CHECK(ratios[2] == Approx(0.09));
}

TEST_CASE("ratios that would feed energy into a mode are refused", "[core][damping]") {
  CHECK_THROWS_WITH(core::rayleigh_from_two_ratios({0.5, 0.01}, 100.0, 1000.0),
                    Contains("would gain energy"));
  CHECK_THROWS_AS(core::rayleigh_from_two_ratios({0.1, 0.1}, 500.0, 500.0), core::ModelError);
}

TEST_CASE("a material outside what exists is refused by name", "[core][material]") {
  core::Material material = testing::mdf();
  material.poissons_ratio = 0.5;
  CHECK_THROWS_WITH(core::check_material(material), Contains("poissons_ratio: 0.5"));
  material = testing::mdf();
  material.density_kg_per_m3 = 0.0;
  CHECK_THROWS_WITH(core::check_material(material), Contains("density_kg_per_m3: 0"));
  material = testing::mdf();
  material.youngs_modulus_pa = std::nan("");
  CHECK_THROWS_WITH(core::check_material(material), Contains("youngs_modulus_pa"));
}
