#include "core/model/mesh/tetgen_mesher.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <new>
#include <utility>

#include "core/bounded_child.hpp"
#include "core/error.hpp"
#include "core/model/mesh/box_outline.hpp"

#define TETLIBRARY
#include <tetgen.h>
namespace tapstudy::core {
namespace {
// Maximum number of Steiner points: bounds refinement that may not terminate on a bad surface.
constexpr int max_added_points = 400000;

// A well-shaped tetrahedron has about a sixth of the volume of its cube; the thickness of a thin
// sheet bounds the element size.
void check_count(const Shape& shape, const MeshSize& size) {
  const double volume = std::abs(volume_m3(shape));
  const Vec3 extent = bounds(shape).size_m();
  const auto count_for = [&](double flattening) {
    const double edge = Vec3{extent.x(), extent.y(), extent.z() * flattening}.minCoeff();
    return 6.0 * volume * flattening / (edge * edge * edge);
  };
  const double from_shape = std::holds_alternative<Box>(shape) ? count_for(size.flattening) : 0.0;
  const double from_size = size.max_tet_volume_m3 ? volume / *size.max_tet_volume_m3 : 0.0;
  if (std::max(from_shape, from_size) <= max_tets) {
    return;
  }
  std::string advice = "choose a larger max_tet_volume_m3";
  if (from_shape > max_tets) {
    const double enough =
        size.flattening * std::cbrt(from_shape / 1e4) * std::cbrt(from_shape / 1e4);
    advice = enough <= max_flattening
                 ? fmt::format(
                       "it is too thin for well-shaped tetrahedra; mesh.flattening: {:.0f} "
                       "flattens them, order: 2 and an accuracy show whether they are fine "
                       "enough",
                       std::ceil(enough))
                 : std::string{"it is too thin for solid elements"};
  }
  throw ModelError{fmt::format(
      "mesh: a body of {:.4g} × {:.4g} × {:.4g} m would take about {:.2g} tetrahedra (at most "
      "{:.0g}): {}",
      extent.x(), extent.y(), extent.z(), std::max(from_shape, from_size), max_tets, advice)};
}

// TetGen frees its input with delete[], so its structures must be allocated with new[].
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

// From body to TetGen's coordinates and back: relative to the low corner, thickened.
struct Thickening {
  Vec3 low_m;
  double flattening;
  Vec3 in(const Vec3& p) const {
    const Vec3 relative = p - low_m;
    return {relative.x(), relative.y(), flattening * relative.z()};
  }
};

template <class PointList>
void fill_points(tetgenio& in, const PointList& points, std::size_t count,
                 const Thickening& thickening) {
  in.firstnumber = 0;
  in.numberofpoints = static_cast<int>(count);
  in.pointlist = new REAL[3 * count];
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Map<Vec3>{in.pointlist + 3 * i} = thickening.in(points(i));
  }
}

void fill(tetgenio& in, const BoxOutline& outline, const Thickening& thickening) {
  fill_points(
      in, [&](std::size_t i) { return outline.points_m[i]; }, outline.points_m.size(), thickening);
  in.numberoffacets = static_cast<int>(outline.sides.size());
  in.facetlist = new tetgenio::facet[outline.sides.size()];
  in.facetmarkerlist = nullptr;
  for (std::size_t i = 0; i < outline.sides.size(); ++i) {
    fill_facet(in.facetlist[i], outline.sides.at(i));
  }
}

void fill(tetgenio& in, const TriangleSurface& surface, const Thickening& thickening) {
  fill_points(
      in, [&](std::size_t i) -> Vec3 { return surface.points_m.row(static_cast<Eigen::Index>(i)); },
      static_cast<std::size_t>(surface.points_m.rows()), thickening);
  const auto count = static_cast<std::size_t>(surface.triangles.rows());
  in.numberoffacets = static_cast<int>(count);
  in.facetlist = new tetgenio::facet[count];
  in.facetmarkerlist = nullptr;
  for (std::size_t i = 0; i < count; ++i) {
    const auto triangle = surface.triangles.row(static_cast<Eigen::Index>(i));
    fill_facet(in.facetlist[i], {{triangle[0], triangle[1], triangle[2]}, {}});
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

// A face belongs to the surface if only one tetrahedron has it; interior faces belong to two.
void find_surface(TetMesh& mesh) {
  constexpr std::array<std::array<int, 3>, 4> outward{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  using Triangle = std::array<int, 3>;
  struct Side {
    Triangle key;  // ascending
    Triangle nodes;
  };
  std::vector<Side> sides;
  sides.reserve(4 * static_cast<std::size_t>(mesh.tets.rows()));
  for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
    for (const auto& local : outward) {
      const Triangle nodes{mesh.tets(tet, local[0]), mesh.tets(tet, local[1]),
                           mesh.tets(tet, local[2])};
      Triangle key = nodes;
      std::ranges::sort(key);
      sides.push_back({key, nodes});
    }
  }
  std::ranges::sort(sides, {}, &Side::key);
  std::vector<Triangle> once;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i + 1 < sides.size() && sides[i].key == sides[i + 1].key) {
      ++i;
    } else {
      once.push_back(sides[i].nodes);
    }
  }
  mesh.surface.resize(static_cast<Eigen::Index>(once.size()), 3);
  for (std::size_t i = 0; i < once.size(); ++i) {
    mesh.surface.row(static_cast<Eigen::Index>(i)) << once[i][0], once[i][1], once[i][2];
  }
}

// What crosses from the child that meshes: points as TetGen has them, and the corners.
struct RawMesh {
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> points;
  TetMesh::Indices tets;
};

std::string packed(const tetgenio& out) {
  const std::array<std::int64_t, 2> counts{out.numberofpoints, out.numberoftetrahedra};
  std::string bytes;
  const auto append = [&](const auto* data, std::size_t count) {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes, for a pipe
    bytes.append(reinterpret_cast<const char*>(data), count * sizeof *data);
  };
  append(counts.data(), counts.size());
  append(out.pointlist, 3 * static_cast<std::size_t>(counts[0]));
  append(out.tetrahedronlist, 4 * static_cast<std::size_t>(counts[1]));
  return bytes;
}

RawMesh unpacked(const std::string& bytes) {
  std::size_t at = 0;
  const auto take = [&](auto* data, std::size_t count) {
    std::memcpy(data, bytes.data() + at, count * sizeof *data);
    at += count * sizeof *data;
  };
  std::array<std::int64_t, 2> counts{};
  take(counts.data(), counts.size());
  RawMesh raw;
  raw.points.resize(counts[0], 3);
  raw.tets.resize(counts[1], 4);
  take(raw.points.data(), static_cast<std::size_t>(raw.points.size()));
  take(raw.tets.data(), static_cast<std::size_t>(raw.tets.size()));
  return raw;
}

TetMesh mesh_from(RawMesh raw, const Thickening& thickening) {
  TetMesh mesh;
  mesh.nodes_m = std::move(raw.points);
  mesh.nodes_m.col(2) /= thickening.flattening;
  mesh.nodes_m.rowwise() += thickening.low_m.transpose();
  mesh.tets = std::move(raw.tets);
  make_volumes_positive(mesh);
  find_surface(mesh);
  return mesh;
}

std::string tetgen_switches(const MeshSize& size) {
  std::string switches = fmt::format("pq{}QS{}", size.radius_edge_ratio, max_added_points);
  if (size.max_tet_volume_m3) {
    switches += fmt::format("a{:.24f}", *size.max_tet_volume_m3 * size.flattening);
  }
  return switches;
}

std::string reason_for(int tetgen_code) {
  switch (tetgen_code) {
    case 1:
      return "not enough memory";
    case 3:
      return "the surface runs through itself";
    case 4:
      return "the surface has features too small for its size";
    case 5:
      return "two faces nearly coincide";
    default:
      return fmt::format("code {}", tetgen_code);
  }
}

// TetGen crashes or hangs on some surfaces, so this runs in a process of its own.
std::string tetrahedralised(const Shape& shape, const MeshSize& size,
                            const std::vector<Vec3>& points_m, const Thickening& thickening) {
  tetgenio in;
  tetgenio out;
  if (const auto* box = std::get_if<Box>(&shape)) {
    fill(in, outline(*box, points_m, bounds(shape).snap_m()), thickening);
  } else {
    fill(in, std::get<Solid>(shape).surface(), thickening);
  }
  std::string switches = tetgen_switches(size);
  try {
    tetrahedralize(switches.data(), &in, &out);
  } catch (int code) {
    throw ModelError{fmt::format("mesh: TetGen failed to mesh the body: {}", reason_for(code))};
  } catch (const std::bad_alloc&) {
    throw ModelError{"mesh: not enough memory for so many tetrahedra"};
  }
  if (out.numberofpoints - in.numberofpoints >= max_added_points ||
      out.numberoftetrahedra > max_tets) {
    throw ModelError{fmt::format(
        "mesh: it needs more than {:.0g} tetrahedra or {} added points (choose a larger "
        "max_tet_volume_m3 or a surface without tiny triangles)",
        max_tets, max_added_points)};
  }
  return packed(out);
}
}  // namespace

TetMesh mesh_shape(const Shape& shape, const MeshSize& size, const std::vector<Vec3>& points_m) {
  check_count(shape, size);
  const Thickening thickening{bounds(shape).low_m, size.flattening};
  return mesh_from(unpacked(in_bounded_child(
                       "mesh: TetGen could not mesh the body",
                       [&] { return tetrahedralised(shape, size, points_m, thickening); })),
                   thickening);
}
}  // namespace tapstudy::core
