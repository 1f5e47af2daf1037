// Orthotropic elasticity: what must hold of it whatever the numbers.
#include "core/model/elements/orthotropy.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/error.hpp"
#include "core/model/elements/assembly.hpp"
#include "core/model/joints/joints.hpp"
#include "core/model/mesh/tetgen_mesher.hpp"
#include "core/model/modes/modal_solver.hpp"
#include "core/model/plate_model.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
#include "support/surfaces.hpp"
using namespace tapstudy;
using core::Orthotropy;

namespace {
// Spruce, its axes along the grain, radial and tangential.
core::Material spruce() {
  core::Material material{1.1e10, 420.0, 0.0, core::ConstantDamping{0.01}};
  material.orthotropy =
      Orthotropy{{1.0, 0.07, 0.04}, {0.37, 0.42, 0.47}, {0.06, 0.055, 0.0035}, {0.3, -0.2, 0.5}};
  return material;
}

// The same elasticity, said in nine numbers, about turned axes.
core::Material in_nine_numbers(core::Material isotropic) {
  const double ratio = isotropic.poissons_ratio;
  const double shear = 1.0 / (2.0 * (1.0 + ratio));
  isotropic.poissons_ratio = 0.0;
  isotropic.orthotropy =
      Orthotropy{{1.0, 1.0, 1.0}, {ratio, ratio, ratio}, {shear, shear, shear}, {0.4, 1.0, -0.7}};
  return isotropic;
}

core::PlateSpec board(const core::Material& material, int order) {
  core::PlateSpec spec = testing::paper_plate(4, material);
  spec.mesh.order = order;
  spec.band_limit_hz = 600.0;
  return spec;
}

std::array<double, 3> turn_of(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn{rotation};
  const Eigen::Vector3d vector = turn.angle() * turn.axis();
  return {vector.x(), vector.y(), vector.z()};
}
}  // namespace

TEST_CASE("an isotropic material said in nine numbers has the same frequencies and errors",
          "[core][model][material]") {
  const int order = GENERATE(1, 2);
  const core::PlateSpec plain = board(testing::mdf(), order);
  const core::PlateSpec in_nine = board(in_nine_numbers(testing::mdf()), order);
  const auto solved = [](const core::PlateSpec& spec) {
    return core::build_plate_model(spec, {}, core::ErrorEstimation::wanted);
  };
  const core::PlateModel one = solved(plain);
  const core::PlateModel other = solved(in_nine);
  REQUIRE(one.modal.frequency_hz.size() >= 2);
  CHECK(other.modal.frequency_hz.isApprox(one.modal.frequency_hz, 1e-9));
  CHECK(other.body.modes.estimate.kappa_rad_per_m.isApprox(one.body.modes.estimate.kappa_rad_per_m,
                                                           1e-7));
}

// Specially orthotropic, on simple supports (Leissa 1969, chapter 9; Hearmon 1959):
// w² = (pi⁴ / rho h) (D1 (m/a)⁴ + 2 (D12 + 2 Dk) (m n / a b)² + D2 (n/b)⁴), Di = Ei h³ / 12 (1 -
// n12 n21), D12 = n21 D1, Dk = G12 h³ / 12. Shear across the grain,
// where it is soft, lowers the second by a percent. What is held moves along its side neither: the
// theory knows no twist there.
TEST_CASE("a thin spruce plate on simple supports has its theory's frequencies",
          "[core][model][material]") {
  const core::Vec3 size_m{0.3, 0.2, 0.004};
  core::Material wood = spruce();
  wood.orthotropy->rotation_rad = {0.0, 0.0, 0.0};
  const Orthotropy& given = *wood.orthotropy;
  const double n12 = given.poissons_ratios[0];
  const double n21 = n12 * given.moduli[1] / given.moduli[0];
  const double bending = wood.youngs_modulus_pa * std::pow(size_m.z(), 3) / 12.0;
  const double d1 = bending * given.moduli[0] / (1.0 - n12 * n21);
  const double d2 = bending * given.moduli[1] / (1.0 - n12 * n21);
  const double mixed = n21 * d1 + 2.0 * bending * given.shear_moduli[0];
  const auto theory_hz = [&](int m, int n) {
    const double along = std::pow(m / size_m.x(), 2);
    const double across = std::pow(n / size_m.y(), 2);
    return 0.5 * M_PI *
           std::sqrt((d1 * along * along + 2.0 * mixed * along * across + d2 * across * across) /
                     (wood.density_kg_per_m3 * size_m.z()));
  };
  core::PlateSpec plate{{core::Box{size_m}, {}, {}}, wood, 1.1 * theory_hz(1, 2)};
  plate.mesh.is_automatic = true;
  for (const core::Side side :
       {core::Side::left, core::Side::right, core::Side::front, core::Side::back}) {
    core::Fixation& held = plate.fixations.emplace_back();
    held.shape = core::RegionShape::side;
    held.side = side;
    const bool is_across_x = side == core::Side::left || side == core::Side::right;
    held.constrained_axes = {!is_across_x, is_across_x, true};
  }
  const auto found = core::build_plate_model(plate).modal.frequency_hz;
  REQUIRE(found.size() == 2);
  CHECK(found[0] == Approx(theory_hz(1, 1)).epsilon(0.02));
  CHECK(found[1] == Approx(theory_hz(1, 2)).epsilon(0.02));
}

// A strip whose grain leaves its plane by this angle, clamped at one end: 1 / E = cos⁴ / E1 + sin⁴
// / E3 + sin² cos² (1 / G13 - 2 n13 / E1) (Lekhnitskii, Theory of Elasticity of an Anisotropic
// Body, 1963), and a beam's bending frequencies by it.
TEST_CASE("a strip of shells whose grain leaves its plane bends as a beam of that stiffness",
          "[core][model][material]") {
  const core::Vec3 size_m{0.2, 0.03, 0.0007};
  core::Material wood = spruce();
  const double angle_rad = GENERATE(0.3, 0.9);
  wood.orthotropy->rotation_rad = {0.0, angle_rad, 0.0};
  const Orthotropy& given = *wood.orthotropy;
  const double along = std::pow(std::cos(angle_rad), 2);
  const double across = std::pow(std::sin(angle_rad), 2);
  const double compliance =
      along * along / given.moduli[0] + across * across / given.moduli[2] +
      along * across *
          (1.0 / given.shear_moduli[1] - 2.0 * given.poissons_ratios[1] / given.moduli[0]);
  const double unit_hz =
      size_m.z() / (size_m.x() * size_m.x()) *
      std::sqrt(wood.youngs_modulus_pa / compliance / 12.0 / wood.density_kg_per_m3) / (2.0 * M_PI);
  core::PlateSpec strip{{core::Box{size_m}, {}, {}}, wood, 30.0 * unit_hz};
  strip.mesh.order = 2;
  strip.mesh.shell_width_m = 0.01;
  core::Fixation& held = strip.fixations.emplace_back();
  held.shape = core::RegionShape::side;
  held.side = core::Side::left;
  const auto found_hz = core::build_plate_model(strip).modal.frequency_hz;
  for (const double root : {1.87510, 4.69409}) {  // of cos x cosh x = -1
    const double expected_hz = root * root * unit_hz;
    INFO(expected_hz << " Hz");
    CHECK(std::ranges::any_of(found_hz,
                              [&](double hz) { return std::abs(hz / expected_hz - 1.0) < 0.015; }));
  }
}

TEST_CASE("a body turned together with its material's axes keeps its frequencies",
          "[core][model][material]") {
  core::MeshSize size;
  size.max_tet_volume_m3 = 2e-5;
  core::TetMesh mesh = core::mesh_shape(core::Solid{testing::notched_block()}, size);
  const auto frequencies = [&](const core::Material& material) {
    const std::vector<bool> held(static_cast<std::size_t>(3 * mesh.nodes_m.rows()), false);
    return core::solve_modes(core::assemble(mesh, material, core::free_dofs(held)), 4000.0)
        .omega_rad_s;
  };
  core::Material material = spruce();
  const Eigen::ArrayXd before = frequencies(material);
  REQUIRE(before.size() >= 3);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd{1.1, Eigen::Vector3d{1.0, -2.0, 0.5}.normalized()}.toRotationMatrix();
  mesh.nodes_m = (mesh.nodes_m * turn.transpose()).eval();
  const Eigen::ArrayXd across_the_grain = frequencies(material);
  CHECK_FALSE(
      (across_the_grain.size() == before.size() && across_the_grain.isApprox(before, 1e-3)));
  material.orthotropy->rotation_rad =
      turn_of(turn * core::rotation(material.orthotropy->rotation_rad));
  CHECK(frequencies(material).isApprox(before, 1e-8));
}

TEST_CASE("all moduli twice as large make every frequency sqrt(2) times as high",
          "[core][model][material]") {
  core::PlateSpec spec = board(spruce(), 2);
  const Eigen::ArrayXd before = core::build_plate_model(spec).modal.frequency_hz;
  spec.material.youngs_modulus_pa *= 2.0;
  spec.band_limit_hz *= std::sqrt(2.0);
  const Eigen::ArrayXd after = core::build_plate_model(spec).modal.frequency_hz;
  REQUIRE(before.size() >= 2);
  CHECK(after.isApprox(std::sqrt(2.0) * before, 1e-9));
}

TEST_CASE("an elasticity that would give energy is refused by the inequality that fails",
          "[core][material]") {
  const auto refusal = [](const std::array<double, 3>& moduli, const std::array<double, 3>& ratios,
                          const std::array<double, 3>& shears) {
    const auto fault = core::fault_of({moduli, ratios, shears, {}});
    return fault ? fault->property + ": " + fault->words : std::string{};
  };
  const std::array<double, 3> shears{0.1, 0.1, 0.1};
  // sqrt(E_1 / E_2) = 2
  CHECK(refusal({1.0, 0.25, 1.0}, {1.9, 0.0, 0.0}, shears).empty());
  CHECK_THAT(refusal({1.0, 0.25, 1.0}, {-2.1, 0.0, 0.0}, shears),
             Contains("poissons_ratios: |nu_12| = 2.1 is not less than sqrt(E_1 / E_2) = 2"));
  CHECK_THAT(refusal({1.0, 0.25, 1.0}, {0.0, 0.0, 0.6}, shears),
             Contains("|nu_23| = 0.6 is not less than sqrt(E_2 / E_3) = 0.5"));
  // 1 - 3 nu² - 2 nu³ of equal axes is 0 at one half, where an isotropic solid keeps its volume
  CHECK(refusal({1.0, 1.0, 1.0}, {0.499, 0.499, 0.499}, shears).empty());
  CHECK_THAT(refusal({1.0, 1.0, 1.0}, {0.5, 0.5, 0.5}, shears), Contains("2 nu_21 nu_32 nu_13"));
  CHECK_THAT(refusal({1.0, 1.0, 1.0}, {0.6, 0.6, 0.6}, shears),
             Contains("= -0.512, which is to exceed 0"));
  CHECK_THAT(refusal({1.0, 1.0, 1.0}, {0.0, 0.0, 0.0}, {0.1, 0.0, 0.1}),
             Contains("shear_moduli_pa: each must be greater than 0"));
  CHECK_THAT(refusal({1.0, std::nan(""), 1.0}, {0.0, 0.0, 0.0}, shears),
             Contains("youngs_moduli_pa"));
  core::Material material = spruce();
  CHECK_NOTHROW(core::check_material(material));
  material.orthotropy->poissons_ratios[0] = 5.0;
  CHECK_THROWS_WITH(core::check_material(material), Contains("|nu_12| = 5"));
}

TEST_CASE("bodies whose elasticity differs in any number are solved apart",
          "[core][model][material][cache]") {
  const core::PlateSpec plain = board(testing::mdf(), 2);
  core::PlateSpec wooden = board(spruce(), 2);
  std::vector<std::string> keys{core::content_key(core::body_of(plain)),
                                core::content_key(core::body_of(wooden))};
  using Numbers = std::array<double, 3>;
  for (Numbers Orthotropy::*const of : {&Orthotropy::moduli, &Orthotropy::poissons_ratios,
                                        &Orthotropy::shear_moduli, &Orthotropy::rotation_rad}) {
    core::PlateSpec other = wooden;
    ((*other.material.orthotropy).*of)[2] *= 1.01;
    keys.push_back(core::content_key(core::body_of(other)));
    core::Joints joints;
    joints.bodies.push_back({plain, other.material});
    keys.push_back(core::content_key(joints));
  }
  std::ranges::sort(keys);
  CHECK(std::ranges::adjacent_find(keys) == keys.end());
}

TEST_CASE("a beam in closed form is not made of an orthotropic material", "[core][model][beam]") {
  core::PlateSpec beam{{core::Box{{0.3, 0.03, 0.005}}, {}, {}}, spruce(), 500.0};
  beam.theory = core::Theory::beam;
  core::Fixation end;
  end.shape = core::RegionShape::side;
  beam.fixations = {end};
  CHECK_THROWS_WITH(core::build_plate_model(beam), Contains("isotropic"));
  beam.material.orthotropy.reset();
  CHECK_NOTHROW(core::build_plate_model(beam));
}
