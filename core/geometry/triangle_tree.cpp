#include "core/geometry/triangle_tree.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
namespace tapstudy::core {
namespace {
constexpr int leaf_size = 4;
using Point = TriangleTree::Point;

// Six times the signed volume of p, q, a, b, exactly antisymmetric in a and b, so that two
// triangles always agree on which side of their common edge a line passes.
double edge_volume(const Point& p, const Point& q, const Point& a, int a_index, const Point& b,
                   int b_index) noexcept {
  const bool is_forward = a_index < b_index;
  const Point& first = is_forward ? a : b;
  const Point& second = is_forward ? b : a;
  const double volume = (q - p).dot((first - p).cross(second - p));
  return is_forward ? volume : -volume;
}

// The nearest point of a triangle as barycentric coordinates (Ericson, Real-Time Collision
// Detection, section 5.1.5).
std::array<double, 3> nearest(const Point& p, const Point& a, const Point& b,
                              const Point& c) noexcept {
  const Point ab = b - a;
  const Point ac = c - a;
  const double d1 = ab.dot(p - a);
  const double d2 = ac.dot(p - a);
  if (d1 <= 0.0 && d2 <= 0.0) {
    return {1.0, 0.0, 0.0};
  }
  const double d3 = ab.dot(p - b);
  const double d4 = ac.dot(p - b);
  if (d3 >= 0.0 && d4 <= d3) {
    return {0.0, 1.0, 0.0};
  }
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double v = d1 / (d1 - d3);
    return {1.0 - v, v, 0.0};
  }
  const double d5 = ab.dot(p - c);
  const double d6 = ac.dot(p - c);
  if (d6 >= 0.0 && d5 <= d6) {
    return {0.0, 0.0, 1.0};
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double w = d2 / (d2 - d6);
    return {1.0 - w, 0.0, w};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0.0, 1.0 - w, w};
  }
  const double scale = 1.0 / (va + vb + vc);
  return {va * scale, vb * scale, vc * scale};
}
}  // namespace

TriangleTree::TriangleTree(TriangleSurface surface) : surface_{std::move(surface)} {
  const Eigen::Index count = surface_.triangles.rows();
  normals_.resize(count, 3);
  centres_.resize(count, 3);
  for (int i = 0; i < count; ++i) {
    const Point a = corner(i, 0);
    normals_.row(i) = (corner(i, 1) - a).cross(corner(i, 2) - a).normalized();
    centres_.row(i) = (a + corner(i, 1) + corner(i, 2)) / 3.0;
  }
  smooth_.emplace(surface_, normals_);
  order_.resize(static_cast<std::size_t>(count));
  std::iota(order_.begin(), order_.end(), 0);
  build(0, static_cast<int>(count));
}

Point TriangleTree::corner(int triangle, int i) const noexcept {
  return surface_.points_m.row(surface_.triangles(triangle, i));
}

// Splits at the median centroid along the axis of largest extent: the depth is logarithmic in the
// number of triangles for any geometry.
int TriangleTree::build(int first, int count) {
  const int number = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  const auto begin = order_.begin() + first;
  Eigen::AlignedBox3d box;
  Eigen::AlignedBox3d middles;
  for (auto it = begin; it != begin + count; ++it) {
    for (int i = 0; i < 3; ++i) {
      box.extend(corner(*it, i));
    }
    middles.extend(Point{centres_.row(*it)});
  }
  Node node{box.center(), 0.5 * box.sizes(), first, count};
  if (count > leaf_size) {
    Eigen::Index axis{};
    middles.sizes().maxCoeff(&axis);
    std::nth_element(begin, begin + count / 2, begin + count, [&](int a, int b) {
      return std::pair{centres_(a, axis), a} < std::pair{centres_(b, axis), b};
    });
    build(first, count / 2);
    node.first = build(first + count / 2, count - count / 2);
    node.count = 0;
  }
  nodes_[static_cast<std::size_t>(number)] = node;
  return number;
}

// Separating-axis test of a segment and a box, division-free, so no infinities or NaN arise. The
// small tolerance keeps rounding errors conservative.
bool TriangleTree::touches(const Node& node, const Segment& segment) noexcept {
  const Point apart = (segment.middle - node.middle).cwiseAbs();
  const Point reach = segment.half.cwiseAbs();
  const double hair = 1e-12 * (node.half.sum() + reach.sum() + node.middle.cwiseAbs().sum());
  if (((apart - node.half - reach).array() > hair).any()) {
    return false;
  }
  const Point d = segment.half;
  const Point c = segment.middle - node.middle;
  const Point& h = node.half;
  const double slack = hair * reach.sum();
  return std::abs(c.y() * d.z() - c.z() * d.y()) <= h.y() * reach.z() + h.z() * reach.y() + slack &&
         std::abs(c.z() * d.x() - c.x() * d.z()) <= h.z() * reach.x() + h.x() * reach.z() + slack &&
         std::abs(c.x() * d.y() - c.y() * d.x()) <= h.x() * reach.y() + h.y() * reach.x() + slack;
}

// Whether the line through the segment passes all three edges on the same side.
bool TriangleTree::is_crossed(int triangle, const Point& from, const Point& to) const noexcept {
  std::array<double, 3> volumes{};
  for (int i = 0; i < 3; ++i) {
    const int a = surface_.triangles(triangle, i);
    const int b = surface_.triangles(triangle, (i + 1) % 3);
    volumes[static_cast<std::size_t>(i)] =
        edge_volume(from, to, surface_.points_m.row(a), a, surface_.points_m.row(b), b);
  }
  return (volumes[0] >= 0.0 && volumes[1] >= 0.0 && volumes[2] >= 0.0) ||
         (volumes[0] <= 0.0 && volumes[1] <= 0.0 && volumes[2] <= 0.0);
}

TriangleTree::Entry TriangleTree::first_entered(const Point& from, const Point& to,
                                                double skin) const noexcept {
  Entry first;
  const Segment segment{from, to};
  const auto is_on_the_way = [&](const Node& node) { return touches(node, segment); };
  walk(is_on_the_way, [&](int triangle) {
    const Point n = normal(triangle);
    const Point a = corner(triangle, 0);
    const double start = n.dot(from - a);
    const double end = n.dot(to - a);
    if (start < -skin || end >= 0.0 || end >= start || !is_crossed(triangle, from, to)) {
      return;
    }
    const double along = std::clamp(start / (start - end), 0.0, 1.0);
    if (first.triangle == none || along < first.along) {
      first = {triangle, along};
    }
  });
  return first;
}

bool TriangleTree::is_near(const Point& point, double distance) const noexcept {
  bool found = false;
  walk(
      [&](const Node& node) {
        const Point outside = ((point - node.middle).cwiseAbs() - node.half).cwiseMax(0.0);
        return !found && outside.norm() <= distance;
      },
      [&](int triangle) {
        const auto weights = barycentric(triangle, point);
        const Point at = weights[0] * corner(triangle, 0) + weights[1] * corner(triangle, 1) +
                         weights[2] * corner(triangle, 2);
        found = found || (at - point).norm() <= distance;
      });
  return found;
}

std::array<double, 3> TriangleTree::barycentric(int triangle, const Point& point) const noexcept {
  return nearest(point, corner(triangle, 0), corner(triangle, 1), corner(triangle, 2));
}
}  // namespace tapstudy::core
