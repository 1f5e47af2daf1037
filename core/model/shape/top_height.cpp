#include "core/model/shape/top_height.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
namespace tapstudy::core {
namespace {
Eigen::Vector2d nearest_on_segment(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                   const Eigen::Vector2d& point) {
  const Eigen::Vector2d along = to - from;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0.0 ? (point - from).dot(along) / length2 : 0.0;
  return from + std::clamp(share, 0.0, 1.0) * along;
}

// Outside the shadow of a surface its nearest point lies on some triangle's edge.
Eigen::Vector2d nearest_on_outline(const TriangleSurface& surface, const Eigen::Vector2d& point) {
  Eigen::Vector2d nearest{HUGE_VAL, HUGE_VAL};
  double least = HUGE_VAL;
  for (Eigen::Index i = 0; i < surface.triangles.rows(); ++i) {
    for (Eigen::Index edge = 0; edge < 3; ++edge) {
      const auto corner = [&](Eigen::Index k) -> Eigen::Vector2d {
        return surface.points_m.row(surface.triangles(i, k % 3)).head<2>();
      };
      const Eigen::Vector2d on_edge = nearest_on_segment(corner(edge), corner(edge + 1), point);
      if ((on_edge - point).squaredNorm() < least) {
        least = (on_edge - point).squaredNorm();
        nearest = on_edge;
      }
    }
  }
  return nearest;
}
}  // namespace

std::string TopHeight::outline_words(const Eigen::Vector2d& sideways_m) const {
  if (triangles_) {
    const Eigen::Vector2d nearest = nearest_on_outline(triangles_->surface(), sideways_m);
    return fmt::format("seen from above its nearest place is ({:.4g}, {:.4g})", nearest.x(),
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
