#include "core/model/elements/enrichment.hpp"

#include <algorithm>
#include <utility>
#include <vector>
namespace tapstudy::core {
namespace {
// An unknown of the enlarged space, with the nodes between which it lies: where all of them are
// held, so is the edge or face.
struct AddedUnknown {
  int number{};
  std::vector<int> between;
};

std::vector<AddedUnknown> added_unknowns(const TetMesh& larger, Eigen::Index tet) {
  const auto node = [&](Eigen::Index column) { return larger.tets(tet, column); };
  std::vector<AddedUnknown> added;
  const bool is_cubic = larger.order() == 3;
  for (std::size_t edge = 0; edge < tet_edges.size(); ++edge) {
    const auto place = static_cast<Eigen::Index>(edge);
    const auto& [from, to] = tet_edges.at(edge);
    added.push_back({node((is_cubic ? 10 : 4) + place), {node(from), node(to)}});
    if (is_cubic) {
      added.back().between.push_back(node(4 + place));
    }
  }
  for (std::size_t face = 0; is_cubic && face < tet_faces.size(); ++face) {
    added.push_back({node(16 + static_cast<Eigen::Index>(face)), {}});
    const auto& corners = tet_faces.at(face);
    for (const int corner : corners) {
      added.back().between.push_back(node(corner));
    }
    for (std::size_t edge = 0; edge < tet_edges.size(); ++edge) {
      if (std::ranges::all_of(tet_edges.at(edge), [&](int end) {
            return std::ranges::find(corners, end) != corners.end();
          })) {
        added.back().between.push_back(node(4 + static_cast<Eigen::Index>(edge)));
      }
    }
  }
  return added;
}

// Each once, though its edge or face belongs to several tetrahedra.
std::vector<AddedUnknown> all_added(const TetMesh& larger) {
  std::vector<bool> is_known(static_cast<std::size_t>(larger.nodes_m.rows()), false);
  std::vector<AddedUnknown> all;
  for (Eigen::Index tet = 0; tet < larger.tets.rows(); ++tet) {
    for (AddedUnknown& one : added_unknowns(larger, tet)) {
      const auto number = static_cast<std::size_t>(one.number);
      if (!is_known[number]) {
        is_known[number] = true;
        all.push_back(std::move(one));
      }
    }
  }
  return all;
}

// Of a node along an axis; -1: held.
int position_of(const FreeDofs& dofs, int node, std::size_t axis) {
  return dofs.position[3 * static_cast<std::size_t>(node) + axis];
}

FreeDofs dofs_of(const TetMesh& larger, const FreeDofs& given) {
  std::vector<bool> held(3 * static_cast<std::size_t>(larger.nodes_m.rows()), false);
  std::transform(given.position.begin(), given.position.end(), held.begin(),
                 [](int position) { return position < 0; });
  for (const AddedUnknown& one : all_added(larger)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      held[3 * static_cast<std::size_t>(one.number) + axis] = std::ranges::all_of(
          one.between, [&](int node) { return position_of(given, node, axis) < 0; });
    }
  }
  return free_dofs(held);
}

TetMesh enlarged(const TetMesh& mesh) {
  return mesh.order() == 1 ? to_quadratic(mesh) : to_hierarchic_cubic(mesh);
}

// Quadratic elements are nodal: a linear displacement moves each mid-side node by the mean of its
// edge's ends. Where one of them is free, so is the mid-side node.
void add_mid_sides(const TetMesh& larger, const FreeDofs& from, const FreeDofs& to,
                   std::vector<Eigen::Triplet<double>>& entries) {
  for (const AddedUnknown& one : all_added(larger)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int end : one.between) {
        if (position_of(from, end, axis) >= 0) {
          entries.emplace_back(position_of(to, one.number, axis), position_of(from, end, axis),
                               0.5);
        }
      }
    }
  }
}
}  // namespace

int enriched_dofs(const TetMesh& mesh, const FreeDofs& dofs) {
  return dofs_of(enlarged(mesh), dofs).count;
}

EnrichedBody enriched(const TetMesh& mesh, const Material& material, const FreeDofs& dofs,
                      const std::vector<SpringSupport>& springs) {
  const TetMesh larger = enlarged(mesh);
  const FreeDofs all = dofs_of(larger, dofs);
  EnrichedBody body;
  body.matrices = assemble(larger, material, all, springs);
  body.place.resize(static_cast<std::size_t>(dofs.count));
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < dofs.position.size(); ++i) {
    if (dofs.position[i] >= 0) {
      body.place[static_cast<std::size_t>(dofs.position[i])] = all.position[i];
      entries.emplace_back(all.position[i], dofs.position[i], 1.0);
    }
  }
  if (mesh.order() == 1) {
    add_mid_sides(larger, dofs, all, entries);
  }
  body.prolongation.resize(all.count, dofs.count);
  body.prolongation.setFromTriplets(entries.begin(), entries.end());
  return body;
}
}  // namespace tapstudy::core
