#include "core/model/vtu_file.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/model/elements/assembly.hpp"
#include "core/model/plate_model.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

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
