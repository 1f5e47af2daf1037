#include "protocols/surface/surface_file.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/OFF.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/files/sha256.hpp"
#include "core/process/bounded_child.hpp"
#include "core/text/plain_text.hpp"
#include "protocols/surface/check_surface.hpp"
#include "protocols/surface/cut_polygon.hpp"
#include "protocols/surface/join_points.hpp"
#include "protocols/surface/repaired_surface.hpp"
#include "protocols/surface/surface_soup.hpp"
#include "protocols/yaml/problems.hpp"
namespace tapstudy::protocols {
namespace {
using core::Vec3;
constexpr double max_coordinate_m = 1e6;
constexpr std::size_t most_read = 2'000'000;  // triangles

std::string ending_of(const std::string& file) {
  return core::lower_case(std::filesystem::path{file}.extension().string());
}

// What else bodies come as, the program that makes triangles of it, and what its numbers are then:
// assimp turns COLLADA, whose files name their unit, into metres, and leaves 3MF, whose files do
// so, too, as it is; gmsh turns STEP and IGES into millimetres.
struct Converter {
  std::string_view ending;
  std::string_view holds;
  std::string_view command;
  std::string_view metres_per_unit;
};
constexpr std::string_view by_assimp = "assimp export {} body.ply (Debian: assimp-utils)";
constexpr std::string_view by_gmsh = "gmsh {} -2 -o body.stl (Debian: gmsh)";
constexpr std::string_view y_is_up = "1 (and y is up: rotation_rad [1.5708, 0, 0] turns it to z)";
constexpr std::array<Converter, 8> converters{
    Converter{".3mf", "3MF", by_assimp,
              "what the file's <model unit=…> says, and 0.001 where that is missing"},
    Converter{".gltf", "glTF", by_assimp, y_is_up},
    Converter{".glb", "glTF", by_assimp, y_is_up},
    Converter{".dae", "COLLADA", by_assimp, y_is_up},
    Converter{".step", "STEP: curved faces", by_gmsh, "0.001"},
    Converter{".stp", "STEP: curved faces", by_gmsh, "0.001"},
    Converter{".iges", "IGES: curved faces", by_gmsh, "0.001"},
    Converter{".igs", "IGES: curved faces", by_gmsh, "0.001"},
};

[[noreturn]] void refuse_format(const std::string& file) {
  const auto* const known = std::ranges::find(converters, ending_of(file), &Converter::ending);
  throw core::InvalidInput{fmt::format(
      "{}: is not a surface that is read (one of: .stl, .ply, .off, .obj){}", file,
      known == converters.end()
          ? ""
          : fmt::format("; it holds {}. Convert it: {}; metres_per_unit is then {}", known->holds,
                        fmt::format(fmt::runtime(known->command), file), known->metres_per_unit))};
}

[[noreturn]] void refuse_off(const SurfaceSource& source) {
  std::string_view text{source.bytes};
  throw core::InvalidInput{fmt::format(
      "{}: is not a surface: not an OFF of at least one face, all of whose corners are among its "
      "points; its first line is '{}', and it has {} bytes",
      source.file, printable(std::string{take_line(text)}), source.bytes.size())};
}

// What follows the last face, but for its own line's rest and comments.
void check_off_ends(const SurfaceSource& source, std::istream& read, const SurfaceSoup& soup,
                    std::size_t points) {
  const auto at = read.tellg();  // -1 at the end
  std::string_view rest{source.bytes};
  rest.remove_prefix(at < 0 ? rest.size() : static_cast<std::size_t>(at) - 1);
  take_line(rest);
  while (!rest.empty()) {
    const std::string_view line = take_line(rest);
    const auto words = words_of(line);
    if (!words.empty() && !words.front().starts_with('#')) {
      throw core::InvalidInput{fmt::format(
          "{}: is not a surface: a line '{}' is left after all that its header counts ({} points, "
          "{} faces)",
          source.file, printable(std::string{line}), points, soup.polygons.size())};
    }
  }
}

SurfaceSoup soup_of_off(const SurfaceSource& source) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  SurfaceSoup soup;
  std::vector<Point> points;
  std::istringstream bytes{source.bytes};
  bool is_read = false;
  try {
    is_read = CGAL::IO::read_OFF(bytes, points, soup.polygons);
  } catch (const std::exception&) {
    is_read = false;
  }
  const auto is_inside = [&](const std::vector<std::size_t>& polygon) {
    return polygon.size() >= 3 &&
           std::ranges::all_of(polygon, [&](std::size_t corner) { return corner < points.size(); });
  };
  if (!is_read || soup.polygons.empty() || !std::ranges::all_of(soup.polygons, is_inside)) {
    refuse_off(source);
  }
  check_off_ends(source, bytes, soup, points.size());
  for (const Point& p : points) {
    soup.points.emplace_back(p.x(), p.y(), p.z());
  }
  return soup;
}

const core::ChildJob reading{"read a surface", [](const std::string& packed) {
                               core::UnpackedBytes bytes{packed};
                               auto file = bytes.get<std::string>();
                               soup_of_off({std::move(file), bytes.get<std::string>(), {}});
                               return std::string{"read"};
                             }};

// CGAL's reader takes a file at its word, and crashes or takes all memory where it lies: what it
// survives elsewhere, it survives here.
void try_reading_off(const SurfaceSource& source) {
  constexpr core::ChildLimits limits{15, 2'000'000'000};
  core::PackedBytes bytes;
  bytes.put(source.file);
  bytes.put(source.bytes);
  try {
    core::in_bounded_child(reading, bytes.take(), source.file, limits);
  } catch (const core::ModelError&) {
    refuse_off(source);
  }
}

SurfaceSoup soup_of(const SurfaceSource& source) {
  const std::string ending = ending_of(source.file);
  if (ending == ".stl") {
    return read_stl(source.file, source.bytes);
  }
  if (source.bytes.starts_with("\xFF\xFE") || source.bytes.starts_with("\xFE\xFF")) {
    throw core::InvalidInput{
        fmt::format("{0}: its text is UTF-16. Convert it: iconv -f UTF-16 -t UTF-8 {0} > body{1}",
                    source.file, ending)};
  }
  if (ending == ".ply") {
    return read_ply(source.file, source.bytes);
  }
  if (ending == ".obj") {
    return read_obj(source.file, source.bytes);
  }
  if (ending != ".off") {
    refuse_format(source.file);
  }
  try_reading_off(source);
  return soup_of_off(source);
}

// The power of ten that a factor is; unset: it is none.
std::optional<int> power_of_ten(double factor) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.begin(), text.end(), factor, std::chars_format::scientific).ptr;
  const std::string_view written{text.data(), static_cast<std::size_t>(end - text.data())};
  if (!written.starts_with("1e")) {
    return std::nullopt;
  }
  return core::number_in<int>(written.substr(written[2] == '+' ? 3 : 2));
}

// The shortest decimal number that rounds to this one; in single precision, where that holds it to
// the bit: what was written as 0.1 is 0.1 from an ASCII file, a binary one and one of the digits of
// single precision.
std::string shortest_decimal(double value) {
  std::array<char, 32> text{};
  const auto single = static_cast<float>(value);
  const auto written =
      static_cast<double>(single) == value
          ? std::to_chars(text.begin(), text.end(), single, std::chars_format::scientific)
          : std::to_chars(text.begin(), text.end(), value, std::chars_format::scientific);
  return {text.data(), written.ptr};
}

// Decimal numbers times a power of ten are again decimal numbers, without rounding in between: 100
// in millimetres is the same number as 0.1 in metres.
double scaled(double coordinate, double metres_per_unit, std::optional<int> power) {
  const std::string decimal = shortest_decimal(coordinate);
  if (!power) {
    return core::number_in<double>(decimal).value() * metres_per_unit;
  }
  const auto e = decimal.find('e');
  const int exponent =
      core::number_in<int>(std::string_view{decimal}.substr(decimal[e + 1] == '+' ? e + 2 : e + 1))
          .value();
  // unset: so small that it is none
  return core::number_in<double>(fmt::format("{}e{}", decimal.substr(0, e), exponent + *power))
      .value_or(0.0);
}

// In metres, and before anything is computed from them: no product of coordinates may overflow.
void scale(SurfaceSoup& soup, const std::string& file, double metres_per_unit) {
  const std::optional<int> power = power_of_ten(metres_per_unit);
  for (Vec3& point : soup.points) {
    const double farthest_m = metres_per_unit * point.cwiseAbs().maxCoeff();
    if (!(farthest_m <= max_coordinate_m)) {
      throw core::InvalidInput{fmt::format(
          "{}: a point is {:.4g} m from the origin (at most {} m; is metres_per_unit right?)", file,
          farthest_m, max_coordinate_m)};
    }
    for (double& x : point) {
      x = scaled(x, metres_per_unit, power) + 0.0;  // adding zero maps -0 to 0
    }
  }
}

bool comes_before(const Vec3& a, const Vec3& b) {
  return std::ranges::lexicographical_compare(a, b);
}

// Begins at the corner that comes first, so that it is cut alike wherever the file begins it.
std::vector<std::size_t> from_first_corner(std::vector<std::size_t> polygon,
                                           const SurfaceSoup& soup) {
  const auto first = std::ranges::min_element(
      polygon, comes_before, [&](std::size_t corner) { return soup.points[corner]; });
  std::rotate(polygon.begin(), first, polygon.end());
  return polygon;
}

// Corners in one place, one after the other, are one.
std::vector<std::size_t> without_repeated_corners(std::vector<std::size_t> polygon,
                                                  const SurfaceSoup& soup) {
  const auto are_one = [&](std::size_t a, std::size_t b) {
    return soup.points[a] == soup.points[b];
  };
  polygon.erase(std::unique(polygon.begin(), polygon.end(), are_one), polygon.end());
  while (polygon.size() > 1 && are_one(polygon.front(), polygon.back())) {
    polygon.pop_back();
  }
  return polygon;
}

std::vector<std::array<std::size_t, 3>> fan_of(std::size_t corners) {
  std::vector<std::array<std::size_t, 3>> fan;
  for (std::size_t i = 2; i < corners; ++i) {
    fan.push_back({0, i - 1, i});
  }
  return fan;
}

// A face that cannot be cut is a fan, and `uncut` says so of the first one.
std::vector<std::array<std::size_t, 3>> triangles_of(const std::vector<std::size_t>& face,
                                                     const SurfaceSoup& soup, std::string& uncut) {
  if (face.size() == 3) {
    return {{face[0], face[1], face[2]}};
  }
  const auto polygon = without_repeated_corners(face, soup);
  std::vector<core::Vec3> corners_m;
  for (const std::size_t corner : polygon) {
    corners_m.push_back(soup.points[corner]);
  }
  if (polygon.size() < 3) {
    return {{polygon.front(), polygon.front(), polygon.back()}};  // is left out, and told
  }
  auto triangles = polygon.size() > 3 ? cut_polygon(corners_m) : fan_of(3);
  if (triangles.empty()) {
    triangles = fan_of(polygon.size());
    if (uncut.empty()) {
      const core::Vec3& at = corners_m.front();
      uncut = fmt::format(
          "the face of {} corners at ({:.6g}, {:.6g}, {:.6g}) m cannot be cut into triangles (its "
          "outline crosses or touches itself, or has no area)",
          polygon.size(), at.x(), at.y(), at.z());
    }
  }
  for (auto& triangle : triangles) {
    std::ranges::transform(triangle, triangle.begin(),
                           [&](std::size_t corner) { return polygon[corner]; });
  }
  return triangles;
}

// The points that triangles use, each once, in the order of their coordinates; and of each of the
// soup's points its number among them.
struct DistinctPoints {
  std::vector<Vec3> points;
  std::vector<std::size_t> number;
};

DistinctPoints distinct_points(const std::vector<std::array<std::size_t, 3>>& triangles,
                               const SurfaceSoup& soup) {
  std::vector<std::size_t> used;
  for (const auto& triangle : triangles) {
    used.insert(used.end(), triangle.begin(), triangle.end());
  }
  std::ranges::sort(used, comes_before, [&](std::size_t point) { return soup.points[point]; });
  DistinctPoints distinct{{}, std::vector<std::size_t>(soup.points.size())};
  for (const std::size_t point : used) {
    if (distinct.points.empty() || distinct.points.back() != soup.points[point]) {
      distinct.points.push_back(soup.points[point]);
    }
    distinct.number[point] = distinct.points.size() - 1;
  }
  return distinct;
}

SurfaceNoise noise_among(const std::vector<Vec3>& points, const std::vector<std::size_t>& places) {
  SurfaceNoise noise;
  for (std::size_t i = 0; i < points.size(); ++i) {
    noise.points += places[i] == i ? 0 : 1;
    noise.farthest = std::max(noise.farthest, (points[places[i]] - points[i]).norm());
  }
  noise.farthest /= noise.points > 0 ? size_of(points) : 1.0;
  return noise;
}

// Of triangles numbered by points of which some are used.
core::TriangleSurface of_used_points(const std::vector<Vec3>& points,
                                     std::vector<std::array<std::size_t, 3>> triangles) {
  std::vector<int> number(points.size(), 0);
  for (const auto& triangle : triangles) {
    for (const std::size_t corner : triangle) {
      number[corner] = 1;
    }
  }
  core::TriangleSurface surface;
  surface.points_m.resize(std::count(number.begin(), number.end(), 1), 3);
  int used = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (number[i] == 1) {
      surface.points_m.row(used) = points[i].transpose();
      number[i] = used++;
    }
  }
  surface.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      surface.triangles(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          number[triangles[i][k]];
    }
  }
  return surface;
}

// Points in the order of their coordinates, each triangle from its first corner, triangles in the
// order of these: meshers build on the order, which is that of the writing program, so that without
// it the same surface in two files is two bodies.
ReadSurface in_canonical_order(const std::vector<std::array<std::size_t, 3>>& triangles,
                               const SurfaceSoup& soup) {
  const DistinctPoints distinct = distinct_points(triangles, soup);
  const std::vector<std::size_t> places = without_noise(distinct.points);
  ReadSurface read{{}, noise_among(distinct.points, places)};
  std::vector<std::array<std::size_t, 3>> numbered;
  for (const auto& triangle : triangles) {
    std::array<std::size_t, 3> corners{};
    std::ranges::transform(triangle, corners.begin(),
                           [&](std::size_t point) { return places[distinct.number[point]]; });
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
      ++read.noise.without_area;
      continue;
    }
    std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
    numbered.push_back(corners);
  }
  std::ranges::sort(numbered);
  read.surface = of_used_points(distinct.points, std::move(numbered));
  return read;
}
}  // namespace

SurfaceSource surface_source(std::string file, std::string bytes) {
  std::string sha256 = core::sha256(bytes);
  return {std::move(file), std::move(bytes), std::move(sha256), {}, {}};
}

std::string SurfaceNoise::describe() const {
  std::vector<std::string> parts;
  if (points > 0) {
    parts.push_back(fmt::format(
        "{} of its points differ from others by noise, at most {:.2g} of its size, and are joined "
        "to them",
        points, farthest));
  }
  if (without_area > 0) {
    parts.push_back(fmt::format(
        "{} of its triangles have two corners in one point and are left out", without_area));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

namespace {
ReadSurface read_with_fans(const SurfaceSource& source, double metres_per_unit,
                           std::string& uncut) {
  SurfaceSoup soup = soup_of(source);
  scale(soup, source.file, metres_per_unit);
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const auto& polygon : soup.polygons) {
    const auto cut = triangles_of(from_first_corner(polygon, soup), soup, uncut);
    triangles.insert(triangles.end(), cut.begin(), cut.end());
  }
  if (triangles.size() > most_read) {
    throw core::InvalidInput{
        fmt::format("{}: {} triangles (at most {})", source.file, triangles.size(), most_read)};
  }
  ReadSurface read = in_canonical_order(triangles, soup);
  if (read.surface.triangles.rows() == 0) {
    throw core::InvalidInput{source.file + ": no triangle of it has an area"};
  }
  return read;
}
}  // namespace

ReadSurface read_surface(const SurfaceSource& source, double metres_per_unit) {
  std::string uncut;
  ReadSurface read = read_with_fans(source, metres_per_unit, uncut);
  if (!uncut.empty()) {
    throw SurfaceFault{fmt::format("{}: {}", source.file, uncut)};
  }
  return read;
}

ReadSurface read_to_repair(const SurfaceSource& source, double metres_per_unit) {
  std::string uncut;
  return read_with_fans(source, metres_per_unit, uncut);
}
}  // namespace tapstudy::protocols
