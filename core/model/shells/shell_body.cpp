#include "core/model/shells/shell_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
#include "core/model/shells/sheet_body.hpp"
#include "core/model/shells/shell_element.hpp"
#include "core/model/shells/shell_elements.hpp"
#include "core/model/shells/triangulation.hpp"
namespace tapstudy::core {
namespace {
using Entries = std::vector<Eigen::Triplet<double>>;

// How a place's unknowns move its node on a layer along an axis.
Eigen::Matrix<double, 1, shell_unknowns> motion_of(const Vec3& offset, int layer,
                                                   Eigen::Index axis) {
  Eigen::Matrix<double, 1, shell_unknowns> motion;
  motion << Vec3::Unit(axis).transpose(),
      height_of(layer) * offset.cross(Vec3::Unit(axis)).transpose();
  return motion;
}

// The unknowns of all places that are left, in order, once nodes are held: of each place a basis of
// its own unknowns' motions that the held nodes allow.
class Supported {
 public:
  using Basis = Eigen::Matrix<double, shell_unknowns, Eigen::Dynamic>;

  Supported(const std::vector<bool>& held, const Lattice& lattice)
      : held_{held}, lattice_{lattice}, normals_(lattice.places_m.rows(), 3) {
    for (Eigen::Index i = 0; i < lattice.triangles.rows(); ++i) {
      for (Eigen::Index k = 0; k < lattice.triangles.cols(); ++k) {
        normals_.row(lattice.triangles(i, k)) =
            lattice.directors.row(i * lattice.triangles.cols() + k);
      }
    }
    for (Eigen::Index place = 0; place < lattice.places_m.rows(); ++place) {
      firsts_.push_back(count_);
      bases_.push_back(basis_of(place));
      if (bases_.back().cols() > 0) {
        first_of_place_.push_back(count_);
        count_ += static_cast<int>(bases_.back().cols());
      }
    }
    first_of_place_.push_back(count_);
  }
  int count() const { return count_; }
  const std::vector<int>& first_of_place() const { return first_of_place_; }
  int first(Eigen::Index place) const { return firsts_[static_cast<std::size_t>(place)]; }
  const Basis& basis(Eigen::Index place) const { return bases_[static_cast<std::size_t>(place)]; }

 private:
  using Row = Eigen::Matrix<double, 1, shell_unknowns>;

  bool is_folded(Eigen::Index place) const {
    return lattice_.is_folded[static_cast<std::size_t>(place)];
  }
  // What the held nodes of a place allow no motion along; and turning about the normal, which moves
  // nothing, and about the offset of a fold that is held on two layers.
  std::vector<Row> prevented(Eigen::Index place) const {
    const Vec3 offset = lattice_.offsets.row(place);
    std::vector<Row> rows;
    std::array<int, 3> layers_held{};
    for (int layer = 0; layer < layers; ++layer) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        if (held_[static_cast<std::size_t>(3 * node_at(place, layer) + axis)]) {
          rows.push_back(motion_of(offset, layer, axis));
          ++layers_held.at(static_cast<std::size_t>(axis));
        }
      }
    }
    const bool turns = !rows.empty() && std::ranges::max(layers_held) < 2;
    if (!is_folded(place) || (!rows.empty() && !turns)) {
      Row& about = rows.emplace_back(Row::Zero());
      about.tail<3>() = is_folded(place) ? Eigen::RowVector3d{offset.normalized().transpose()}
                                         : Eigen::RowVector3d{normals_.row(place)};
    }
    return rows;
  }
  Basis basis_of(Eigen::Index place) const {
    constexpr double rounding = 1e-12;
    constexpr double hardly = 1e-3;  // squared: normals of a rim lie in its plane to a degree or so
    const std::vector<Row> rows = prevented(place);
    if (rows.empty()) {
      return Basis::Identity(shell_unknowns, shell_unknowns);
    }
    if (rows.size() == 1 && !is_folded(place)) {
      return tangential(normals_.row(place));
    }
    Eigen::Matrix<double, shell_unknowns, shell_unknowns> sum;
    sum.setZero();
    for (const Row& row : rows) {
      sum += row.transpose() * row;
    }
    const EigenPairs pairs = symmetric_eigenpairs(sum);
    const Basis allowed = pairs.vectors.leftCols((pairs.values.array() < hardly).count());
    return (allowed.array().abs() < rounding).select(0.0, allowed);
  }
  // All motions of the middle, and turning about two directions across the normal, along axes of
  // the frame where it is one.
  static Basis tangential(const Vec3& normal) {
    Eigen::Index least = 0;
    normal.cwiseAbs().minCoeff(&least);
    const Vec3 along = (Vec3::Unit(least) - normal[least] * normal).normalized();
    Basis basis = Basis::Zero(shell_unknowns, 5);
    basis.topLeftCorner<3, 3>().setIdentity();
    basis.block<3, 1>(3, 3) = along;
    basis.block<3, 1>(3, 4) = normal.cross(along);
    return basis;
  }

  const std::vector<bool>& held_;
  const Lattice& lattice_;
  TriangleSurface::Points normals_;  // one of each place
  std::vector<int> firsts_;
  std::vector<Basis> bases_;
  std::vector<int> first_of_place_;
  int count_{0};
};

SparseMatrix from_entries(const Entries& entries, Eigen::Index rows, Eigen::Index columns) {
  SparseMatrix matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

SparseMatrix displacements(const Supported& supported, const Lattice& lattice) {
  constexpr double rounding = 1e-12;
  Entries entries;
  for (Eigen::Index place = 0; place < lattice.places_m.rows(); ++place) {
    const Supported::Basis& basis = supported.basis(place);
    for (int layer = 0; layer < layers; ++layer) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const Eigen::RowVectorXd row = motion_of(lattice.offsets.row(place), layer, axis) * basis;
        for (Eigen::Index i = 0; i < row.size(); ++i) {
          if (std::abs(row[i]) > rounding) {
            entries.emplace_back(static_cast<int>(3 * node_at(place, layer) + axis),
                                 supported.first(place) + static_cast<int>(i), row[i]);
          }
        }
      }
    }
  }
  return from_entries(entries, 3 * node_at(lattice.places_m.rows(), 0), supported.count());
}

// Adds what of a triangle's matrix two of its places have to the lower triangle of what is left.
void add_pair(const Eigen::MatrixXd& of_pair, int first_row, int first_column, Entries& entries) {
  for (Eigen::Index column = 0; column < of_pair.cols(); ++column) {
    for (Eigen::Index row = 0; row < of_pair.rows(); ++row) {
      const int a = first_row + static_cast<int>(row);
      const int b = first_column + static_cast<int>(column);
      if (a >= b && of_pair(row, column) != 0.0) {
        entries.emplace_back(a, b, of_pair(row, column));
      }
    }
  }
}

StiffnessAndMass assembled(const Lattice& lattice, const ShellElements& elements,
                           const Supported& supported) {
  Entries stiffness;
  Entries mass;
  const Eigen::Index count = lattice.triangles.cols();
  for (Eigen::Index triangle = 0; triangle < lattice.triangles.rows(); ++triangle) {
    const auto places = lattice.triangles.row(triangle);
    const auto element = elements.of(lattice.places_m(places, Eigen::all),
                                     lattice.directors.middleRows(triangle * count, count));
    for (Eigen::Index i = 0; i < count; ++i) {
      for (Eigen::Index j = 0; j < count; ++j) {
        const int row = supported.first(places[i]);
        const int column = supported.first(places[j]);
        const auto between = [&](const Eigen::MatrixXd& all) -> Eigen::MatrixXd {
          return supported.basis(places[i]).transpose() *
                 all.block<shell_unknowns, shell_unknowns>(shell_unknowns * i, shell_unknowns * j) *
                 supported.basis(places[j]);
        };
        if (row >= column) {
          add_pair(between(element.stiffness), row, column, stiffness);
          add_pair(between(element.mass), row, column, mass);
        }
      }
    }
  }
  return {from_entries(stiffness, supported.count(), supported.count()),
          from_entries(mass, supported.count(), supported.count()), supported.first_of_place()};
}

// Of nodes that are all free, then of what is left.
void add_springs_to(const std::vector<SpringSupport>& springs, DiscreteBody& body) {
  if (springs.empty()) {
    return;
  }
  const auto rows = static_cast<Eigen::Index>(body.dofs.position.size());
  SparseMatrix of_nodes(rows, rows);
  add_springs(body.mesh, springs, free_dofs(std::vector<bool>(body.dofs.position.size(), false)),
              of_nodes);
  const SparseMatrix whole = of_nodes.selfadjointView<Eigen::Lower>();
  const SparseMatrix left = body.displacement.transpose() * whole * body.displacement;
  body.matrices.K += SparseMatrix{left.triangularView<Eigen::Lower>()};
}

// Balls and boxes, of these what is beside the body left out; not lines and points. A box is as
// wide as its largest side; a strip of more than 25 times its width, which thousands of triangles
// would fill, counts as wider.
std::vector<FilledRegion> filled(const std::vector<Fixation>& regions, const Bounds& body) {
  constexpr double longest_strip = 25.0;
  std::vector<FilledRegion> all;
  for (const Fixation& region : regions) {
    if (region.shape == RegionShape::ball) {
      all.push_back({region.at_m, region.at_m, region.radius_m, region.radius_m});
    } else if (region.shape == RegionShape::box) {
      const Vec3 low_m = region.low_m.cwiseMax(body.low_m);
      const Vec3 high_m = region.high_m.cwiseMin(body.high_m);
      Vec3 size_m = high_m - low_m;
      std::ranges::sort(size_m);
      if (size_m.y() > body.snap_m()) {
        const double width_m = size_m.y() * size_m.z() / (size_m.y() + size_m.z());
        all.push_back({low_m, high_m, 0.0, std::max(width_m, size_m.z() / longest_strip)});
      }
    }
  }
  return all;
}

// The middle of a plate, or of a sheet whose triangles are divided to the width of the elements.
MiddleSurface middle_of(const Plate& plate, const std::vector<Fixation>& regions) {
  const double width_m = plate.mesh.shell_width_m.value();
  if (const auto* const box = std::get_if<Box>(&plate.shape)) {
    return {triangulated(*box, width_m, regions), {}};
  }
  return divided(middle_surface(std::get<Solid>(plate.shape).sheet()->middle), width_m,
                 filled(regions, bounds(plate.shape)), max_sheet_triangles);
}

// Without the points that are no corners of it.
TriangleSurface corners_of_surface(const TetMesh& mesh) {
  std::map<int, int> number_of;
  for (const int node : mesh.surface.leftCols<3>().reshaped()) {
    number_of.emplace(node, 0);
  }
  TriangleSurface surface;
  surface.points_m.resize(static_cast<Eigen::Index>(number_of.size()), 3);
  int count = 0;
  for (auto& [node, number] : number_of) {
    number = count++;
    surface.points_m.row(number) = mesh.nodes_m.row(node);
  }
  surface.triangles =
      mesh.surface.leftCols<3>().unaryExpr([&](int node) { return number_of.at(node); });
  return surface;
}

double thickness_of(const Shape& shape) {
  const auto* const box = std::get_if<Box>(&shape);
  return box != nullptr ? box->size_m.z() : std::get<Solid>(shape).sheet()->thickness_m;
}
}  // namespace

bool is_sheet(const Shape& shape) {
  if (const auto* const solid = std::get_if<Solid>(&shape)) {
    return solid->sheet() != nullptr;
  }
  const Vec3& size_m = std::get<Box>(shape).size_m;
  return std::min(size_m.x(), size_m.y()) >= least_width_to_thickness * size_m.z();
}

double widest_shells_m(const Shape& shape) {
  if (const auto* const box = std::get_if<Box>(&shape)) {
    return 0.5 * std::min(box->size_m.x(), box->size_m.y());
  }
  const TriangleSurface& middle = std::get<Solid>(shape).sheet()->middle;
  double longest_m = 0.0;
  for (const auto& triangle : middle.triangles.rowwise()) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      longest_m = std::max(
          longest_m,
          (middle.points_m.row(triangle[k]) - middle.points_m.row(triangle[(k + 1) % 3])).norm());
    }
  }
  return longest_m;
}

Solid sheet_body(TriangleSurface middle, double thickness_m) {
  const MiddleSurface surface = middle_surface(middle);
  const TetMesh mesh = layered(lattice_on(CurvedTriangles{surface}, shell_order), thickness_m);
  return {corners_of_surface(mesh), Sheet{std::move(middle), thickness_m}};
}

std::size_t folds_of(const Sheet& sheet) {
  return middle_surface(sheet.middle).folds.size();
}

DiscreteBody shell_body(const Plate& plate, const Material& material, int order,
                        const std::vector<Fixation>& regions, const ProgressHook& progress) {
  check_material(material);
  if (!is_sheet(plate.shape)) {
    throw ModelError{fmt::format(
        "mesh.shell_width_m: shell elements are for plates of size_m that are at least {} times "
        "wider than thick, and for surfaces with a thickness_m",
        least_width_to_thickness)};
  }
  DiscreteBody body;
  Stopwatch watch;
  tell(progress, "meshing");
  const MiddleSurface middle = middle_of(plate, regions);
  const Lattice lattice = lattice_on(CurvedTriangles{middle}, order);
  body.mesh = layered(lattice, thickness_of(plate.shape));
  body.order = order;
  body.elements = static_cast<int>(lattice.triangles.rows());
  body.cost.mesh_s = watch.lap_s();
  tell(progress, fmt::format("assembling {} shell elements", body.elements));
  const std::vector<bool> held = constrained_dofs(body.mesh, plate.shape, plate.fixations);
  body.dofs = free_dofs(held);
  const Supported supported{held, lattice};
  body.matrices =
      assembled(lattice, ShellElements{material, thickness_of(plate.shape), order}, supported);
  body.displacement = displacements(supported, lattice);
  const auto springs = spring_supports(body.mesh, plate.shape, plate.fixations);
  add_springs_to(springs, body);
  body.matrices.resisted_motions = RigidMotions{body.mesh}.resisted(body.dofs, springs);
  body.matrices.rigid_body_modes = unresisted(body.matrices.resisted_motions);
  body.cost.assemble_s = watch.lap_s();
  return body;
}
}  // namespace tapstudy::core
