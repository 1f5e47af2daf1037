#include "core/model/shells/triangulation.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>

#include "core/algebra/dense_solvers.hpp"
#include "core/error.hpp"
#include "core/model/mesh/tetgen_mesher.hpp"
namespace tapstudy::core {
TriangleSurface triangulated(const Box& plate, double width_m,
                             const std::vector<Fixation>& regions) {
  const Box thick{{plate.size_m.x(), plate.size_m.y(), width_m}};
  std::vector<Vec3> points_m = points_to_mesh(regions, plate);
  for (Vec3& point_m : points_m) {
    point_m.z() = 0.0;
  }
  MeshSize size;
  size.max_tet_volume_m3 = width_m * width_m * width_m / (6.0 * std::numbers::sqrt2);
  const TetMesh mesh = mesh_shape(thick, size, points_m);
  const double snap_m = bounds(Shape{thick}).snap_m();
  const auto is_above = [&](int node) { return std::abs(mesh.nodes_m(node, 2)) <= snap_m; };
  TriangleSurface result;
  std::map<int, int> number_of;
  std::vector<std::array<int, 3>> triangles;
  for (const auto& row : mesh.surface.rowwise()) {
    if (std::ranges::all_of(row, is_above)) {
      auto& triangle = triangles.emplace_back();
      std::ranges::transform(row, triangle.begin(), [&](int node) {
        return number_of.try_emplace(node, static_cast<int>(number_of.size())).first->second;
      });
    }
  }
  result.points_m.resize(static_cast<Eigen::Index>(number_of.size()), 3);
  for (const auto& [node, number] : number_of) {
    result.points_m.row(number) << mesh.nodes_m(node, 0), mesh.nodes_m(node, 1),
        -0.5 * plate.size_m.z();
  }
  result.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    result.triangles.row(static_cast<Eigen::Index>(i)) << triangles[i][0], triangles[i][1],
        triangles[i][2];
  }
  return result;
}

namespace {
using Steps = std::array<int, 3>;  // towards each corner; their sum is the order

// Numbers the places of a lattice: those of corners first.
class Numbering {
 public:
  Numbering(const TriangleSurface& facets, int order)
      : facets_{facets}, order_{order}, next_{static_cast<int>(facets.points_m.rows())} {}

  int place(Eigen::Index triangle, const Steps& steps) {
    const auto corners = facets_.triangles.row(triangle);
    std::array<int, 2> ends{-1, -1};  // of the edge on which it lies
    int along = 0;                    // steps towards the end of the higher number
    int away_from = 0;                // corners
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const int corner = corners[static_cast<Eigen::Index>(i)];
      if (steps.at(i) == order_) {
        return corner;
      }
      away_from += steps.at(i) == 0 ? 1 : 0;
      if (steps.at(i) > 0 && corner > ends[1]) {
        ends = {ends[1], corner};
        along = steps.at(i);
      } else if (steps.at(i) > 0) {
        ends[0] = corner;
      }
    }
    if (away_from == 0) {
      return next_++;
    }
    const auto [edge, is_new] = first_on_.try_emplace(ends, next_);
    next_ += is_new ? order_ - 1 : 0;
    return edge->second + along - 1;
  }
  int count() const { return next_; }

 private:
  const TriangleSurface& facets_;
  int order_;
  int next_;
  std::map<std::array<int, 2>, int> first_on_;
};
// The middle's normals at the places of triangles, one for all that are joined smoothly there.
class Directors {
 public:
  Directors(const CurvedTriangles& middle, const Lattice& lattice)
      : middle_{middle}, lattice_{lattice}, columns_{lattice.triangles.cols()} {
    for (int j = 0; j <= lattice.order; ++j) {
      for (int i = 0; i <= lattice.order - j; ++i) {
        steps_.push_back({lattice.order - i - j, i, j});
        functions_.push_back(functions_at(static_cast<double>(i) / lattice.order,
                                          static_cast<double>(j) / lattice.order, lattice.order));
      }
    }
    for (Eigen::Index triangle = 0; triangle < lattice.triangles.rows(); ++triangle) {
      for (Eigen::Index column = 0; column < columns_; ++column) {
        joined_.try_emplace(key_of(triangle, column), Vec3::Zero()).first->second +=
            own_normal(triangle, column);
      }
    }
  }

  TriangleSurface::Points of_triangles() const {
    TriangleSurface::Points directors(lattice_.triangles.size(), 3);
    for (Eigen::Index triangle = 0; triangle < lattice_.triangles.rows(); ++triangle) {
      for (Eigen::Index column = 0; column < columns_; ++column) {
        directors.row(triangle * columns_ + column) =
            joined_.at(key_of(triangle, column)).normalized().transpose();
      }
    }
    return directors;
  }
  // Of least length among those that are 1 along each normal of the place.
  void set_offsets(Lattice& lattice) const {
    constexpr double longest = 6.0;  // beyond, a sheet is folded back on itself
    constexpr double missed = 0.1;   // of half of the thickness
    std::map<int, std::vector<Vec3>> normals_of;
    for (const auto& [key, sum] : joined_) {
      normals_of[key[0]].push_back(sum.normalized());
    }
    lattice.offsets.resize(lattice.places_m.rows(), 3);
    for (const auto& [place, normals] : normals_of) {
      lattice.is_folded.push_back(normals.size() > 1);
      Eigen::MatrixX3d rows(static_cast<Eigen::Index>(normals.size()), 3);
      for (std::size_t i = 0; i < normals.size(); ++i) {
        rows.row(static_cast<Eigen::Index>(i)) = normals[i].transpose();
      }
      const Vec3 offset = normals.size() == 1 ? normals.front() : meeting(rows);
      const bool do_meet = ((rows * offset).array() - 1.0).abs().maxCoeff() <= missed;
      if (!do_meet || offset.norm() > longest) {
        const Vec3 at_m = lattice.places_m.row(place);
        throw ModelError{
            fmt::format("shells: at ({:.4g}, {:.4g}, {:.4g}) m the sheet is folded back on itself",
                        at_m.x(), at_m.y(), at_m.z())};
      }
      lattice.offsets.row(place) = offset.transpose();
    }
  }

 private:
  using Key = std::array<int, 2>;  // place, and which of its normals

  static Vec3 meeting(const Eigen::MatrixX3d& normals) {
    constexpr double told = 0.1;  // nearly equal normals tell one direction
    return shortest_solution(normals, Eigen::VectorXd::Ones(normals.rows()), told);
  }
  Key key_of(Eigen::Index triangle, Eigen::Index column) const {
    constexpr int only = 0;
    const Steps& steps = steps_.at(static_cast<std::size_t>(column));
    const int place = lattice_.triangles(triangle, column);
    const auto zeros = std::ranges::count(steps, 0);
    if (zeros == 2) {
      const auto corner = std::ranges::max_element(steps) - steps.begin();
      return {place, middle_.fan(triangle, static_cast<int>(corner))};
    }
    if (zeros == 0) {
      return {place, only};
    }
    const auto opposite = std::ranges::find(steps, 0) - steps.begin();
    const auto facet = middle_.surface().facets.triangles.row(triangle);
    const bool is_smooth = middle_.is_smooth(facet[(opposite + 1) % 3], facet[(opposite + 2) % 3]);
    return {place, is_smooth ? only : static_cast<int>(triangle)};
  }
  Vec3 own_normal(Eigen::Index triangle, Eigen::Index column) const {
    const Functions& functions = functions_.at(static_cast<std::size_t>(column));
    TriangleSurface::Points from_first_m =
        lattice_.places_m(lattice_.triangles.row(triangle), Eigen::all);
    from_first_m.rowwise() -= from_first_m.row(0).eval();
    const Vec3 along_x = from_first_m.transpose() * functions.x_slopes;
    const Vec3 along_y = from_first_m.transpose() * functions.y_slopes;
    return along_x.cross(along_y).normalized();
  }

  const CurvedTriangles& middle_;
  const Lattice& lattice_;
  Eigen::Index columns_;
  std::vector<Steps> steps_;  // of each column
  std::vector<Functions> functions_;
  std::map<Key, Vec3> joined_;
};
}  // namespace

Lattice lattice_on(const CurvedTriangles& middle, int order) {
  const TriangleSurface& facets = middle.surface().facets;
  Numbering numbering{facets, order};
  Lattice lattice{order, {}, {}, {}, {}, {}};
  lattice.triangles.resize(facets.triangles.rows(), places_of_triangle(order));
  const auto for_each_place = [&](const auto& act) {
    for (Eigen::Index triangle = 0; triangle < lattice.triangles.rows(); ++triangle) {
      for (int j = 0; j <= order; ++j) {
        for (int i = 0; i <= order - j; ++i) {
          act(triangle, i, j, column_of(order, i, j));
        }
      }
    }
  };
  for_each_place([&](Eigen::Index triangle, int i, int j, Eigen::Index column) {
    lattice.triangles(triangle, column) = numbering.place(triangle, {order - i - j, i, j});
  });
  lattice.places_m.resize(numbering.count(), 3);
  for_each_place([&](Eigen::Index triangle, int i, int j, Eigen::Index column) {
    lattice.places_m.row(lattice.triangles(triangle, column)) =
        middle.at_m(triangle, static_cast<double>(i) / order, static_cast<double>(j) / order)
            .transpose();
  });
  const Directors directors{middle, lattice};
  lattice.directors = directors.of_triangles();
  directors.set_offsets(lattice);
  return lattice;
}

namespace {
constexpr int bottom = 0;
constexpr int top = 2;

// A corner of a tetrahedron or of a triangle of its surface: steps on a triangle of the lattice,
// and a layer.
struct Corner {
  int i{};
  int j{};
  int layer{};
};
Corner middle(const Corner& a, const Corner& b) {
  return {(a.i + b.i) / 2, (a.j + b.j) / 2, (a.layer + b.layer) / 2};
}

// Prisms of two steps a side on each triangle of the lattice, three tetrahedra each. The diagonal
// of a prism's side rises from its place of the lower number, which both neighbours know.
class Layering {
 public:
  explicit Layering(const Lattice& lattice) : lattice_{lattice} {}

  void add_triangle(Eigen::Index triangle) {
    triangle_ = triangle;
    for (int j = 0; j < lattice_.order; j += 2) {
      for (int i = 0; i < lattice_.order - j; i += 2) {
        add_prism({{{i, j, bottom}, {i + 2, j, bottom}, {i, j + 2, bottom}}});
        if (i + j + 2 < lattice_.order) {
          add_prism({{{i + 2, j, bottom}, {i + 2, j + 2, bottom}, {i, j + 2, bottom}}});
        }
      }
    }
  }
  // Of the edge from corner `edge` on, which no other triangle has.
  void add_rim(Eigen::Index triangle, int edge) {
    triangle_ = triangle;
    for (int along = 0; along < lattice_.order; along += 2) {
      add_side(on_edge(edge, along), on_edge(edge, along + 2));
    }
  }
  TetMesh::Indices tets() const { return rows_of(tets_); }
  TetMesh::Indices surface() const { return rows_of(surface_); }

 private:
  int node(const Corner& at) const {
    const int place = lattice_.triangles(triangle_, column_of(lattice_.order, at.i, at.j));
    return static_cast<int>(node_at(place, at.layer));
  }
  static Corner at_top(Corner at) {
    at.layer = top;
    return at;
  }
  Corner on_edge(int edge, int along) const {
    const int left = lattice_.order - along;
    constexpr int from_first = 0;
    constexpr int from_second = 1;
    return edge == from_first    ? Corner{along, 0, bottom}
           : edge == from_second ? Corner{left, along, bottom}
                                 : Corner{0, left, bottom};
  }
  void add_prism(const std::array<Corner, 3>& below) {
    std::array<Corner, 3> by_number = below;
    std::ranges::sort(by_number, {}, [this](const Corner& at) { return node(at); });
    const auto& [a, b, c] = by_number;
    add_tet({a, b, c, at_top(c)});
    add_tet({a, b, at_top(c), at_top(b)});
    add_tet({a, at_top(b), at_top(c), at_top(a)});
    add_face({below[0], below[2], below[1]});
    add_face({at_top(below[0]), at_top(below[1]), at_top(below[2])});
  }
  void add_side(const Corner& from, const Corner& to) {
    if (node(from) < node(to)) {
      add_face({from, to, at_top(to)});
      add_face({from, at_top(to), at_top(from)});
    } else {
      add_face({from, to, at_top(from)});
      add_face({to, at_top(to), at_top(from)});
    }
  }
  void add_tet(std::array<Corner, 4> corners) {
    if (six_volumes(corners) < 0) {
      std::swap(corners[0], corners[1]);
    }
    add_with_middles(corners, tet_edges, tets_);
  }
  void add_face(const std::array<Corner, 3>& corners) {
    constexpr std::array<std::array<int, 2>, 3> edges{tet_edges[0], tet_edges[1], tet_edges[2]};
    add_with_middles(corners, edges, surface_);
  }
  // In steps: the triangles of the lattice are counter-clockwise.
  static int six_volumes(const std::array<Corner, 4>& corners) {
    const auto from_first = [&](std::size_t k) {
      return Eigen::Vector3i{corners.at(k).i - corners[0].i, corners.at(k).j - corners[0].j,
                             corners.at(k).layer - corners[0].layer};
    };
    Eigen::Matrix3i edges;
    edges << from_first(1), from_first(2), from_first(3);
    return edges.determinant();
  }
  template <class Corners, class Edges>
  void add_with_middles(const Corners& corners, const Edges& edges,
                        std::vector<std::vector<int>>& rows) const {
    std::vector<int>& row = rows.emplace_back();
    for (const Corner& corner : corners) {
      row.push_back(node(corner));
    }
    for (const auto& [from, to] : edges) {
      row.push_back(node(middle(corners.at(static_cast<std::size_t>(from)),
                                corners.at(static_cast<std::size_t>(to)))));
    }
  }
  static TetMesh::Indices rows_of(const std::vector<std::vector<int>>& rows) {
    TetMesh::Indices indices(static_cast<Eigen::Index>(rows.size()),
                             static_cast<Eigen::Index>(rows.front().size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      indices.row(static_cast<Eigen::Index>(i)) = Eigen::Map<const Eigen::RowVectorXi>{
          rows[i].data(), static_cast<Eigen::Index>(rows[i].size())};
    }
    return indices;
  }

  const Lattice& lattice_;
  Eigen::Index triangle_{};
  std::vector<std::vector<int>> tets_;
  std::vector<std::vector<int>> surface_;
};

// The edges that one triangle alone has: triangle, and which of its edges.
std::vector<std::pair<Eigen::Index, int>> rim_of(const Lattice& lattice) {
  const int order = lattice.order;
  const std::array<Eigen::Index, 3> corners{column_of(order, 0, 0), column_of(order, order, 0),
                                            column_of(order, 0, order)};
  std::map<std::pair<int, int>, std::pair<Eigen::Index, int>> rim;
  for (Eigen::Index triangle = 0; triangle < lattice.triangles.rows(); ++triangle) {
    for (int edge = 0; edge < 3; ++edge) {
      const int from = lattice.triangles(triangle, corners.at(static_cast<std::size_t>(edge)));
      const int to =
          lattice.triangles(triangle, corners.at(static_cast<std::size_t>((edge + 1) % 3)));
      if (rim.erase({to, from}) == 0) {
        rim[{from, to}] = {triangle, edge};
      }
    }
  }
  std::vector<std::pair<Eigen::Index, int>> edges;
  std::ranges::transform(rim, std::back_inserter(edges),
                         [](const auto& one) { return one.second; });
  return edges;
}
}  // namespace

TetMesh layered(const Lattice& lattice, double thickness_m) {
  TetMesh mesh;
  mesh.nodes_m.resize(layers * lattice.places_m.rows(), 3);
  for (Eigen::Index place = 0; place < lattice.places_m.rows(); ++place) {
    for (int layer = 0; layer < layers; ++layer) {
      mesh.nodes_m.row(node_at(place, layer)) =
          lattice.places_m.row(place) +
          0.5 * thickness_m * height_of(layer) * lattice.offsets.row(place);
    }
  }
  Layering layering{lattice};
  for (Eigen::Index triangle = 0; triangle < lattice.triangles.rows(); ++triangle) {
    layering.add_triangle(triangle);
  }
  for (const auto& [triangle, edge] : rim_of(lattice)) {
    layering.add_rim(triangle, edge);
  }
  mesh.tets = layering.tets();
  mesh.surface = layering.surface();
  return mesh;
}
}  // namespace tapstudy::core
