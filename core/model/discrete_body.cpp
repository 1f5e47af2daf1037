#include "core/model/discrete_body.hpp"

#include <fmt/format.h>

#include <utility>

#include "core/error.hpp"
#include "core/model/element_order.hpp"
#include "core/model/mesh/wanted_order.hpp"
#include "core/model/progress.hpp"
#include "core/model/shells/shell_body.hpp"
#include "core/model/shells/shell_elements.hpp"
namespace tapstudy::core {
namespace {
Eigen::SparseMatrix<double, Eigen::RowMajor> displacement_of(const FreeDofs& dofs) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < dofs.position.size(); ++i) {
    if (dofs.position[i] >= 0) {
      entries.emplace_back(static_cast<int>(i), dofs.position[i], 1.0);
    }
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(
      static_cast<Eigen::Index>(dofs.position.size()), dofs.count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}
}  // namespace

DiscreteBody discretised(const Plate& plate, const Material& material, const MeshSize& size,
                         const std::vector<Fixation>& regions, const ProgressHook& progress) {
  std::vector<Fixation> all_regions = plate.fixations;
  all_regions.insert(all_regions.end(), regions.begin(), regions.end());
  if (!plate.mesh.shell_width_m && std::holds_alternative<Solid>(plate.shape) &&
      is_sheet(plate.shape)) {
    throw ModelError{"mesh: a surface with a thickness_m has shell elements, no tetrahedra"};
  }
  if (plate.mesh.shell_width_m) {
    return shell_body(plate, material, shell_order, all_regions, progress);
  }
  DiscreteBody body;
  Stopwatch watch;
  tell(progress, "meshing");
  body.mesh = mesh_shape(
      plate.shape, size, points_to_mesh(all_regions, plate.shape),
      plate.mesh.order == chosen_order ? WantedOrder::quadratic_if_small : WantedOrder::linear);
  if (plate.mesh.order != 1) {
    TetMesh quadratic = to_quadratic(body.mesh);
    if (plate.mesh.order >= 2 || 3 * quadratic.nodes_m.rows() <= max_chosen_dofs) {
      body.mesh = std::move(quadratic);
    }
  }
  body.cost.mesh_s = watch.lap_s();
  tell(progress, fmt::format("assembling {} tetrahedra", body.mesh.tets.rows()));
  body.dofs = free_dofs(constrained_dofs(body.mesh, plate.shape, plate.fixations));
  body.matrices = assemble(body.mesh, material, body.dofs,
                           spring_supports(body.mesh, plate.shape, plate.fixations));
  body.displacement = displacement_of(body.dofs);
  body.order = body.mesh.order();
  body.elements = static_cast<int>(body.mesh.tets.rows());
  body.cost.assemble_s = watch.lap_s();
  return body;
}

ModelReport report_on(const std::vector<DiscreteBody>& bodies, const Modes& modes) {
  ModelReport report;
  for (const DiscreteBody& body : bodies) {
    report.cost.mesh_s += body.cost.mesh_s;
    report.cost.assemble_s += body.cost.assemble_s;
    report.nodes += static_cast<int>(body.mesh.nodes_m.rows());
    report.tets += body.elements;
    report.dofs += static_cast<int>(body.matrices.K.rows());
    report.bodies.push_back({body.order, body.mesh.radius_edge_ratio});
  }
  report.cost.factor_s = modes.factor_s;
  report.cost.iterate_s = modes.iterate_s;
  report.rigid_body_modes = modes.rigid_body_modes;
  report.counted_in_band = modes.counted_in_band;
  report.worst_residual = modes.worst_residual;
  return report;
}
}  // namespace tapstudy::core
