#include "core/model/shape/shape.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/files/sha256.hpp"
namespace tapstudy::core {
namespace {
template <class Matrix>
std::string_view bytes_of(const Matrix& matrix) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes, for their hash
  return {reinterpret_cast<const char*>(matrix.data()),
          sizeof(*matrix.data()) * static_cast<std::size_t>(matrix.size())};
}
}  // namespace

Solid::Solid(TriangleSurface surface, std::string simplified_by)
    : simplified_by_{std::move(simplified_by)} {
  std::string bytes{bytes_of(surface.points_m)};
  bytes += bytes_of(surface.triangles);
  sha256_ = core::sha256(bytes);
  triangles_ = std::make_shared<const TriangleTree>(std::move(surface));
}

Solid::Solid(TriangleSurface faces, Sheet sheet) : Solid{std::move(faces)} {
  sha256_ = core::sha256(
      fmt::format("{} {} {:a}", sha256_, bytes_of(sheet.middle.points_m), sheet.thickness_m));
  sheet_ = std::make_shared<const Sheet>(std::move(sheet));
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

namespace {
Eigen::Vector2d nearest_on_segment(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                   const Eigen::Vector2d& point) {
  const Eigen::Vector2d along = to - from;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0.0 ? (point - from).dot(along) / length2 : 0.0;
  return from + std::clamp(share, 0.0, 1.0) * along;
}

using ShadowCorners = std::array<Eigen::Vector2d, 3>;

ShadowCorners shadow_of(const TriangleSurface& surface, Eigen::Index triangle) {
  ShadowCorners corners;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    corners.at(k) =
        surface.points_m.row(surface.triangles(triangle, static_cast<Eigen::Index>(k))).head<2>();
  }
  return corners;
}

bool is_upright(const ShadowCorners& shadow) {
  constexpr double no_area = 1e-6;
  const Eigen::Vector2d a = shadow[1] - shadow[0];
  const Eigen::Vector2d b = shadow[2] - shadow[0];
  return !(std::abs(a.x() * b.y() - a.y() * b.x()) >
           no_area * std::max(a.squaredNorm(), b.squaredNorm()));
}

// Outside the shadow of a surface its nearest point lies on some triangle's edge; a little further
// in, so that it is in the shadow with the digits that are printed, too.
Eigen::Vector2d nearest_in_shadow(const TriangleSurface& surface, const Eigen::Vector2d& point) {
  constexpr double inward = 0.05;
  Eigen::Vector2d nearest{HUGE_VAL, HUGE_VAL};
  double least = HUGE_VAL;
  for (Eigen::Index i = 0; i < surface.triangles.rows(); ++i) {
    const ShadowCorners shadow = shadow_of(surface, i);
    for (std::size_t k = 0; !is_upright(shadow) && k < shadow.size(); ++k) {
      const Eigen::Vector2d on_edge =
          nearest_on_segment(shadow.at(k), shadow.at((k + 1) % shadow.size()), point);
      if ((on_edge - point).squaredNorm() < least) {
        least = (on_edge - point).squaredNorm();
        const Eigen::Vector2d centre = (shadow[0] + shadow[1] + shadow[2]) / 3.0;
        nearest = on_edge + inward * (centre - on_edge);
      }
    }
  }
  return nearest;
}
}  // namespace

std::string TopHeight::describe_touchable(const Eigen::Vector2d& sideways_m) const {
  if (triangles_) {
    const Eigen::Vector2d nearest = nearest_in_shadow(triangles_->surface(), sideways_m);
    return fmt::format("seen from above its nearest place is ({:.6g}, {:.6g})", nearest.x(),
                       nearest.y());
  }
  return fmt::format("x from {:.4g} to {:.4g} m, y from {:.4g} to {:.4g} m", bounds_.low_m.x(),
                     bounds_.high_m.x(), bounds_.low_m.y(), bounds_.high_m.y());
}

TopHeight::TopHeight(const Shape& shape) : bounds_{bounds(shape)} {
  if (const auto* solid = std::get_if<Solid>(&shape)) {
    triangles_ = solid->triangles();
  }
}

std::optional<double> TopHeight::at_m(const Eigen::Vector2d& sideways_m) const {
  const bool is_over = (sideways_m.array() >= bounds_.low_m.head<2>().array()).all() &&
                       (sideways_m.array() <= bounds_.high_m.head<2>().array()).all();
  if (!is_over) {
    return std::nullopt;
  }
  if (!triangles_) {
    return bounds_.high_m.z();
  }
  const double margin = bounds_.size_m().norm();
  const Vec3 above{sideways_m.x(), sideways_m.y(), bounds_.high_m.z() + margin};
  const Vec3 below{sideways_m.x(), sideways_m.y(), bounds_.low_m.z() - margin};
  const auto entry = triangles_->first_entered(above, below, 0.0);
  if (entry.triangle == TriangleTree::none) {
    return std::nullopt;
  }
  return above.z() + entry.along * (below.z() - above.z());
}
}  // namespace tapstudy::core
