#include "protocols/surface/surface_file.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/files/sha256.hpp"
#include "core/process/bounded_child.hpp"
#include "protocols/surface/cut_polygon.hpp"
namespace tapstudy::protocols {
namespace {
using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Polygon = std::vector<std::size_t>;
using Triangle = std::array<int, 3>;
constexpr double max_coordinate_m = 1e6;

struct Soup {
  std::vector<Point> points;
  std::vector<Polygon> polygons;
};

bool read_soup(std::istream& bytes, const std::string& ending, Soup& soup) {
  if (ending == ".stl") {
    return CGAL::IO::read_STL(bytes, soup.points, soup.polygons);
  }
  if (ending == ".ply") {
    return CGAL::IO::read_PLY(bytes, soup.points, soup.polygons);
  }
  if (ending == ".off") {
    return CGAL::IO::read_OFF(bytes, soup.points, soup.polygons);
  }
  return ending == ".obj" && CGAL::IO::read_OBJ(bytes, soup.points, soup.polygons);
}

std::string ending_of(const std::string& file) {
  std::string ending = std::filesystem::path{file}.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

[[noreturn]] void refuse(const SurfaceSource& source) {
  throw core::InvalidInput{source.file +
                           ": is not a surface (one of: .stl, .ply, .off, .obj, with at least "
                           "one face; is it cut short?)"};
}

Soup soup_of(const SurfaceSource& source) {
  Soup soup;
  std::istringstream bytes{source.bytes};
  bool is_read = false;
  try {
    is_read = read_soup(bytes, ending_of(source.file), soup);
  } catch (const std::exception&) {
    is_read = false;
  }
  const auto is_inside = [&](const Polygon& polygon) {
    return polygon.size() >= 3 && std::ranges::all_of(polygon, [&](std::size_t corner) {
             return corner < soup.points.size();
           });
  };
  if (!is_read || soup.polygons.empty() || !std::ranges::all_of(soup.polygons, is_inside)) {
    refuse(source);
  }
  return soup;
}

// Before anything is computed from them: no product of coordinates may overflow.
void check_points(const Soup& soup, const std::string& file, double metres_per_unit) {
  for (const Point& p : soup.points) {
    const double farthest_m =
        metres_per_unit * std::max({std::abs(p.x()), std::abs(p.y()), std::abs(p.z())});
    if (!(farthest_m <= max_coordinate_m)) {
      throw core::InvalidInput{fmt::format(
          "{}: a point is {:.4g} m from the origin (at most {} m; is metres_per_unit right?)", file,
          farthest_m, max_coordinate_m)};
    }
  }
}

std::vector<std::array<std::size_t, 3>> triangles_of(const Polygon& polygon, const Soup& soup,
                                                     const std::string& file,
                                                     double metres_per_unit) {
  if (polygon.size() == 3) {
    return {{polygon[0], polygon[1], polygon[2]}};
  }
  std::vector<core::Vec3> corners_m;
  for (const std::size_t corner : polygon) {
    const Point& p = soup.points[corner];
    corners_m.push_back(metres_per_unit * core::Vec3{p.x(), p.y(), p.z()});
  }
  auto triangles = cut_polygon(corners_m);
  if (triangles.empty()) {
    const core::Vec3& at = corners_m.front();
    throw core::InvalidInput{fmt::format(
        "{}: the face of {} corners at ({:.6g}, {:.6g}, {:.6g}) m cannot be cut into triangles "
        "(its outline crosses or touches itself, or has no area)",
        file, polygon.size(), at.x(), at.y(), at.z())};
  }
  for (auto& triangle : triangles) {
    std::ranges::transform(triangle, triangle.begin(),
                           [&](std::size_t corner) { return polygon[corner]; });
  }
  return triangles;
}

// Merges coincident points.
class JoinedPoints {
 public:
  int number_of(const Point& p, double metres_per_unit) {
    // adding zero maps -0 to 0
    const Place place{metres_per_unit * p.x() + 0.0, metres_per_unit * p.y() + 0.0,
                      metres_per_unit * p.z() + 0.0};
    const auto [found, is_new] = numbers_.emplace(place, static_cast<int>(points_.size()));
    if (is_new) {
      points_.push_back(place);
    }
    return found->second;
  }
  core::TriangleSurface::Points take() const {
    core::TriangleSurface::Points points{static_cast<Eigen::Index>(points_.size()), 3};
    for (std::size_t i = 0; i < points_.size(); ++i) {
      points.row(static_cast<Eigen::Index>(i)) =
          Eigen::Map<const Eigen::RowVector3d>{points_[i].data()};
    }
    return points;
  }

 private:
  using Place = std::array<double, 3>;
  std::map<Place, int> numbers_;
  std::vector<Place> points_;
};

const core::ChildJob reading{"read a surface", [](const std::string& packed) {
                               core::UnpackedBytes bytes{packed};
                               auto file = bytes.get<std::string>();
                               soup_of({std::move(file), bytes.get<std::string>(), {}});
                               return std::string{"read"};
                             }};

// CGAL's readers take a file at its word, and crash or take all memory where it lies: what they
// survive elsewhere, they survive here.
void try_reading(const SurfaceSource& source) {
  constexpr core::ChildLimits limits{15, 2'000'000'000};
  core::PackedBytes bytes;
  bytes.put(source.file);
  bytes.put(source.bytes);
  try {
    core::in_bounded_child(reading, bytes.take(), source.file, limits);
  } catch (const core::ModelError&) {
    refuse(source);
  }
}
}  // namespace

SurfaceSource surface_source(std::string file, std::string bytes) {
  std::string sha256 = core::sha256(bytes);
  return {std::move(file), std::move(bytes), std::move(sha256)};
}

core::TriangleSurface read_surface(const SurfaceSource& source, double metres_per_unit) {
  try_reading(source);
  const Soup soup = soup_of(source);
  check_points(soup, source.file, metres_per_unit);
  JoinedPoints points;
  std::vector<Triangle> triangles;
  for (const Polygon& polygon : soup.polygons) {
    for (const auto& corners : triangles_of(polygon, soup, source.file, metres_per_unit)) {
      Triangle triangle{};
      std::ranges::transform(corners, triangle.begin(), [&](std::size_t corner) {
        return points.number_of(soup.points[corner], metres_per_unit);
      });
      triangles.push_back(triangle);
    }
  }
  core::TriangleSurface surface;
  surface.points_m = points.take();
  surface.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    surface.triangles.row(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Eigen::RowVector3i>{triangles[i].data()};
  }
  return surface;
}
}  // namespace tapstudy::protocols
