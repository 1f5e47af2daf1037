// The same meshes and constraints through CalculiX (Dhondt), which shares no code with us.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/model/plate_model.hpp"
#include "support/plates.hpp"
#include "support/processes.hpp"
#include "support/surfaces.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
constexpr const char* calculix = "/usr/bin/ccx";

// CalculiX numbers a T10's nodes as we do, from 1.
std::string input(const core::PlateSpec& spec, const core::TetMesh& mesh, int modes) {
  std::ostringstream text;
  text.precision(12);  // CalculiX reads twenty characters a number
  text << "*NODE, NSET=ALL\n";
  for (Eigen::Index i = 0; i < mesh.nodes_m.rows(); ++i) {
    text << i + 1 << ',' << mesh.nodes_m(i, 0) << ',' << mesh.nodes_m(i, 1) << ','
         << mesh.nodes_m(i, 2) << '\n';
  }
  text << "*ELEMENT, TYPE=C3D10, ELSET=BODY\n";
  for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
    text << tet + 1;
    for (const int node : mesh.tets.row(tet)) {
      text << ',' << node + 1;
    }
    text << '\n';
  }
  const core::Material& m = spec.material;
  text << "*MATERIAL, NAME=M\n*ELASTIC\n"
       << m.youngs_modulus_pa << ',' << m.poissons_ratio << "\n*DENSITY\n"
       << m.density_kg_per_m3 << "\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n";
  const auto held = core::held_dofs(mesh, spec.shape, spec.fixations);
  text << "*BOUNDARY\n";
  for (std::size_t dof = 0; dof < held.size(); ++dof) {
    if (held[dof]) {
      text << dof / 3 + 1 << ',' << dof % 3 + 1 << '\n';
    }
  }
  text << "*STEP\n*FREQUENCY\n" << modes << "\n*END STEP\n";
  return text.str();
}

// The column "FREQUENCY (CYCLES/TIME)" of the .dat file.
std::vector<double> calculix_hz(const core::PlateSpec& spec, const core::TetMesh& mesh, int modes) {
  const testing::TempDirectory directory;
  testing::write(directory / "body.inp", input(spec, mesh, modes));
  const std::string command = fmt::format("cd {} && {} body", directory / ".", calculix);
  const auto run = testing::run_program({"/bin/sh", "-c", command});
  INFO(run.standard_output);
  REQUIRE(run.exit_code == 0);
  std::ifstream results{directory / "body.dat"};
  std::vector<double> hz;
  for (std::string line; std::getline(results, line) && static_cast<int>(hz.size()) < modes;) {
    std::istringstream row{line};
    int number{};
    double eigenvalue{};
    double rad_s{};
    double cycles{};
    if (row >> number >> eigenvalue >> rad_s >> cycles) {
      hz.push_back(cycles);
    }
  }
  return hz;
}

core::PlateSpec with_shape(core::Shape shape, double tet_volume_m3, double band_hz) {
  core::PlateSpec spec{std::move(shape), {}, {}, testing::acrylic(), band_hz};
  spec.mesh.order = 2;
  spec.mesh.size.max_tet_volume_m3 = tet_volume_m3;
  return spec;
}
core::Fixation side(core::Side which, std::array<bool, 3> axes) {
  core::Fixation fixation;
  fixation.shape = core::RegionShape::side;
  fixation.side = which;
  fixation.holds = axes;
  return fixation;
}
core::Fixation ball(const core::Vec3& at_m, double radius_m) {
  core::Fixation fixation;
  fixation.shape = core::RegionShape::ball;
  fixation.at_m = at_m;
  fixation.radius_m = radius_m;
  return fixation;
}
}  // namespace

TEST_CASE("CalculiX finds the same frequencies on the same mesh", "[core][model][calculix][slow]") {
  if (!std::filesystem::exists(calculix)) {
    WARN("CalculiX (package calculix-ccx) is not installed");
    return;
  }
  core::PlateSpec plate = testing::paper_plate(4, testing::mdf());
  plate.mesh.order = 2;
  core::PlateSpec block = with_shape(testing::notched_block(), 4e-6, 4000.0);
  block.fixations = {side(core::Side::bottom, {true, true, true})};
  core::PlateSpec sphere = with_shape(testing::sphere_surface(0.1, 8), 2e-6, 4300.0);
  sphere.fixations = {ball({0.0, 0.0, -0.1}, 0.03)};
  core::PlateSpec sliding = with_shape(core::Box{{0.3, 0.2, 0.02}}, 1e-6, 1800.0);
  sliding.fixations = {side(core::Side::left, {false, false, true}), ball({0.15, 0.1, 0.0}, 0.01)};
  for (const core::PlateSpec& spec : {plate, block, sphere, sliding}) {
    const core::PlateModel ours = core::build_plate_model(spec);
    const auto count = static_cast<int>(ours.modal.frequency_hz.size());
    REQUIRE(count >= 3);
    const std::vector<double> theirs = calculix_hz(spec, ours.body.mesh, count);
    REQUIRE(static_cast<int>(theirs.size()) == count);
    for (int i = 0; i < count; ++i) {
      CAPTURE(i, ours.modal.frequency_hz[i], theirs[static_cast<std::size_t>(i)]);
      CHECK(std::abs(ours.modal.frequency_hz[i] / theirs[static_cast<std::size_t>(i)] - 1.0) <
            1e-4);
    }
  }
}
