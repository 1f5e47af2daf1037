#include "protocols/surface_file.hpp"

#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Simple_cartesian.h>
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <map>
#include <vector>

#include "core/error.hpp"
namespace tapstudy::protocols {
namespace {
using Point = CGAL::Simple_cartesian<double>::Point_3;
using Place = std::array<double, 3>;

struct Soup {
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> faces;
};

Soup soup_of(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw core::InvalidInput{
        fmt::format("{}: cannot be read ({})", file,
                    std::filesystem::exists(file, error) ? "not a file" : "no such file")};
  }
  Soup soup;
  bool is_read = false;
  try {
    is_read = CGAL::IO::read_polygon_soup(file, soup.points, soup.faces);
  } catch (const std::exception&) {
    is_read = false;
  }
  if (!is_read || soup.faces.empty()) {
    throw core::InvalidInput{file +
                             ": is not a surface (one of: .stl, .ply, .off, .obj, with at least "
                             "one face; is it cut short?)"};
  }
  return soup;
}
}  // namespace

core::TriangleSurface read_surface(const std::string& file, double metres_per_unit) {
  const Soup soup = soup_of(file);
  std::map<Place, int> number_of;
  std::vector<Place> points;
  const auto number = [&](std::size_t index) {
    const Point& p = soup.points.at(index);
    // adding zero makes -0 and 0 one place
    const Place place{metres_per_unit * p.x() + 0.0, metres_per_unit * p.y() + 0.0,
                      metres_per_unit * p.z() + 0.0};
    const auto [found, is_new] = number_of.emplace(place, static_cast<int>(points.size()));
    if (is_new) {
      points.push_back(place);
    }
    return found->second;
  };
  std::vector<std::array<int, 3>> triangles;
  for (const auto& face : soup.faces) {
    for (std::size_t i = 2; i < face.size(); ++i) {
      triangles.push_back({number(face[0]), number(face[i - 1]), number(face[i])});
    }
  }
  core::TriangleSurface surface;
  surface.points_m.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    surface.points_m.row(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Eigen::RowVector3d>{points[i].data()};
  }
  surface.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    surface.triangles.row(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Eigen::RowVector3i>{triangles[i].data()};
  }
  return surface;
}
}  // namespace tapstudy::protocols
