#include "core/model/shape/shape.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "core/sha256.hpp"
namespace tapstudy::core {
Bounds bounds(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) {
    return {box->low_m(), box->high_m()};
  }
  const auto& points = std::get<TriangleSurface>(shape).points_m;
  return {points.colwise().minCoeff(), points.colwise().maxCoeff()};
}

// The sum of the tetrahedra from one point to every triangle (divergence theorem).
double volume_m3(const TriangleSurface& surface) {
  if (surface.triangles.rows() == 0) {
    return 0.0;
  }
  const Vec3 from = surface.points_m.row(0);
  double six_times = 0.0;
  for (const auto& triangle : surface.triangles.rowwise()) {
    const Vec3 a = surface.points_m.row(triangle[0]).transpose() - from;
    const Vec3 b = surface.points_m.row(triangle[1]).transpose() - from;
    const Vec3 c = surface.points_m.row(triangle[2]).transpose() - from;
    six_times += a.cross(b).dot(c);
  }
  return six_times / 6.0;
}

double volume_m3(const Shape& shape) {
  const auto* box = std::get_if<Box>(&shape);
  return box != nullptr ? box->size_m.prod() : volume_m3(std::get<TriangleSurface>(shape));
}

std::string content_key(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) {
    return fmt::format("box({:a},{:a},{:a})", box->size_m.x(), box->size_m.y(), box->size_m.z());
  }
  const auto& surface = std::get<TriangleSurface>(shape);
  const auto bytes_of = [](const auto& matrix) {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes, for their hash
    return std::string_view{reinterpret_cast<const char*>(matrix.data()),
                            sizeof(*matrix.data()) * static_cast<std::size_t>(matrix.size())};
  };
  std::string bytes{bytes_of(surface.points_m)};
  bytes += bytes_of(surface.triangles);
  return fmt::format("surface({},{},{})", surface.points_m.rows(), surface.triangles.rows(),
                     sha256(bytes));
}
}  // namespace tapstudy::core
