#include "core/tick/god_object.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
namespace tapstudy::core {
namespace {
// A point on the edge stays there through the placement's arithmetic.
constexpr double rounding_m = 1e-9;
}  // namespace

const Contact& PlateContact::tick(const HandState& tip) noexcept {
  const Vec3& at = tip.position_m;
  const bool was_above = history_.has_tip && history_.tip_m.z() >= 0.0;
  const bool is_over = std::abs(at.x()) <= face_.half_x_m + rounding_m &&
                       std::abs(at.y()) <= face_.half_y_m + rounding_m;
  const bool is_below = at.z() < 0.0;
  const bool enters = !contact_.touching && was_above && is_below && is_over;
  contact_.touching = (contact_.touching || enters) && is_below && is_over;
  contact_.impact = enters && history_.impact_armed;
  contact_.impact_speed_m_s = contact_.impact ? std::max(0.0, -tip.velocity_m_s.z()) : 0.0;
  contact_.penetration_m = contact_.touching ? -at.z() : 0.0;
  contact_.normal_velocity_m_s = contact_.touching ? tip.velocity_m_s.z() : 0.0;
  contact_.god_object_m = contact_.touching ? Vec3{at.x(), at.y(), 0.0} : at;
  history_.impact_armed = !contact_.impact && (history_.impact_armed || at.z() > release_height_m_);
  history_.tip_m = at;
  history_.has_tip = true;
  return contact_;
}

void PlateContact::continue_from(const ContactHistory& history) noexcept {
  contact_ = {};
  history_ = history;
}

namespace {
constexpr double skin_per_diagonal = 1e-9;
// Maximum number of active-set restarts per tick. The motion not completed in this tick is
// completed in the next.
constexpr int max_rounds = 8;
constexpr double parallel = 1e-12;  // Gram determinant below which planes count as parallel
}  // namespace

SurfaceContact::SurfaceContact(const TriangleTree& tree, double release_height_m) noexcept
    : tree_{&tree}, release_height_m_{release_height_m} {
  const auto& points = tree.surface().points_m;
  const Vec3 size = points.colwise().maxCoeff() - points.colwise().minCoeff();
  skin_m_ = skin_per_diagonal * size.norm();
}

const Contact& SurfaceContact::tick(const HandState& tip) noexcept {
  const Vec3& at = tip.position_m;
  if (!history_.has_tip) {
    god_object_m_ = at;
  }
  const Planes planes = move_towards(at);
  describe(planes, tip);
  if (!contact_.touching && !history_.impact_armed) {
    history_.impact_armed = !tree_->is_near(at, release_height_m_);
  }
  history_.tip_m = at;
  history_.has_tip = true;
  return contact_;
}

SurfaceContact::Planes SurfaceContact::move_towards(const Vec3& tip_m) noexcept {
  Planes planes;
  for (int round = 0; round < max_rounds; ++round) {
    const Vec3 before = god_object_m_;
    planes = slide_towards(tip_m);
    if (planes.count == 0 || (god_object_m_ - before).norm() <= skin_m_) {
      break;
    }
  }
  return planes;
}

// Moves straight to the tip, or along the constraint planes hit on the way.
SurfaceContact::Planes SurfaceContact::slide_towards(const Vec3& tip_m) noexcept {
  Planes planes;
  std::optional<Vec3> goal = tip_m;
  while (goal) {
    const auto entry = tree_->first_entered(god_object_m_, *goal, skin_m_);
    if (entry.triangle == TriangleTree::none) {
      god_object_m_ = *goal;
      break;
    }
    const Plane met = plane_of(entry.triangle);
    // stops where the path meets the plane's offset (skin)
    const double start = met.normal.dot(god_object_m_) - met.offset;
    const double end = met.normal.dot(*goal) - met.offset;
    const double along = start > 0.0 ? std::min(1.0, start / (start - end)) : 0.0;
    god_object_m_ += along * (*goal - god_object_m_);
    if (planes.count == planes.held.size()) {
      break;
    }
    planes.held[planes.count++] = met;
    goal = nearest_allowed(planes, tip_m);
  }
  return planes;
}

SurfaceContact::Plane SurfaceContact::plane_of(int triangle) const noexcept {
  const Vec3 normal = tree_->normal(triangle);
  const Vec3 corner = tree_->surface().points_m.row(tree_->surface().triangles(triangle, 0));
  return {normal, normal.dot(corner) + skin_m_, triangle};
}

bool SurfaceContact::allow(const Planes& planes, const Vec3& point_m) const noexcept {
  return std::all_of(planes.held.begin(), planes.held.begin() + planes.count,
                     [&](const Plane& plane) {
                       return plane.normal.dot(point_m) >= plane.offset - 1e-3 * skin_m_;
                     });
}

// The nearest point satisfying all constraints, by enumerating every possible active set.
std::optional<Vec3> SurfaceContact::nearest_allowed(const Planes& planes,
                                                    const Vec3& wanted_m) const noexcept {
  std::optional<Vec3> nearest;
  for (unsigned choice = 0; choice < (1U << planes.count); ++choice) {
    const std::optional<Vec3> candidate = nearest_on(planes, choice, wanted_m);
    if (candidate && allow(planes, *candidate) &&
        (!nearest || (*candidate - wanted_m).norm() < (*nearest - wanted_m).norm())) {
      nearest = candidate;
    }
  }
  return nearest;
}

// The nearest point on all planes of the active set (bit i: plane i); nullopt if parallel.
std::optional<Vec3> SurfaceContact::nearest_on(const Planes& planes, unsigned choice,
                                               const Vec3& wanted_m) noexcept {
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d gram = Eigen::Matrix3d::Identity();  // identity for inactive planes
  Vec3 missing = Vec3::Zero();
  for (std::size_t i = 0; i < planes.count; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if ((choice >> i & 1U) != 0) {
      normals.row(row) = planes.held[i].normal;
      missing[row] = planes.held[i].offset - planes.held[i].normal.dot(wanted_m);
      gram(row, row) = 0.0;
    }
  }
  gram += normals * normals.transpose();
  if (gram.determinant() < parallel) {
    return std::nullopt;
  }
  return wanted_m + normals.transpose() * gram.ldlt().solve(missing);
}

// The shaded force is not exactly the gradient of an energy: on a closed path it may do work, less
// than 0.5 % of force times path where facets turn by 0.2 rad or less
// (tests/core/tick/god_object_test.cpp).
void SurfaceContact::shade(const Planes& planes, const Vec3& tip_m) noexcept {
  const bool is_flat =
      std::all_of(planes.held.begin(), planes.held.begin() + planes.count,
                  [&](const Plane& plane) { return tree_->is_flat(plane.triangle); });
  if (is_flat) {
    return;
  }
  const auto foot = tree_->foot_of(tip_m, contact_.triangle);
  if (!foot || foot->depth_m < 0.0 || (foot->is_at_sharp_edge && planes.count > 1)) {
    return;
  }
  contact_.god_object_m = foot->place_m + skin_m_ * foot->normal;
  contact_.normal = foot->normal;
  contact_.penetration_m = foot->depth_m;
  contact_.triangle = foot->triangle;
  contact_.barycentric = foot->barycentric;
}

void SurfaceContact::describe(const Planes& planes, const HandState& tip) noexcept {
  const bool was_touching = contact_.touching;
  contact_ = {};
  contact_.god_object_m = god_object_m_;
  if (planes.count == 0) {
    return;
  }
  const Vec3 push = god_object_m_ - tip.position_m;
  const double depth = push.norm();
  contact_.touching = true;
  contact_.penetration_m = std::max(0.0, depth - skin_m_);
  contact_.normal = depth > 2.0 * skin_m_ ? Vec3{push / depth} : planes.held[0].normal;
  const auto* const main = std::max_element(
      planes.held.begin(), planes.held.begin() + planes.count, [&](const Plane& a, const Plane& b) {
        return a.normal.dot(contact_.normal) < b.normal.dot(contact_.normal);
      });
  contact_.triangle = main->triangle;
  contact_.barycentric = tree_->barycentric(main->triangle, god_object_m_);
  shade(planes, tip.position_m);
  contact_.normal_velocity_m_s = contact_.normal.dot(tip.velocity_m_s);
  contact_.impact = !was_touching && history_.impact_armed;
  if (contact_.impact) {
    contact_.impact_speed_m_s = std::max(0.0, -main->normal.dot(tip.velocity_m_s));
    history_.impact_armed = false;
  }
}

void SurfaceContact::continue_from(const ContactHistory& history) noexcept {
  contact_ = {};
  history_ = history;
  god_object_m_ = history.tip_m;
}
}  // namespace tapstudy::core
