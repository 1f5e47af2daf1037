#include "core/model/tetgen_mesher.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <new>

#include "core/error.hpp"
#include "core/model/box_outline.hpp"

#define TETLIBRARY
#include <tetgen.h>
namespace tapstudy::core {
namespace {
constexpr double most_tets = 2e5;

// A well-shaped tetrahedron is about as large as its cube's sixth; a thin sheet cannot have larger
// ones than its thickness allows.
void check_count(const Box& box, const MeshSize& size) {
  const double volume = box.size_m.prod();
  const double thinnest = box.size_m.minCoeff();
  const double from_shape = volume / (thinnest * thinnest * thinnest / 6.0);
  const double from_size = size.max_tet_volume_m3 ? volume / *size.max_tet_volume_m3 : 0.0;
  if (std::max(from_shape, from_size) > most_tets) {
    throw ModelError{fmt::format(
        "mesh: a plate of {} × {} × {} m would take about {:.2g} tetrahedra (at most {:.0g}): {}",
        box.size_m.x(), box.size_m.y(), box.size_m.z(), std::max(from_shape, from_size), most_tets,
        from_shape > most_tets ? "the plate is too thin for tetrahedra of good shape"
                               : "choose a larger max_tet_volume_m3")};
  }
}

// TetGen frees what it is handed with delete[]; its structures are filled the way it asks.
// NOLINTBEGIN(cppcoreguidelines-owning-memory)
tetgenio::polygon polygon_of(const std::vector<int>& vertices) {
  tetgenio::polygon polygon{};
  tetgenio::init(&polygon);
  polygon.numberofvertices = static_cast<int>(vertices.size());
  polygon.vertexlist = new int[vertices.size()];
  std::ranges::copy(vertices, polygon.vertexlist);
  return polygon;
}

void fill_facet(tetgenio::facet& facet, const BoxOutline::Side& side) {
  tetgenio::init(&facet);
  facet.numberofpolygons = static_cast<int>(1 + side.inside.size());
  facet.polygonlist = new tetgenio::polygon[1 + side.inside.size()];
  facet.polygonlist[0] = polygon_of(side.loop);
  for (std::size_t i = 0; i < side.inside.size(); ++i) {
    facet.polygonlist[1 + i] = polygon_of({side.inside[i]});
  }
}

// Points go in relative to the box's low corner, and come out the same way.
void fill(tetgenio& in, const BoxOutline& outline, const Vec3& low_m) {
  in.firstnumber = 0;
  in.numberofpoints = static_cast<int>(outline.points_m.size());
  in.pointlist = new REAL[3 * outline.points_m.size()];
  for (std::size_t i = 0; i < outline.points_m.size(); ++i) {
    Eigen::Map<Vec3>{in.pointlist + 3 * i} = outline.points_m[i] - low_m;
  }
  in.numberoffacets = static_cast<int>(outline.sides.size());
  in.facetlist = new tetgenio::facet[outline.sides.size()];
  in.facetmarkerlist = nullptr;
  for (std::size_t i = 0; i < outline.sides.size(); ++i) {
    fill_facet(in.facetlist[i], outline.sides.at(i));
  }
}

// NOLINTEND(cppcoreguidelines-owning-memory)

void make_volumes_positive(TetMesh& mesh) {
  for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
    if (tet_volume_m3(mesh, tet) < 0.0) {
      std::swap(mesh.tets(tet, 2), mesh.tets(tet, 3));
    }
  }
}

// A triangle is on the surface if one tetrahedron has it; inner ones belong to two.
void find_surface(TetMesh& mesh) {
  constexpr std::array<std::array<int, 3>, 4> outward{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  std::map<std::array<int, 3>, std::array<int, 3>> once;
  for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
    for (const auto& local : outward) {
      const std::array<int, 3> triangle{mesh.tets(tet, local[0]), mesh.tets(tet, local[1]),
                                        mesh.tets(tet, local[2])};
      std::array<int, 3> key = triangle;
      std::ranges::sort(key);
      const auto [found, is_new] = once.emplace(key, triangle);
      if (!is_new) {
        once.erase(found);
      }
    }
  }
  mesh.surface.resize(static_cast<Eigen::Index>(once.size()), 3);
  Eigen::Index row = 0;
  for (const auto& [key, triangle] : once) {
    mesh.surface.row(row++) << triangle[0], triangle[1], triangle[2];
  }
}

TetMesh mesh_from(const tetgenio& out, const Vec3& low_m) {
  TetMesh mesh;
  mesh.nodes_m = Eigen::Map<const decltype(mesh.nodes_m)>(out.pointlist, out.numberofpoints, 3);
  mesh.nodes_m.rowwise() += low_m.transpose();
  mesh.tets = Eigen::Map<const decltype(mesh.tets)>(out.tetrahedronlist, out.numberoftetrahedra, 4);
  make_volumes_positive(mesh);
  find_surface(mesh);
  return mesh;
}

std::string tetgen_switches(const MeshSize& size) {
  std::string switches = fmt::format("pq{}Q", size.radius_edge_ratio);
  if (size.max_tet_volume_m3) {
    switches += fmt::format("a{:.24f}", *size.max_tet_volume_m3);
  }
  return switches;
}
}  // namespace

TetMesh mesh_box(const Box& box, const MeshSize& size, const std::vector<Vec3>& points_m) {
  check_count(box, size);
  tetgenio in;
  tetgenio out;
  fill(in, outline(box, points_m), box.low_m());
  std::string switches = tetgen_switches(size);
  try {
    tetrahedralize(switches.data(), &in, &out);
  } catch (int code) {
    throw ModelError{fmt::format("mesh: TetGen gave up on the plate with code {}", code)};
  } catch (const std::bad_alloc&) {
    throw ModelError{"mesh: not enough memory for so many tetrahedra"};
  }
  return mesh_from(out, box.low_m());
}
}  // namespace tapstudy::core
