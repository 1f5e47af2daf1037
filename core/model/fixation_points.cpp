#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/model/fixation.hpp"
namespace tapstudy::core {
namespace {
constexpr int rim_points = 8;

void add_on_faces(const Vec3& at_m, Face face, const Bounds& body, std::vector<Vec3>& points) {
  if (face != Face::bottom) {
    points.emplace_back(at_m.x(), at_m.y(), body.high_m.z());
  }
  if (face != Face::top) {
    points.emplace_back(at_m.x(), at_m.y(), body.low_m.z());
  }
}

void add_rim(const Fixation& disc, const Bounds& body, std::vector<Vec3>& points) {
  for (int i = 0; i < rim_points; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / rim_points;
    const Vec3 out{std::cos(angle), std::sin(angle), 0.0};
    add_on_faces(disc.at_m + disc.radius_m * out, disc.face, body, points);
  }
}

void add_corners(const Vec3& low_m, const Vec3& high_m, std::vector<Vec3>& points) {
  for (int corner = 0; corner < 8; ++corner) {
    points.emplace_back((corner & 1) == 0 ? low_m.x() : high_m.x(),
                        (corner & 2) == 0 ? low_m.y() : high_m.y(),
                        (corner & 4) == 0 ? low_m.z() : high_m.z());
  }
}

std::vector<Vec3> wanted_points(const Fixation& fixation, const Bounds& body) {
  std::vector<Vec3> points;
  switch (fixation.shape) {
    case RegionShape::disc:
      add_on_faces(fixation.at_m, fixation.face, body, points);
      add_rim(fixation, body, points);
      break;
    case RegionShape::vertex:
      add_on_faces(fixation.at_m, fixation.face, body, points);
      break;
    case RegionShape::box:
      add_corners(fixation.low_m.cwiseMax(body.low_m), fixation.high_m.cwiseMin(body.high_m),
                  points);
      break;
    case RegionShape::ball:
    case RegionShape::side:
      break;
  }
  return points;
}

// Snaps points within rounding of a face onto it.
Vec3 onto_faces(Vec3 point, const Bounds& body) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double face : {body.low_m[axis], body.high_m[axis]}) {
      if (std::abs(point[axis] - face) <= body.snap_m()) {
        point[axis] = face;
      }
    }
  }
  return point;
}

bool is_on_boundary(const Vec3& point, const Bounds& body) {
  const bool is_inside =
      ((point - body.low_m).array() >= 0.0).all() && ((body.high_m - point).array() >= 0.0).all();
  const bool touches =
      ((point - body.low_m).array() == 0.0).any() || ((body.high_m - point).array() == 0.0).any();
  return is_inside && touches;
}
}  // namespace

std::vector<Vec3> points_to_mesh(const std::vector<Fixation>& fixations, const Shape& shape) {
  std::vector<Vec3> points;
  if (!std::holds_alternative<Box>(shape)) {
    return points;
  }
  const Bounds body = bounds(shape);
  for (const Fixation& fixation : fixations) {
    for (const Vec3& wanted : wanted_points(fixation, body)) {
      const Vec3 point = onto_faces(wanted, body);
      if (is_on_boundary(point, body)) {
        points.push_back(point);
      }
    }
  }
  return points;
}
}  // namespace tapstudy::core
