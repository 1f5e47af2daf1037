// Table 1 and section 5.1: 443 tetrahedra; fixed at its four bottom corners the model has 267
// modes.
#include <fmt/format.h>

#include "core/model/mesh/tetgen_mesher.hpp"
#include "runner/reproduction/claim_table.hpp"
#include "runner/reproduction/routes.hpp"
#include "runner/reproduction/shipped_protocols.hpp"
namespace tapstudy::runner {
namespace {
constexpr double printed_tets = 443.0;
constexpr double printed_modes = 267.0;
constexpr double same_count = 0.01;
constexpr double corner_constraints = 12;  // four nodes, three axes
const char* const model_file = "protocols/paper/plate_model.yaml";
const char* const model_plate = "mdf";

core::ModelReport report_of(Bench& bench, const protocols::Protocol& protocol) {
  return bench.models.body_of(protocol, stimulus_with(protocol, protocol.stimulus(model_plate)))
      ->report;
}

Claim tetrahedra(Bench& bench) {
  const core::ModelReport report = report_of(bench, shipped_protocol(model_file));
  Claim claim{
      .name = "tetrahedra",
      .section = "Table 1",
      .statement = "The plate is meshed with 443 linear tetrahedra.",
      .rule = "The count differs by no more than 1 %: a mesh of another version of TetGen."};
  claim.methods.push_back({std::string{method::printed},
                           modes_command(model_file, model_plate),
                           {shown("tetrahedra", report.tets),
                            at_most(100.0 * same_count, "difference from 443",
                                    difference_percent(report.tets, printed_tets), "%")}});
  return claim;
}

// What TetGen's bound on an element's shape does to the mesh.
std::vector<Measure> meshes_of(const protocols::Plate& body) {
  std::vector<Measure> found;
  for (const double ratio : {1.2, 1.414, 2.0, 4.0}) {
    core::MeshSize size;
    size.radius_edge_ratio = ratio;
    const core::TetMesh mesh =
        core::mesh_shape(body.shape, size, core::points_to_mesh(body.fixations, body.shape));
    const auto named = [&](const char* what) {
      return fmt::format("{} with radius_edge_ratio {}", what, ratio);
    };
    found.push_back(shown(named("tetrahedra"), static_cast<double>(mesh.tets.rows())));
    found.push_back(
        shown(named("modes"), 3.0 * static_cast<double>(mesh.nodes_m.rows()) - corner_constraints));
  }
  return found;
}

Claim all_modes(Bench& bench) {
  const protocols::Protocol protocol = shipped_protocol(model_file);
  const core::ModelReport report = report_of(bench, protocol);
  Claim claim{
      .name = "all_modes",
      .section = "section 5.1",
      .statement = "Fixed at its four bottom corners the model has 267 modes.",
      .rule = "As many modes as free degrees of freedom, with no more than 1 % difference."};
  claim.methods.push_back({std::string{method::printed},
                           modes_command(model_file, model_plate),
                           {shown("free degrees of freedom", report.dofs),
                            at_most(100.0 * same_count, "difference from 267",
                                    difference_percent(report.dofs, printed_modes), "%")}});
  claim.findings = meshes_of(*protocol.stimulus(model_plate).plate);
  const double nodes = (printed_modes + corner_constraints) / 3.0;
  claim.remarks.push_back(
      fmt::format("267 modes and four fixed vertices are {:.0f} vertices, with 443 tetrahedra "
                  "{:.1f} of these a vertex; a flat mesh with hardly a vertex inside has about "
                  "{:.1f}. One of the two numbers is of another mesh.",
                  nodes, printed_tets / nodes, static_cast<double>(report.tets) / report.nodes));
  return claim;
}

Claim modulus_of_aluminium() {
  const protocols::Protocol printed = shipped_protocol("protocols/paper/forces.yaml");
  constexpr double metal_gpa = 70.0;  // of the metal and its alloys, 68 to 73 GPa
  constexpr double tolerance = 0.1;
  const double modulus_gpa = 1e-9 * printed.materials.at("aluminium")->youngs_modulus_pa;
  Claim claim{.name = "physical_properties",
              .section = "section 5.1",
              .statement =
                  "Except for damping, the materials' parameters are physical properties of "
                  "aluminium, acrylic and MDF.",
              .rule = "Aluminium's Young's modulus is that of the metal, 70 GPa, within 10 %."};
  claim.methods.push_back(
      {std::string{method::printed},
       modes_command("protocols/paper/forces.yaml", "aluminium_four"),
       {within((1.0 - tolerance) * metal_gpa, (1.0 + tolerance) * metal_gpa,
               "Young's modulus of aluminium in Table 1", modulus_gpa, "GPa")}});
  return claim;
}
}  // namespace

std::vector<Claim> plate_model(Bench& bench) {
  return {tetrahedra(bench), all_modes(bench), modulus_of_aluminium()};
}
}  // namespace tapstudy::runner
