#include "protocols/surface/join_points.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
namespace tapstudy::protocols {
namespace {
using core::Vec3;
using PointNumbers = std::vector<std::size_t>;

double diagonal(const std::vector<Vec3>& points, PointNumbers::const_iterator begin,
                PointNumbers::const_iterator end) {
  Vec3 low = points[*begin];
  Vec3 high = low;
  for (auto number = begin; number != end; ++number) {
    low = low.cwiseMin(points[*number]);
    high = high.cwiseMax(points[*number]);
  }
  return (high - low).norm();
}

// Points in groups: `listed` has them group by group, `group` each point's group.
struct Grouped {
  PointNumbers listed;
  PointNumbers group;
  std::size_t groups{1};
};

// Parts each group wherever a gap along an axis is wider than the tolerance.
void part_at_gaps(const std::vector<Vec3>& points, int axis, double tolerance, Grouped& all) {
  std::ranges::sort(all.listed, {}, [&](std::size_t point) {
    return std::pair{all.group[point], points[point][axis]};
  });
  const PointNumbers before = all.group;
  std::size_t groups = 0;
  for (std::size_t i = 0; i < all.listed.size(); ++i) {
    const std::size_t point = all.listed[i];
    const bool is_first = i == 0 || before[point] != before[all.listed[i - 1]];
    const bool is_apart =
        is_first || points[point][axis] - points[all.listed[i - 1]][axis] > tolerance;
    groups += is_apart ? 1 : 0;
    all.group[point] = groups;
  }
  all.groups = groups;
}
}  // namespace

double size_of(const std::vector<Vec3>& points) {
  PointNumbers all(points.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return points.empty() ? 0.0 : diagonal(points, all.begin(), all.end());
}

std::vector<std::size_t> without_noise(const std::vector<Vec3>& points, double share_of_size) {
  constexpr int axes = 3;
  constexpr int most_rounds = 10 * axes;  // of points however placed; those of a body take three
  Grouped all{PointNumbers(points.size()), PointNumbers(points.size(), 0)};
  std::iota(all.listed.begin(), all.listed.end(), std::size_t{0});
  PointNumbers place = all.listed;
  const double tolerance = share_of_size * size_of(points);
  int without_change = 0;
  for (int round = 0; without_change < axes && round < most_rounds; ++round) {
    const std::size_t before = all.groups;
    part_at_gaps(points, round % axes, tolerance, all);
    without_change = all.groups == before ? without_change + 1 : 0;
  }
  for (auto begin = all.listed.begin(); begin != all.listed.end();) {
    const auto end = std::find_if(begin, all.listed.end(), [&](std::size_t point) {
      return all.group[point] != all.group[*begin];
    });
    if (diagonal(points, begin, end) <= tolerance) {
      const std::size_t first = *std::min_element(begin, end);
      std::for_each(begin, end, [&](std::size_t point) { place[point] = first; });
    }
    begin = end;
  }
  return place;
}
}  // namespace tapstudy::protocols
