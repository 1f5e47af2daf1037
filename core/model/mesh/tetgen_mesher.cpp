#include "core/model/mesh/tetgen_mesher.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/model/cubic_elements.hpp"
#include "core/model/element_order.hpp"
#include "core/model/mesh/tetgen_job.hpp"
#include "core/model/mesh/wanted_order.hpp"
#include "core/model/shape/shape.hpp"
namespace tapstudy::core {
// The six faces of a box as polygons over a list of points: the mesher's input, such that given
// points on faces and edges become nodes.
struct BoxOutline {
  struct Side {
    std::vector<int> loop;    // the border: corners and the points on the edges, in order
    std::vector<int> inside;  // points strictly inside the face
  };
  std::vector<Vec3> points_m;  // the eight corners first, no duplicates
  std::array<Side, 6> sides;
};

// Points closer than snap_m are merged.
BoxOutline outline(const Box& box, const std::vector<Vec3>& points_m, double snap_m);

namespace {
using Corners = std::array<int, 4>;

// Corners 0 to 3 once around the bottom, 4 to 7 above them. TetGen's mesh depends on the order of
// points and faces, so the order is part of what makes a study repeatable.
constexpr std::array<Corners, 6> corner_loops{Corners{0, 1, 2, 3}, Corners{4, 5, 6, 7},
                                              Corners{0, 1, 5, 4}, Corners{1, 2, 6, 5},
                                              Corners{2, 3, 7, 6}, Corners{3, 0, 4, 7}};

Vec3 corner(const Box& box, int k) {
  const int around = k % 4;
  return {around == 1 || around == 2 ? box.high_m().x() : box.low_m().x(),
          around >= 2 ? box.high_m().y() : box.low_m().y(),
          k >= 4 ? box.high_m().z() : box.low_m().z()};
}

// Parameter of p along the edge: 0 at its start, 1 at its end, -1 off the edge.
double along_edge(const Vec3& p, const Vec3& from, const Vec3& to, double tolerance_m) {
  const Vec3 edge = to - from;
  const double t = (p - from).dot(edge) / edge.squaredNorm();
  const bool is_on_edge = (from + t * edge - p).norm() <= tolerance_m;
  return is_on_edge ? t : -1.0;
}

std::vector<int> points_on_edge(const std::vector<Vec3>& points, int from, int to,
                                double tolerance_m) {
  const auto place = [&](int i) {
    return along_edge(points.at(static_cast<std::size_t>(i)),
                      points.at(static_cast<std::size_t>(from)),
                      points.at(static_cast<std::size_t>(to)), tolerance_m);
  };
  std::vector<int> found;
  for (int i = 8; i < static_cast<int>(points.size()); ++i) {
    if (place(i) > 0.0 && place(i) < 1.0) {
      found.push_back(i);
    }
  }
  std::ranges::sort(found, {}, place);
  return found;
}

BoxOutline::Side side_of(const std::vector<Vec3>& points, const Corners& corners,
                         double tolerance_m) {
  const auto point = [&](int i) { return points.at(static_cast<std::size_t>(i)); };
  BoxOutline::Side side;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const int from = corners.at(k);
    const int to = corners.at((k + 1) % corners.size());
    side.loop.push_back(from);
    const std::vector<int> between = points_on_edge(points, from, to, tolerance_m);
    side.loop.insert(side.loop.end(), between.begin(), between.end());
  }
  const Vec3 u = point(corners[1]) - point(corners[0]);
  const Vec3 v = point(corners[3]) - point(corners[0]);
  const Vec3 normal = u.cross(v).normalized();
  for (int i = 8; i < static_cast<int>(points.size()); ++i) {
    const bool is_in_plane = std::abs(normal.dot(point(i) - point(corners[0]))) <= tolerance_m;
    if (is_in_plane && std::ranges::find(side.loop, i) == side.loop.end()) {
      side.inside.push_back(i);
    }
  }
  return side;
}
}  // namespace

BoxOutline outline(const Box& box, const std::vector<Vec3>& points_m, double snap_m) {
  const double tolerance_m = snap_m;
  BoxOutline result;
  for (int k = 0; k < 8; ++k) {
    result.points_m.push_back(corner(box, k));
  }
  for (const Vec3& point : points_m) {
    const bool is_new = std::ranges::none_of(
        result.points_m, [&](const Vec3& other) { return (other - point).norm() <= tolerance_m; });
    if (is_new) {
      result.points_m.push_back(point);
    }
  }
  for (std::size_t i = 0; i < result.sides.size(); ++i) {
    result.sides.at(i) = side_of(result.points_m, corner_loops.at(i), tolerance_m);
  }
  return result;
}

namespace {
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
    advice = fmt::format(
        "it is too thin for well-shaped tetrahedra; mesh: auto takes shell elements, as does "
        "shell_width_m; order: 3 and flattening: {:.0f} takes flat tetrahedra",
        std::min(std::ceil(enough), max_cubic_flattening));
  }
  throw ModelError{fmt::format(
      "mesh: a body of {:.4g} × {:.4g} × {:.4g} m would take about {:.2g} tetrahedra (at most "
      "{:.0g}): {}",
      extent.x(), extent.y(), extent.z(), std::max(from_shape, from_size), max_tets, advice)};
}

// Maps the body to TetGen's coordinates and back: relative to the low corner, thickened.
struct Thickening {
  Vec3 low_m;
  double flattening;
  Vec3 in(const Vec3& p) const {
    const Vec3 relative = p - low_m;
    return {relative.x(), relative.y(), flattening * relative.z()};
  }
};

void append(std::vector<double>& coordinates, const Vec3& point) {
  coordinates.insert(coordinates.end(), {point.x(), point.y(), point.z()});
}

TetgenInput input_for(const BoxOutline& outline, const Thickening& thickening) {
  TetgenInput input;
  for (const Vec3& point : outline.points_m) {
    append(input.coordinates, thickening.in(point));
  }
  for (const BoxOutline::Side& side : outline.sides) {
    auto& polygons = input.facets.emplace_back();
    polygons.push_back(side.loop);
    for (const int point : side.inside) {
      polygons.push_back({point});
    }
  }
  return input;
}

TetgenInput input_for(const TriangleSurface& surface, const Thickening& thickening) {
  TetgenInput input;
  for (const auto& point : surface.points_m.rowwise()) {
    append(input.coordinates, thickening.in(point));
  }
  for (const auto& triangle : surface.triangles.rowwise()) {
    input.facets.push_back({{triangle[0], triangle[1], triangle[2]}});
  }
  return input;
}

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

TetMesh mesh_from(const TetgenOutput& output, const Thickening& thickening,
                  const RadiusEdgeRatio& ratio) {
  using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  TetMesh mesh;
  mesh.radius_edge_ratio = ratio;
  mesh.nodes_m = Eigen::Map<const Points>{
      output.coordinates.data(), static_cast<Eigen::Index>(output.coordinates.size() / 3), 3};
  mesh.nodes_m.col(2) /= thickening.flattening;
  mesh.nodes_m.rowwise() += thickening.low_m.transpose();
  mesh.tets = Eigen::Map<const TetMesh::Indices>{
      output.corners.data(), static_cast<Eigen::Index>(output.corners.size() / 4), 4};
  make_volumes_positive(mesh);
  find_surface(mesh);
  return mesh;
}

// One run of TetGen: what it is asked for, and what its mesh may have at most.
struct Run {
  double ratio{};
  int most_added{max_added_points};
  bool is_for_quadratic{false};  // of max_chosen_dofs unknowns
};

std::string tetgen_switches(const MeshSize& size, const Run& run) {
  std::string switches = fmt::format("pq{}QS{}", run.ratio, run.most_added);
  if (size.max_tet_volume_m3) {
    switches += fmt::format("a{:.24f}", *size.max_tet_volume_m3 * size.flattening);
  }
  return switches;
}

bool has_too_many(const TetgenInput& input, const TetgenOutput& output, const Run& run) {
  const std::size_t added = (output.coordinates.size() - input.coordinates.size()) / 3;
  return added >= static_cast<std::size_t>(run.most_added) ||
         static_cast<double>(output.corners.size()) > 4.0 * max_tets;
}

bool is_small_enough(const TetMesh& mesh, const Run& run) {
  return !run.is_for_quadratic || 3 * to_quadratic(mesh).nodes_m.rows() <= max_chosen_dofs;
}

// Whether the triangles alone do not ask for more; of surfaces whose nodes all lie on them there
// are as many tetrahedra to a triangle, and more.
bool may_have_at_most(double tets, const Solid& solid) {
  constexpr double tets_per_triangle = 4.0;
  return tets_per_triangle * static_cast<double>(solid.surface().triangles.rows()) < tets;
}

constexpr std::array relaxed_ratios{2.0, 8.0, 40.0};
// In place of max_added_points, where quadratic elements are wanted: two tetrahedra to a node.
constexpr int few_added_points = 20'000;

// The bounds of the radius-edge ratio to try in turn: those beyond the first ask for fewer elements
// round small triangles, the last ones round long and narrow ones. A box has none, nor do they help
// where the triangles alone are too many.
std::vector<double> ratios_to_try(const Shape& shape, const MeshSize& size) {
  std::vector<double> ratios{size.radius_edge_ratio};
  const auto* const solid = std::get_if<Solid>(&shape);
  if (solid != nullptr && may_have_at_most(max_tets, *solid)) {
    std::ranges::copy_if(relaxed_ratios, std::back_inserter(ratios),
                         [&](double ratio) { return ratio > size.radius_edge_ratio; });
  }
  return ratios;
}

// Quadratic elements of a larger ratio err less than linear ones, and take less time. Where no
// ratio has few enough, linear ones of the last do: the others take as many as stop a run.
std::vector<Run> runs_for(const Shape& shape, const MeshSize& size, WantedOrder wanted) {
  constexpr double most_quadratic_tets = max_chosen_dofs / 4.0;
  const auto* const solid = std::get_if<Solid>(&shape);
  const std::vector<double> ratios = ratios_to_try(shape, size);
  std::vector<Run> runs;
  if (wanted == WantedOrder::quadratic_if_small && solid != nullptr && !size.max_tet_volume_m3 &&
      may_have_at_most(most_quadratic_tets, *solid)) {
    std::ranges::transform(ratios, std::back_inserter(runs), [](double ratio) {
      return Run{ratio, few_added_points, true};
    });
    runs.push_back({ratios.back()});
  } else {
    std::ranges::transform(ratios, std::back_inserter(runs),
                           [](double ratio) { return Run{ratio}; });
  }
  return runs;
}

std::string command_for(const Shape& shape) {
  const auto* const solid = std::get_if<Solid>(&shape);
  return solid == nullptr || solid->simplified_by().empty() ? std::string{}
                                                            : "; try: " + solid->simplified_by();
}

std::string advice_for(const Shape& shape, const MeshSize& size) {
  constexpr Eigen::Index many = 2000;  // fewer are not what takes the elements
  const auto* const solid = std::get_if<Solid>(&shape);
  if (solid != nullptr && solid->surface().triangles.rows() >= many) {
    return command_for(shape);
  }
  if (size.max_tet_volume_m3) {
    return fmt::format("; try tetrahedra larger than {:.3g} m³", *size.max_tet_volume_m3);
  }
  return size.flattening < max_flattening
             ? fmt::format(
                   "; if it is thin along z, try mesh.flattening: {:.0f}, which flattens "
                   "its elements",
                   std::min(max_flattening, 4.0 * size.flattening))
             : std::string{};
}

[[noreturn]] void refuse_count(const Shape& shape, const MeshSize& size, double last_ratio) {
  throw ModelError{
      fmt::format("mesh: it needs more than {:.0g} tetrahedra or {} added points{}{}", max_tets,
                  max_added_points,
                  last_ratio > size.radius_edge_ratio
                      ? fmt::format(", also with mesh.radius_edge_ratio: {} in place of {}",
                                    last_ratio, size.radius_edge_ratio)
                      : std::string{},
                  advice_for(shape, size))};
}

// Unset: it has too many elements.
std::optional<TetMesh> mesh_by(const Run& run, TetgenInput& input, const MeshSize& size,
                               const Thickening& thickening) {
  input.switches = tetgen_switches(size, run);
  const TetgenOutput output = run_tetgen(input);
  if (has_too_many(input, output, run)) {
    return std::nullopt;
  }
  TetMesh mesh = mesh_from(output, thickening, {size.radius_edge_ratio, run.ratio});
  return is_small_enough(mesh, run) ? std::optional{std::move(mesh)} : std::nullopt;
}
}  // namespace

TetMesh mesh_shape(const Shape& shape, const MeshSize& size, const std::vector<Vec3>& points_m,
                   WantedOrder wanted) {
  check_count(shape, size);
  const Thickening thickening{bounds(shape).low_m, size.flattening};
  const auto* const box = std::get_if<Box>(&shape);
  TetgenInput input = box != nullptr
                          ? input_for(outline(*box, points_m, bounds(shape).snap_m()), thickening)
                          : input_for(std::get<Solid>(shape).surface(), thickening);
  const std::vector<Run> runs = runs_for(shape, size, wanted);
  std::string failure;
  // What makes TetGen fail does so with the next ratio, too, as a rule, but not with all.
  const auto next = [&](std::size_t i) {
    return failure.empty() ? i + 1 : std::max(i + 1, runs.size() - 1);
  };
  for (std::size_t i = 0; i < runs.size(); i = next(i)) {
    try {
      if (auto mesh = mesh_by(runs[i], input, size, thickening)) {
        return *std::move(mesh);
      }
    } catch (const ModelError& error) {
      failure = error.what();
    }
  }
  if (!failure.empty()) {
    throw ModelError{failure + command_for(shape)};
  }
  refuse_count(shape, size, runs.back().ratio);
}

bool can_be_meshed(const Solid& body) {
  const Thickening thickening{bounds(body).low_m, 1.0};
  TetgenInput input = input_for(body.surface(), thickening);
  try {
    return mesh_by({relaxed_ratios.back(), few_added_points}, input, {}, thickening).has_value();
  } catch (const ModelError&) {
    return false;
  }
}

TetMesh mesh_shape(const Shape& shape, const MeshSize& size, const std::vector<Vec3>& points_m) {
  return mesh_shape(shape, size, points_m, WantedOrder::linear);
}
}  // namespace tapstudy::core
