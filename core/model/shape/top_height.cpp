#include "core/model/shape/top_height.hpp"
namespace tapstudy::core {
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
