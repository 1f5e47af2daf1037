#pragma once
#include <memory>
#include <optional>
#include <string>

#include "core/geometry/triangle_tree.hpp"
#include "core/model/shape/shape.hpp"
namespace tapstudy::core {
// Where a finger descending along -z first touches a body.
class TopHeight {
 public:
  explicit TopHeight(const Shape& shape);
  // z in the plate frame; nullopt where the vertical line misses the body.
  std::optional<double> at_m(const Eigen::Vector2d& sideways_m) const;
  // What may be touched from above, for messages: a plate's extent, or the place on a body nearest
  // to a point that misses it.
  std::string outline_words(const Eigen::Vector2d& sideways_m) const;

 private:
  Bounds bounds_;
  std::shared_ptr<const TriangleTree> triangles_;  // none of a box
};
}  // namespace tapstudy::core
