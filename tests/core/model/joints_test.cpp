// Bodies joined by springs.
#include "core/model/joints/joints.hpp"

#include <cmath>
#include <memory>
#include <numbers>

#include "core/error.hpp"
#include "core/model/joints/coupled_bodies.hpp"
#include "core/model/modes/damping.hpp"
#include "core/model/plate_model.hpp"
#include "support/calculix.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
using namespace tapstudy;

namespace {
core::Fixation region(core::RegionShape shape, const core::Vec3& at_m, core::Face face) {
  core::Fixation fixation;
  fixation.shape = shape;
  fixation.at_m = at_m;
  fixation.radius_m = shape == core::RegionShape::disc ? 0.01 : 0.0;
  fixation.face = face;
  return fixation;
}
core::Fixation disc(double x, double y, core::Face face) {
  return region(core::RegionShape::disc, {x, y, 0.0}, face);
}
core::Fixation side(core::Side which) {
  core::Fixation fixation;
  fixation.shape = core::RegionShape::side;
  fixation.side = which;
  return fixation;
}

core::Plate block(const core::Vec3& size_m, double tet_volume_m3) {
  core::Plate plate{core::Box{size_m}, {}, {}};
  plate.mesh.order = 2;
  plate.mesh.size.max_tet_volume_m3 = tet_volume_m3;
  return plate;
}
core::Material material_of(double youngs_modulus_pa, double density, double ratio) {
  return {youngs_modulus_pa, density, 0.3, core::ConstantDamping{ratio}};
}

// A small board on a larger one, at four corners.
struct BoardOnBoard {
  explicit BoardOnBoard(core::RegionShape shape) {
    board.material = material_of(3e9, 1180.0, 0.02);
    board.band_limit_hz = 900.0;
    core::JoinedBody table{block({0.4, 0.4, 0.02}, 2e-5), material_of(2.5e9, 610.0, 0.05)};
    table.fixations = {side(core::Side::left), side(core::Side::right)};
    core::Joints joints{{table}, {}};
    for (const auto& [x, y] : {std::pair{-0.1, -0.08}, {0.1, -0.08}, {-0.1, 0.08}, {0.1, 0.08}}) {
      joints.springs.push_back({{0, region(shape, {x, y, 0.0}, core::Face::bottom)},
                                {1, region(shape, {x, y, 0.0}, core::Face::top)},
                                {2e5, 3e5, 1e6}});
    }
    board.joints = std::make_shared<const core::Joints>(joints);
  }
  core::PlateSpec board{block({0.24, 0.2, 0.01}, 4e-6), {}, 0.0};
};

// All of it anew, by what is stated: the same meshes, which the solution does not keep.
core::CoupledBodies discrete(const core::PlateSpec& spec) {
  std::vector<core::Fixation> regions[2];
  for (const core::JointSpring& spring : spec.joints->springs) {
    regions[0].push_back(spring.from.region);
    regions[1].push_back(spring.to.region);
  }
  const core::JoinedBody& other = spec.joints->bodies.front();
  std::vector<core::DiscreteBody> bodies{
      core::discretised(spec, spec.material, spec.mesh.size, regions[0], {}),
      core::discretised(other, other.material, other.mesh.size, regions[1], {})};
  return core::coupled(spec, std::move(bodies), *spec.joints);
}

// A heavy stiff block on feet, each of which is a spring of its own: closed forms below.
core::PlateSpec stiff_block(double band_hz) {
  core::PlateSpec spec{block({0.1, 0.1, 0.05}, 2e-5), material_of(1e13, 2000.0, 0.01), band_hz};
  return spec;
}
constexpr double block_kg = 0.1 * 0.1 * 0.05 * 2000.0;
double natural_hz(double n_per_m, double kg) {
  return std::sqrt(n_per_m / kg) / (2.0 * std::numbers::pi);
}
}  // namespace

TEST_CASE("CalculiX finds the same frequencies of a board on a board",
          "[core][model][calculix][slow]") {
  const core::PlateSpec spec = BoardOnBoard{core::RegionShape::vertex}.board;
  const core::ModalModel ours = core::build_plate_model(spec).modal;
  const core::CoupledBodies system = discrete(spec);
  testing::CalculixInput input;
  const core::JoinedBody& table = spec.joints->bodies.front();
  const std::array<Eigen::Index, 2> first{
      input.add_body(spec, spec.material, system.bodies[0].mesh),
      input.add_body(table, table.material, system.bodies[1].mesh)};
  for (const core::JointSpring& spring : spec.joints->springs) {
    const auto from = core::nodes_of(spring.from.region, system.bodies[0].mesh, spec.shape);
    const auto to = core::nodes_of(spring.to.region, system.bodies[1].mesh, table.shape);
    REQUIRE((from.size() == 1 && to.size() == 1));
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      input.add_spring(first[0] + from[0], first[1] + to[0], axis, spring.stiffness_n_per_m[axis]);
    }
  }
  const auto count = static_cast<int>(ours.frequency_hz.size());
  REQUIRE(count >= 6);
  const std::vector<double> theirs = testing::calculix_hz(input, count);
  REQUIRE(static_cast<int>(theirs.size()) == count);
  for (int i = 0; i < count; ++i) {
    CAPTURE(i, ours.frequency_hz[i], theirs[static_cast<std::size_t>(i)]);
    CHECK(std::abs(ours.frequency_hz[i] / theirs[static_cast<std::size_t>(i)] - 1.0) < 1e-4);
  }
}

TEST_CASE("of each joined body it is known with which radius-edge ratio it was meshed",
          "[core][model]") {
  core::PlateSpec spec = BoardOnBoard{core::RegionShape::vertex}.board;
  core::Joints joints = *spec.joints;
  joints.bodies.front().mesh.size.radius_edge_ratio = 3.0;
  spec.joints = std::make_shared<const core::Joints>(joints);
  const core::ModelReport report = core::report_on(discrete(spec).bodies, core::Modes{});
  REQUIRE(report.bodies.size() == 2);
  CHECK(report.bodies[0].radius_edge_ratio.asked == spec.mesh.size.radius_edge_ratio);
  CHECK(report.bodies[1].radius_edge_ratio.asked == 3.0);
  CHECK(report.bodies[1].radius_edge_ratio.used == 3.0);
  CHECK(report.bodies[1].order == 2);
}

TEST_CASE("a stiff block on four soft feet moves up and down at sqrt(k / m)", "[core][model]") {
  core::PlateSpec spec = stiff_block(60.0);
  core::JoinedBody ground{block({0.3, 0.3, 0.05}, 1e-4), material_of(1e13, 2000.0, 0.01)};
  ground.fixations = {side(core::Side::bottom)};
  core::Joints joints{{ground}, {}};
  for (const auto& [x, y] : {std::pair{-0.03, -0.03}, {0.03, -0.03}, {-0.03, 0.03}, {0.03, 0.03}}) {
    joints.springs.push_back(
        {{0, disc(x, y, core::Face::bottom)}, {1, disc(x, y, core::Face::top)}, {0, 0, 5e3}});
  }
  spec.joints = std::make_shared<const core::Joints>(joints);
  const core::SolvedBody body = core::solve_body(core::body_of(spec));
  CHECK(body.modes.report.rigid_body_modes == 3);  // it slides along x and y, and turns about z
  const core::ModalModel modal = core::model_of(body.modes, spec);
  REQUIRE(modal.frequency_hz.size() == 3);
  // Tilting: 4 k a² / J with J = m (h² + w²) / 12 about the centre.
  const double tilt_kg_m2 = block_kg * (0.05 * 0.05 + 0.1 * 0.1) / 12.0;
  const double up_hz = natural_hz(4.0 * 5e3, block_kg);
  const double tilt_hz = natural_hz(4.0 * 5e3 * 0.03 * 0.03, tilt_kg_m2);
  const auto has = [&](double hz) {
    return ((modal.frequency_hz / hz - 1.0).abs() < 1e-4).count();
  };
  CHECK(has(up_hz) == 1);
  CHECK(has(tilt_hz) == 2);
}

TEST_CASE("a block slides on the ground, however many nodes hold the ground",
          "[core][model][slow]") {
  core::PlateSpec spec = stiff_block(60.0);
  core::JoinedBody ground{block({0.8, 0.8, 0.025}, 3e-6), material_of(1e13, 2000.0, 0.01)};
  ground.fixations = {side(core::Side::bottom)};
  core::Joints joints{{ground}, {}};
  for (const auto& [x, y] : {std::pair{-0.03, -0.03}, {0.03, -0.03}, {0.0, 0.03}}) {
    joints.springs.push_back(
        {{0, disc(x, y, core::Face::bottom)}, {1, disc(x, y, core::Face::top)}, {0, 0, 5e3}});
  }
  spec.joints = std::make_shared<const core::Joints>(joints);
  CHECK(core::solve_body(core::body_of(spec)).modes.report.rigid_body_modes == 3);
}

TEST_CASE("a free assembly has six rigid motions, however its regions are meshed",
          "[core][model][slow]") {
  // of a ball each mesh has other nodes, whose mean is elsewhere
  const auto ball = [](double x, double y, double z) {
    core::Fixation fixation;
    fixation.shape = core::RegionShape::ball;
    fixation.at_m = {x, y, z};
    fixation.radius_m = 0.03;
    return fixation;
  };
  for (const double tet_volume_m3 : {1e-6, 7e-7}) {
    core::PlateSpec spec{block({0.2, 0.15, 0.04}, tet_volume_m3), material_of(3e9, 1180.0, 0.02),
                         900.0};
    core::JoinedBody other{block({0.25, 0.2, 0.05}, 2e-6), material_of(2.5e9, 610.0, 0.02)};
    core::Joints joints{{other}, {}};
    for (const auto& [x, y] :
         {std::pair{-0.063, -0.041}, {0.059, -0.038}, {-0.061, 0.037}, {0.057, 0.042}}) {
      joints.springs.push_back({{0, ball(x, y, -0.04)}, {1, ball(x, y, 0.0)}, {1e6, 2e6, 3e6}});
    }
    spec.joints = std::make_shared<const core::Joints>(joints);
    const core::SolvedBody body = core::solve_body(core::body_of(spec));
    INFO(tet_volume_m3);
    CHECK(body.modes.report.rigid_body_modes == 6);
    REQUIRE(body.modes.kappa_rad_per_m.size() > 0);
    CHECK(core::model_of(body.modes, spec).frequency_hz.minCoeff() > 100.0);
  }
}

TEST_CASE("two equal free blocks on one spring part at sqrt(2 k / m)", "[core][model]") {
  core::PlateSpec spec = stiff_block(200.0);
  const core::JoinedBody other{static_cast<const core::Plate&>(spec), spec.material};
  spec.joints = std::make_shared<const core::Joints>(core::Joints{
      {other}, {{{0, side(core::Side::bottom)}, {1, side(core::Side::top)}, {0.0, 0.0, 1e5}}}});
  const core::SolvedBody body = core::solve_body(core::body_of(spec));
  CHECK(body.modes.report.rigid_body_modes == 11);
  const core::ModalModel modal = core::model_of(body.modes, spec);
  REQUIRE(modal.frequency_hz.size() == 1);
  CHECK(modal.frequency_hz[0] == Approx(natural_hz(2.0 * 1e5, block_kg)).epsilon(1e-4));
  CHECK(body.modes.kinetic_share(0, 0) == Approx(0.5).epsilon(1e-6));
  CHECK(modal.damping_ratio[0] < 1e-6);  // all strain is in the spring, which has no losses
  core::Joints lossy = *spec.joints;
  lossy.springs.front().loss_factor = 0.2;
  CHECK(core::model_of(body.modes, spec.material, 200.0, &lossy).damping_ratio[0] ==
        Approx(0.1).epsilon(1e-4));
}

TEST_CASE("three equal free blocks in a ring of springs part at sqrt(3 k / m)", "[core][model]") {
  core::PlateSpec spec = stiff_block(200.0);
  const core::JoinedBody other{static_cast<const core::Plate&>(spec), spec.material};
  const auto spring = [](std::size_t from, std::size_t to) {
    return core::JointSpring{
        {from, side(core::Side::bottom)}, {to, side(core::Side::bottom)}, {0.0, 0.0, 1e5}};
  };
  spec.joints = std::make_shared<const core::Joints>(
      core::Joints{{other, other}, {spring(0, 1), spring(1, 2), spring(2, 0)}});
  const core::SolvedBody body = core::solve_body(core::body_of(spec));
  CHECK(body.modes.report.rigid_body_modes == 16);
  const core::ModalModel modal = core::model_of(body.modes, spec);
  REQUIRE(modal.frequency_hz.size() == 2);
  CHECK(modal.frequency_hz[0] == Approx(natural_hz(3.0 * 1e5, block_kg)).epsilon(1e-4));
  CHECK(modal.frequency_hz[1] == Approx(natural_hz(3.0 * 1e5, block_kg)).epsilon(1e-4));
}

TEST_CASE("a contact that is stiff beyond all else is a joint: a bar of two halves",
          "[core][model]") {
  core::PlateSpec whole{block({0.4, 0.03, 0.02}, 2e-6), material_of(2e9, 1000.0, 0.02), 250.0};
  whole.fixations = {side(core::Side::left)};
  core::PlateSpec half = whole;
  half.shape = core::Box{{0.2, 0.03, 0.02}};
  half.fixations = {side(core::Side::left)};
  core::JoinedBody rest{block({0.2, 0.03, 0.02}, 2e-6), whole.material};
  core::Joints joints{{rest}, {}};
  // Not the mean of the whole face, which may tilt: those of six parts.
  for (const double y : {-0.015, -0.005, 0.005}) {
    for (const double z : {-0.02, -0.01}) {
      const auto at = [&](double x) {
        core::Fixation part;
        part.shape = core::RegionShape::box;
        part.low_m = {x, y, z};
        part.high_m = {x, y + 0.01, z + 0.01};
        return part;
      };
      joints.springs.push_back({{0, at(0.1)}, {1, at(-0.1)}, core::Vec3::Constant(1e9)});
    }
  }
  half.joints = std::make_shared<const core::Joints>(joints);
  const Eigen::ArrayXd joined_hz = core::build_plate_model(half).modal.frequency_hz;
  const Eigen::ArrayXd whole_hz = core::build_plate_model(whole).modal.frequency_hz;
  REQUIRE(joined_hz.size() == whole_hz.size());
  CAPTURE(joined_hz, whole_hz);
  CHECK((joined_hz / whole_hz - 1.0).abs().maxCoeff() < 0.03);
}

TEST_CASE("the energy of a mode is in the bodies and springs", "[core][model][slow]") {
  const core::PlateSpec spec = BoardOnBoard{core::RegionShape::disc}.board;
  const core::BodyModes modes = core::solve_body(core::body_of(spec)).modes;
  CHECK((modes.kinetic_share.colwise().sum().array() - 1.0).abs().maxCoeff() < 1e-9);
  CHECK(modes.strain_share.minCoeff() >= 0.0);
  CHECK((modes.strain_share.colwise().sum().array() - 1.0).abs().maxCoeff() < 1e-6);
  const core::ModalModel modal = core::model_of(modes, spec);
  const Eigen::ArrayXd expected =
      0.02 * modes.strain_share.row(0) + 0.05 * modes.strain_share.row(1);
  CHECK((modal.damping_ratio - expected.head(modal.damping_ratio.size())).abs().maxCoeff() < 1e-12);
}

TEST_CASE("bodies of one Rayleigh damping, joined by a stiff contact, keep it",
          "[core][model][slow]") {
  core::PlateSpec spec = BoardOnBoard{core::RegionShape::disc}.board;
  const core::RayleighDamping rayleigh{30.0, 4e-5};
  core::Joints joints = *spec.joints;
  spec.material.damping = rayleigh;
  joints.bodies.front().material.damping = rayleigh;
  spec.joints = std::make_shared<const core::Joints>(joints);
  const core::BodyModes modes = core::solve_body(core::body_of(spec)).modes;
  const core::ModalModel modal = core::model_of(modes, spec);
  const Eigen::ArrayXd omega = 2.0 * std::numbers::pi * modal.frequency_hz;
  const Eigen::ArrayXd springs_share =
      modes.strain_share.bottomRows(4).colwise().sum().array().head(omega.size()).transpose();
  const Eigen::ArrayXd expected =
      0.5 * (rayleigh.alpha_per_s / omega + rayleigh.beta_s * omega * (1.0 - springs_share));
  CHECK((modal.damping_ratio / expected - 1.0).abs().maxCoeff() < 1e-9);
}

TEST_CASE("a ratio that is stated for a frequency is that of the material in contact, too",
          "[core][model][slow]") {
  core::PlateSpec spec = BoardOnBoard{core::RegionShape::disc}.board;
  core::Joints joints = *spec.joints;
  spec.material.damping = core::ConstantDamping{};
  joints.bodies.front().material.damping = core::FittedDamping{{{100.0, 0.05}, {400.0, 0.08}}};
  spec.joints = std::make_shared<const core::Joints>(joints);
  const core::BodyModes modes = core::solve_body(core::body_of(spec)).modes;
  const core::ModalModel modal = core::model_of(modes, spec);
  const auto alone = core::damp(joints.bodies.front().material.damping,
                                2.0 * std::numbers::pi * modal.frequency_hz);
  const Eigen::ArrayXd share = modes.strain_share.row(1).head(modal.frequency_hz.size());
  CHECK((modal.damping_ratio - share * alone.ratios).abs().maxCoeff() < 1e-12);
}

TEST_CASE("modal ratios are refused in contact, and a contact that touches nothing",
          "[core][model]") {
  core::PlateSpec spec = BoardOnBoard{core::RegionShape::disc}.board;
  core::PlateSpec listed = spec;
  listed.material.damping = core::ModalDamping{{0.01}, 0.01};
  CHECK_THROWS_AS(core::build_plate_model(listed), core::ModelError);
  core::Joints beside = *spec.joints;
  beside.springs.front().to.region.at_m.x() = 5.0;
  spec.joints = std::make_shared<const core::Joints>(beside);
  CHECK_THROWS_WITH(core::build_plate_model(spec), Contains("contact spring 1, to: the disc") &&
                                                       Contains("touches no node of the body"));
}

TEST_CASE("models differ by every property of a contact, and of what is touched", "[core][model]") {
  const core::PlateSpec spec = BoardOnBoard{core::RegionShape::disc}.board;
  const auto key_with = [&](const auto& change) {
    core::Joints changed = *spec.joints;
    change(changed);
    core::PlateSpec other = spec;
    other.joints = std::make_shared<const core::Joints>(changed);
    return core::content_key(core::body_of(other));
  };
  const std::string own = core::content_key(core::body_of(spec));
  CHECK(own == key_with([](core::Joints&) {}));
  CHECK(own != key_with([](core::Joints& c) { c.springs[0].stiffness_n_per_m.x() *= 2.0; }));
  CHECK(own != key_with([](core::Joints& c) { c.springs[1].from.region.at_m.x() += 0.01; }));
  CHECK(own != key_with([](core::Joints& c) { c.springs.pop_back(); }));
  CHECK(own != key_with([](core::Joints& c) { c.bodies[0].material.density_kg_per_m3 = 1.0; }));
  CHECK(own != key_with([](core::Joints& c) { c.bodies[0].fixations.pop_back(); }));
  core::PlateSpec lighter = spec;
  lighter.material.density_kg_per_m3 /= 2.0;
  CHECK(own != core::content_key(core::body_of(lighter)));
  core::PlateSpec alone = spec;
  alone.joints.reset();
  CHECK(own != core::content_key(core::body_of(alone)));
}

TEST_CASE("contacts that no shift of a body brings together are refused", "[core][model]") {
  core::PlateSpec spec = stiff_block(60.0);
  core::JoinedBody other{block({0.1, 0.1, 0.05}, 2e-5), material_of(1e13, 2000.0, 0.01)};
  const bool is_other_way_round = GENERATE(false, true);
  const auto joined_at = [&](double further_m) {
    core::Joints joints{{other}, {}};
    for (const double x : {-0.03, 0.03}) {
      const double to_x = x < 0.0 ? x : x + further_m;
      joints.springs.push_back({{0, disc(x, 0.0, core::Face::bottom)},
                                {1, disc(to_x, 0.0, core::Face::top)},
                                {1e5, 1e5, 1e5}});
    }
    if (is_other_way_round) {
      std::swap(joints.springs.back().from, joints.springs.back().to);
    }
    spec.joints = std::make_shared<const core::Joints>(joints);
    return core::solve_body(core::body_of(spec)).modes.report.rigid_body_modes;
  };
  CHECK(joined_at(0.0) == 7);  // as one body, and a turn about the line of contacts
  CHECK_THROWS_WITH(joined_at(0.01), Contains("contact spring 2 joins places") &&
                                         Contains("cannot lie on one another"));
}

TEST_CASE("three bodies in a ring are refused unless all of their contacts meet at once",
          "[core][model]") {
  core::PlateSpec spec = stiff_block(60.0);
  const core::JoinedBody other{block({0.1, 0.1, 0.05}, 2e-5), material_of(1e13, 2000.0, 0.01)};
  const auto ring_with = [&](double further_m) {
    core::Joints joints{{other, other}, {}};
    const auto join = [&](std::size_t from, std::size_t to, double to_x) {
      joints.springs.push_back({{from, disc(0.0, 0.0, core::Face::bottom)},
                                {to, disc(to_x, 0.0, core::Face::bottom)},
                                {1e5, 1e5, 1e5}});
    };
    join(0, 1, 0.0);
    join(0, 2, 0.0);
    join(1, 2, further_m);
    spec.joints = std::make_shared<const core::Joints>(joints);
    core::solve_body(core::body_of(spec));
  };
  CHECK_NOTHROW(ring_with(0.0));
  CHECK_THROWS_WITH(ring_with(0.02), Contains("contact spring 3 joins places"));
}
