#include "core/model/shape/shape.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <string_view>
#include <utility>

#include "core/sha256.hpp"
namespace tapstudy::core {
namespace {
template <class Matrix>
std::string_view bytes_of(const Matrix& matrix) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes, for their hash
  return {reinterpret_cast<const char*>(matrix.data()),
          sizeof(*matrix.data()) * static_cast<std::size_t>(matrix.size())};
}
}  // namespace

Solid::Solid(TriangleSurface surface) {
  std::string bytes{bytes_of(surface.points_m)};
  bytes += bytes_of(surface.triangles);
  sha256_ = core::sha256(bytes);
  triangles_ = std::make_shared<const TriangleTree>(std::move(surface));
}

Bounds bounds(const TriangleSurface& surface) {
  return {surface.points_m.colwise().minCoeff(), surface.points_m.colwise().maxCoeff()};
}

Bounds bounds(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) {
    return {box->low_m(), box->high_m()};
  }
  return bounds(std::get<Solid>(shape).surface());
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
  return box != nullptr ? box->size_m.prod() : volume_m3(std::get<Solid>(shape).surface());
}

std::string content_key(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) {
    return fmt::format("box({:a},{:a},{:a})", box->size_m.x(), box->size_m.y(), box->size_m.z());
  }
  const auto& solid = std::get<Solid>(shape);
  return fmt::format("surface({},{},{})", solid.surface().points_m.rows(),
                     solid.surface().triangles.rows(), solid.sha256());
}
}  // namespace tapstudy::core
