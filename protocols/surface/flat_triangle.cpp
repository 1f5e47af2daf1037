#include "protocols/surface/flat_triangle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
namespace tapstudy::protocols {
namespace {
using core::Vec3;
constexpr double no_area = 1e-12;  // of a triangle, as a fraction of its longest side squared
constexpr double flat_cap = 1e-5;  // height over longest side, as rounding to float gives
constexpr double flat_cap_of_side = 1e-2;  // height over shortest side

struct Sides {
  Sides(const Vec3& a, const Vec3& b, const Vec3& c)
      : double_area{(b - a).cross(c - a).norm()},
        longest_squared{
            std::max({(b - a).squaredNorm(), (c - a).squaredNorm(), (c - b).squaredNorm()})},
        shortest_squared{
            std::min({(b - a).squaredNorm(), (c - a).squaredNorm(), (c - b).squaredNorm()})} {}
  double double_area;
  double longest_squared;
  double shortest_squared;
};
}  // namespace

bool has_no_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Sides sides{a, b, c};
  return !(sides.double_area > no_area * sides.longest_squared);
}

bool is_flat_cap(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Sides sides{a, b, c};
  const double longest = std::sqrt(sides.longest_squared);
  const double height = sides.double_area / longest;
  return height < flat_cap * longest &&
         height < flat_cap_of_side * std::sqrt(sides.shortest_squared);
}
}  // namespace tapstudy::protocols
