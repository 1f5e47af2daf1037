#include "core/model/plate_model.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/model/elements/assembly.hpp"
#include "core/model/model_cache.hpp"
#include "core/model/vtu_file.hpp"
#include "core/techniques/technique.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using core::build_plate_model;

namespace {
// Natural frequencies below 300 Hz of the paper's plate on the same TetGen switches, computed with
// SciPy (eigsh on independently assembled T4 matrices), to the nearest hertz.
struct Reference {
  const char* name;
  int corners;
  core::Material material;
  std::vector<int> hz;
};
}  // namespace

TEST_CASE("the paper's coarse plates have the natural frequencies that SciPy finds",
          "[core][model]") {
  const std::vector<Reference> references{
      {"MDF, two adjacent", 2, testing::mdf(), {58, 248}},
      {"MDF, three", 3, testing::mdf(), {159}},
      {"MDF, four", 4, testing::mdf(), {274}},
      {"acrylic, two adjacent", 2, testing::acrylic(), {48, 203, 256}},
      {"acrylic, three", 3, testing::acrylic(), {131, 295}},
      {"acrylic, four", 4, testing::acrylic(), {228}}};
  for (const Reference& reference : references) {
    INFO(reference.name);
    const auto plate =
        build_plate_model(testing::paper_plate(reference.corners, reference.material));
    CHECK(plate.body.modes.report.nodes == 172);
    std::vector<int> rounded;
    for (const double hz : plate.modal.frequency_hz) {
      rounded.push_back(static_cast<int>(std::lround(hz)));
    }
    CHECK(rounded == reference.hz);
    CHECK(plate.body.modes.report.worst_residual < 1e-8);
  }
}

TEST_CASE("a body that was solved up to a lower band is refused, not used with modes missing",
          "[core][model]") {
  core::PlateSpec plate = testing::paper_plate(2, testing::mdf());
  plate.band_limit_hz = 100.0;
  const core::BodyModes body = core::solve_body(core::body_of(plate)).modes;
  CHECK_NOTHROW(core::model_of(body, plate.material, 100.0));
  CHECK_THROWS_AS(core::model_of(body, plate.material, 300.0), core::ModelError);
  core::Material softer = plate.material;
  softer.youngs_modulus_pa *= 0.25;  // every frequency at half
  CHECK_THROWS_AS(core::model_of(body, softer, 100.0), core::ModelError);
  CHECK_NOTHROW(core::model_of(body, softer, 50.0));
}

using core::ModelCache;

namespace {
core::BodyModes some_modes() {
  return core::solve_body(core::body_of(testing::paper_plate(2, testing::mdf()))).modes;
}
std::string only_file_in(const std::string& directory) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator{directory}) {
    files.push_back(entry.path().string());
  }
  REQUIRE(files.size() == 1);
  return files.front();
}
}  // namespace

TEST_CASE("what was kept is found to the last bit, under its own key only", "[core][cache]") {
  const testing::TempDirectory directory;
  const ModelCache cache{directory / "models", "1"};
  const core::BodyModes modes = some_modes();
  CHECK_FALSE(cache.find("a plate"));
  CHECK(cache.store("a plate", modes));
  const auto found = cache.find("a plate");
  REQUIRE(found);
  CHECK((found->kappa_rad_per_m == modes.kappa_rad_per_m).all());
  CHECK(found->band_limit_rad_per_m == modes.band_limit_rad_per_m);
  CHECK(found->shape == modes.shape);
  CHECK(found->touch_surface == modes.touch_surface);
  CHECK(found->touch_nodes_m == modes.touch_nodes_m);
  CHECK(found->report.dofs == modes.report.dofs);
  REQUIRE(found->report.bodies.size() == 1);
  CHECK(found->report.order() == modes.report.order());
  CHECK(found->report.bodies[0].radius_edge_ratio.asked == core::MeshSize{}.radius_edge_ratio);
  CHECK_FALSE(cache.find("another plate"));
  CHECK_FALSE(ModelCache{directory / "models", "2"}.find("a plate"));  // of another program
}

TEST_CASE("a torn or altered file counts as absent and is replaced", "[core][cache]") {
  const testing::TempDirectory directory;
  const ModelCache cache{directory / "models", "1"};
  CHECK(cache.store("a plate", some_modes()));
  const std::string file = only_file_in(directory / "models");
  const std::string whole = testing::contents(file);
  for (const std::size_t length : {std::size_t{0}, whole.size() / 2, whole.size() - 1}) {
    std::ofstream{file, std::ios::binary} << whole.substr(0, length);
    CHECK_FALSE(cache.find("a plate"));
  }
  std::string altered = whole;
  altered[whole.size() / 2] ^= 1;
  std::ofstream{file, std::ios::binary} << altered;
  CHECK_FALSE(cache.find("a plate"));
  CHECK(cache.store("a plate", some_modes()));
  CHECK(cache.find("a plate"));
  only_file_in(directory / "models");
}

TEST_CASE("processes that keep and find at once find all or nothing", "[core][cache]") {
  const testing::TempDirectory directory;
  const ModelCache cache{directory / "models", "1"};
  const core::BodyModes modes = some_modes();
  const std::string kept = core::encoded(modes);
  std::vector<pid_t> children;
  for (int child = 0; child < 3; ++child) {
    children.push_back(fork());
    if (children.back() == 0) {
      bool is_whole = true;
      for (int turn = 0; turn < 200; ++turn) {
        const bool is_kept = cache.store("a plate", modes);
        const auto found = cache.find("a plate");
        is_whole = is_whole && is_kept && found && core::encoded(*found) == kept;
      }
      _exit(is_whole ? 0 : 1);
    }
  }
  for (const pid_t child : children) {
    int status = -1;
    REQUIRE(waitpid(child, &status, 0) == child);
    CHECK(status == 0);
  }
  only_file_in(directory / "models");
}

TEST_CASE("a cache without a place keeps nothing, and says so", "[core][cache]") {
  const ModelCache nowhere{"/proc/no/such/place", "1"};
  CHECK_FALSE(nowhere.store("a plate", some_modes()));
  CHECK_FALSE(nowhere.find("a plate"));
}

namespace {
// What meshio, which shares no code with us, reads.
constexpr const char* reader = R"(
import json, sys, meshio
mesh = meshio.read(sys.argv[1])
cells = mesh.cells[0]
print(json.dumps({"type": cells.type, "points": mesh.points.tolist(), "cells": cells.data.tolist(),
                  "modes": {name: data.tolist() for name, data in mesh.point_data.items()}}))
)";
}  // namespace

TEST_CASE("a .vtu holds the mesh and its modes as another program reads them", "[core][vtu]") {
  const int order = GENERATE(1, 2);
  core::PlateSpec plate = testing::paper_plate(2, testing::mdf());
  plate.mesh.order = order;
  const core::PlateModel built = core::build_plate_model(plate);
  const double density = plate.material.density_kg_per_m3;
  const testing::TempDirectory directory;
  core::write_vtu(built.body, built.modal, density, directory / "body.vtu");
  const auto run = testing::run_program({"/usr/bin/python3", "-c", reader, directory / "body.vtu"});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  const auto read = nlohmann::json::parse(run.standard_output);
  CHECK(read["type"] == (order == 2 ? "tetra10" : "tetra"));
  const core::TetMesh& mesh = built.body.mesh;
  REQUIRE(static_cast<Eigen::Index>(read["points"].size()) == mesh.nodes_m.rows());
  REQUIRE(static_cast<Eigen::Index>(read["cells"].size()) == mesh.tets.rows());
  REQUIRE(static_cast<Eigen::Index>(read["modes"].size()) == built.modal.frequency_hz.size());
  CHECK(read["points"][7][1] == mesh.nodes_m(7, 1));
  CHECK(read["cells"][3][2] == mesh.tets(3, 2));
  // mass-normalised: phi' M phi = 1 with the consistent mass matrix of the mesh
  const core::StiffnessAndMass matrices = core::assemble(
      mesh, plate.material,
      core::free_dofs(std::vector<bool>(static_cast<std::size_t>(mesh.nodes_m.size()), false)));
  Eigen::VectorXd shape{mesh.nodes_m.size()};
  for (Eigen::Index node = 0; node < mesh.nodes_m.rows(); ++node) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      shape[3 * node + axis] =
          read["modes"]["mode_1"][static_cast<std::size_t>(node)][static_cast<std::size_t>(axis)];
    }
  }
  CHECK(shape.dot(matrices.mass() * shape) == Approx(1.0));
  CHECK_THROWS_AS(core::write_vtu(built.body, built.modal, density, directory / "body.vtu"),
                  core::InvalidInput);
}

TEST_CASE("a plate on soft feet sags under the finger as its springs say",
          "[core][model][coupled]") {
  for (const double k : {1e3, 1e4, 1e5}) {
    core::PlateSpec spec{{core::Box{{0.3, 0.2, 0.01}}, {}, {}},
                         {2e11, 7800.0, 0.3, core::ConstantDamping{0.5}},
                         300.0};
    spec.mesh.size.max_tet_volume_m3 = 2e-6;
    for (const auto& [x, y] : {std::pair{-0.1, -0.07}, {0.1, -0.07}, {-0.1, 0.07}, {0.1, 0.07}}) {
      core::Fixation foot;
      foot.shape = core::RegionShape::disc;
      foot.at_m = {x, y, 0.0};
      foot.radius_m = 0.01;
      foot.face = core::Face::bottom;
      foot.springs_n_per_m = core::Vec3{k, k, k};
      spec.fixations.push_back(foot);
    }
    const core::PlateModel built = core::build_plate_model(spec);
    CHECK(built.body.modes.report.rigid_body_modes == 0);
    REQUIRE(built.modal.frequency_hz.size() >= 6);  // those of the plate as a rigid body
    const core::VibratingPlate plate{built.modal};
    core::RenderSettings settings;
    settings.finger.mass_kg = 0.0058;
    core::TapRenderer renderer = core::make_renderer(*core::find_technique("fem-coupled"), settings,
                                                     core::PlateFace{0.15, 0.1}, &plate);
    renderer.tick({{0.0, 0.0, 1e-4}, {0.0, 0.0, -0.1}});
    double force_n = 0.0;
    for (int tick = 0; tick < 4000; ++tick) {
      force_n = renderer.tick({{0.0, 0.0, -0.002}, core::Vec3::Zero()}).force_n.z();
    }
    // the contact's stiffness in series with four springs
    const double contact = settings.penalty_stiffness_n_per_m;
    INFO(k);
    CHECK(force_n == Approx(0.002 * contact / (1.0 + contact / (4.0 * k))).epsilon(2e-3));
  }
}
