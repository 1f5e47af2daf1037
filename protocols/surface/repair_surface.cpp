#include "protocols/surface/repair_surface.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/model/mesh/wanted_order.hpp"
#include "core/model/shape/shape.hpp"
#include "protocols/surface/check_surface.hpp"
#include "protocols/surface/join_points.hpp"
#include "protocols/surface/surface_file.hpp"
#include "protocols/surface/surface_points.hpp"
#include "protocols/surface/wrap_surface.hpp"
namespace tapstudy::protocols {
namespace {
using core::TriangleSurface;
using core::Vec3;

Vec3 corner_m(const TriangleSurface& surface, Eigen::Index triangle, Eigen::Index corner) {
  return surface.points_m.row(surface.triangles(triangle, corner));
}

double size_m(const TriangleSurface& surface) {
  return core::bounds(surface).size_m().norm();
}

struct Refusal {
  std::string why;
  bool is_of_pieces{false};
};

// Unset: the surface is not refused.
std::optional<Refusal> refusal_of(const TriangleSurface& surface) {
  try {
    check_surface(surface);
    return std::nullopt;
  } catch (const SeveralPieces& fault) {
    return Refusal{fault.what(), true};
  } catch (const SurfaceFault& fault) {
    return Refusal{fault.what()};
  }
}

// As it will be read.
TriangleSurface reread(const TriangleSurface& surface) {
  return read_surface(surface_source("repaired.ply", ply_text(surface)), 1.0).surface;
}

TriangleSurface with_corners_joined(TriangleSurface surface, double share, int& joined) {
  std::vector<Vec3> points;
  for (const auto& p : surface.points_m.rowwise()) {
    points.emplace_back(p.transpose());
  }
  const std::vector<std::size_t> places = without_noise(points, share);
  for (std::size_t i = 0; i < places.size(); ++i) {
    joined += places[i] == i ? 0 : 1;
  }
  for (int& corner : surface.triangles.reshaped()) {
    corner = static_cast<int>(places[static_cast<std::size_t>(corner)]);
  }
  return surface;
}

using Corner = std::array<double, 3>;
using Triangle = std::array<Corner, 3>;

// By its corners' coordinates, from the first of them on.
Triangle directed(const TriangleSurface& surface, Eigen::Index row) {
  Triangle triangle{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 at_m = corner_m(surface, row, static_cast<Eigen::Index>(k));
    triangle.at(k) = {at_m.x(), at_m.y(), at_m.z()};
  }
  std::rotate(triangle.begin(), std::ranges::min_element(triangle), triangle.end());
  return triangle;
}

void count_changes(const TriangleSurface& before, SurfaceRepair& repair) {
  std::multiset<Triangle> old;
  for (Eigen::Index i = 0; i < before.triangles.rows(); ++i) {
    old.insert(directed(before, i));
  }
  const auto take = [&](const Triangle& triangle) {
    const auto found = old.find(triangle);
    if (found == old.end()) {
      return false;
    }
    old.erase(found);
    return true;
  };
  for (Eigen::Index i = 0; i < repair.surface.triangles.rows(); ++i) {
    Triangle triangle = directed(repair.surface, i);
    if (take(triangle)) {
      ++repair.kept;
      continue;
    }
    std::swap(triangle[1], triangle[2]);
    ++(take(triangle) ? repair.turned : repair.added);
  }
  repair.dropped = static_cast<int>(old.size());
}

double distance_m(const core::TriangleTree& tree, const Vec3& point, double at_least_m,
                  double at_most_m) {
  constexpr int halvings = 40;
  for (int i = 0; i < halvings; ++i) {
    const double middle_m = 0.5 * (at_least_m + at_most_m);
    (tree.is_near(point, middle_m) ? at_most_m : at_least_m) = middle_m;
  }
  return at_most_m;
}

// Of points no further apart than a fiftieth of the size, corners and centres among them.
double farthest_m(const TriangleSurface& from, const TriangleSurface& to) {
  constexpr double points_along = 50.0;
  const core::TriangleTree tree{parted(to)};
  const double whole_m = size_m(from) + size_m(to);
  const double apart_m = size_m(from) / points_along;
  const double rounding_m = 1e-12 * whole_m;
  double farthest = 0.0;
  const auto visit = [&](const Vec3& point) {
    if (!tree.is_near(point, farthest + rounding_m)) {
      farthest = distance_m(tree, point, farthest, 2.0 * whole_m);
    }
    return true;
  };
  visit_points(from, apart_m, visit);
  return farthest;
}

bool is_closed(const TriangleSurface& surface) {
  std::map<std::pair<int, int>, int> surplus;
  for (const auto& t : surface.triangles.rowwise()) {
    for (int k = 0; k < 3; ++k) {
      const int from = t[k];
      const int to = t[(k + 1) % 3];
      surplus[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  }
  return std::ranges::all_of(surplus, [](const auto& edge) { return edge.second == 0; });
}

[[noreturn]] void refuse(const Refusal& refusal, const SurfaceRepair& repair, double hole_m,
                         const RepairRequest& request, double wrap_m) {
  const RepairTerms& terms = *request.terms;
  std::string advice;
  if (repair.holes.longest_m > hole_m) {
    advice = filling(terms, repair.holes.longest_m) + " fills its longest hole, or ";
  }
  if (refusal.is_of_pieces) {
    advice += fmt::format("{} keeps one, or ", terms.largest_piece);
  }
  throw SurfaceFault{fmt::format(
      "{}, also once it is repaired{} (try: {}{}{}{:.2g}, a new surface around all of it that "
      "bridges this many metres)",
      refusal.why, terms.without_result, advice, terms.wrap, terms.before_number, wrap_m)};
}

// Whether a wrap is mostly its own offset, as around a sheet: about twice that thick, and on
// average up to eight times where some of it is solid.
bool is_skin(const TriangleSurface& wrap, double offset_m) {
  constexpr double thickest = 8.0;  // in offsets
  return core::volume_m3(wrap) < 0.5 * thickest * offset_m * area_m2(wrap);
}

// In place of what does not pass; in one piece, if that is asked for.
void wrap(const TriangleSurface& surface, const RepairRequest& request, SurfaceRepair& repair) {
  const double wrap_m = request.wrap_m.value();
  repair.wrap_offset_m = wrap_offset_share * wrap_m;
  repair.surface = wrapped(surface, wrap_m, *repair.wrap_offset_m);
  if (is_skin(repair.surface, *repair.wrap_offset_m)) {
    repair.wrap_offset_m = skin_offset_share * wrap_m;
    repair.surface = wrapped(surface, wrap_m, *repair.wrap_offset_m);
  }
  const auto refusal = refusal_of(repair.surface);
  if (request.is_largest_piece_only && refusal && refusal->is_of_pieces) {
    const MendedSurface one = mended(repair.surface, {0.0, true, 0.0});
    repair.surface = one.surface;
    repair.pieces_dropped += one.pieces_dropped;
  }
}

// Of a wrap of a surface whose longest hole stayed open.
std::optional<EnteredHole> entered_hole(const TriangleSurface& surface,
                                        const RepairRequest& request, double around_m,
                                        const TriangleSurface& wrap) {
  constexpr double clearly = 1.05;
  const MendedSurface filled =
      mended(surface, {std::numeric_limits<double>::max(), request.is_largest_piece_only,
                       request.wrap_m.value_or(0.0)});
  const double filled_m3 = core::volume_m3(filled.surface);
  const bool is_less = core::volume_m3(wrap) * clearly < filled_m3;
  return filled.holes.left == 0 && is_less ? std::optional{EnteredHole{around_m, filled_m3}}
                                           : std::nullopt;
}

// Reaches what passes check_surface, or refuses.
void close(const TriangleSurface& joined, const RepairRequest& request, SurfaceRepair& repair) {
  const double hole_m = request.longest_hole_m.value_or(size_m(joined));
  MendedSurface mended_surface =
      mended(joined, {hole_m, request.is_largest_piece_only, request.wrap_m.value_or(0.0)});
  repair.holes = mended_surface.holes;
  repair.pieces_dropped = mended_surface.pieces_dropped;
  std::optional<Refusal> refusal;
  try {
    repair.surface = reread(mended_surface.surface);
    refusal = refusal_of(repair.surface);
  } catch (const core::InvalidInput& error) {
    refusal = Refusal{error.what()};
  }
  if (!refusal) {
    return;
  }
  if (!request.wrap_m) {
    refuse(*refusal, repair, hole_m, request, advised_wrap_m(joined));
  }
  const double longest_m = repair.holes.longest_m;
  const bool is_mended = mended_surface.pieces_dropped > 0;
  if (!is_mended) {
    repair.holes = {};
  }
  wrap(is_mended ? mended_surface.surface : joined, request, repair);
  if (longest_m > hole_m) {
    repair.entered = entered_hole(joined, request, longest_m, repair.surface);
  }
}

// The first of these numbers of triangles whose surface passes check_surface; else that of the
// first number. Fewer triangles run through each other at other places.
TriangleSurface simplified_to(const TriangleSurface& surface, int max_triangles) {
  constexpr std::array shares{1.0, 0.85, 0.7};
  TriangleSurface first;
  for (const double share : shares) {
    TriangleSurface fewer =
        reread(simplified(surface, static_cast<int>(share * static_cast<double>(max_triangles))));
    if (!refusal_of(fewer)) {
      return fewer;
    }
    first = first.triangles.rows() == 0 ? std::move(fewer) : std::move(first);
  }
  return first;
}

void simplify(const RepairRequest& request, SurfaceRepair& repair) {
  if (request.max_triangles && repair.surface.triangles.rows() > *request.max_triangles) {
    repair.surface = simplified_to(repair.surface, *request.max_triangles);
  }
}

bool can_be_modelled(const TriangleSurface& surface) {
  return !refusal_of(surface) && core::can_be_meshed(core::Solid{surface});
}

[[noreturn]] void refuse_result(const std::string& why, const RepairRequest& request) {
  const RepairTerms& terms = *request.terms;
  const std::string advice =
      request.max_triangles ? fmt::format("a larger {}", terms.max_triangles)
                            : fmt::format("another {}, or {}", terms.wrap, terms.largest_piece);
  throw SurfaceFault{fmt::format("{}, once it is {}{} (try {})", why,
                                 request.max_triangles ? "simplified" : "wrapped",
                                 terms.without_result, advice)};
}
}  // namespace

SurfaceRepair repair_surface(const TriangleSurface& surface, const RepairRequest& request) {
  SurfaceRepair repair;
  TriangleSurface joined = surface;
  if (!refusal_of(surface)) {
    repair.surface = surface;
  } else {
    joined = with_corners_joined(surface, request.join_share, repair.corners_joined);
    close(joined, request, repair);
  }
  simplify(request, repair);
  if (request.wrap_m && !repair.wrap_offset_m && !can_be_modelled(repair.surface)) {
    wrap(repair.surface, request, repair);
    simplify(request, repair);
  }
  repair.surface = reread(repair.surface);
  check_count(repair.surface);
  if (const auto refusal = refusal_of(repair.surface)) {
    refuse_result(refusal->why, request);
  }
  count_changes(joined, repair);
  repair.area_before_m2 = area_m2(surface);
  if (is_closed(surface)) {
    repair.volume_before_m3 = core::volume_m3(surface);
  }
  repair.farthest_from_old_m = farthest_m(repair.surface, surface);
  repair.farthest_from_new_m = farthest_m(surface, repair.surface);
  return repair;
}

namespace {
std::string describe_holes(const Holes& holes) {
  return holes.filled == 0
             ? std::string{"holes filled: 0"}
             : fmt::format(
                   "holes filled: {}, the largest {:.4g} m round, at ({:.4g}, {:.4g}, "
                   "{:.4g}) m",
                   holes.filled, holes.longest_m, holes.at_m[0], holes.at_m[1], holes.at_m[2]);
}

constexpr double notable_share = 0.01;  // of the volume

// A layer as thick as the wrap's offset, all over; of no skin, which is nothing but that.
std::optional<double> larger_by_wrap(const SurfaceRepair& repair) {
  const double volume_m3 = core::volume_m3(repair.surface);
  const double layer_m3 = repair.wrap_offset_m.value_or(0.0) * area_m2(repair.surface);
  return repair.wrap_offset_m && !is_skin(repair.surface, *repair.wrap_offset_m)
             ? std::optional{layer_m3 / (volume_m3 - layer_m3)}
             : std::nullopt;
}

bool is_about(double volume_m3, double before_m3) {
  return std::abs(volume_m3 - before_m3) <= notable_share * std::abs(before_m3);
}
}  // namespace

std::vector<std::string> describe_changes(const SurfaceRepair& repair,
                                          const RepairRequest& request) {
  std::vector<std::string> lines{
      fmt::format("corners joined: {} (no further apart than {:.2g} of the size)",
                  repair.corners_joined, request.join_share),
      describe_holes(repair.holes)};
  if (request.is_largest_piece_only) {
    lines.push_back(fmt::format("pieces dropped: {}", repair.pieces_dropped));
  }
  if (request.wrap_m) {
    lines.push_back(repair.wrap_offset_m
                        ? fmt::format("wrapped: gaps up to {:.3g} m are bridged, the surface lies "
                                      "{:.3g} m outside",
                                      *request.wrap_m, *repair.wrap_offset_m)
                        : std::string{"not wrapped: that was not needed"});
  }
  if (const auto larger = larger_by_wrap(repair); larger && *larger > notable_share) {
    lines.push_back(fmt::format(
        "warning: that makes the body {:.2g} % larger, and as much thicker where it is thin: its "
        "frequencies are others (a smaller {} changes less)",
        100.0 * *larger, request.terms->wrap));
  }
  if (repair.entered) {
    lines.push_back(fmt::format(
        "warning: the wrap goes inside by a hole {:.4g} m round, larger than the {:.3g} m that it "
        "bridges: with its holes filled the surface encloses {:.4g} m³ ({} fills them; a "
        "wrap is right for an open sheet)",
        repair.entered->around_m, request.wrap_m.value(), repair.entered->filled_m3,
        filling(*request.terms, repair.entered->around_m)));
  } else if (repair.wrap_offset_m && is_skin(repair.surface, *repair.wrap_offset_m)) {
    lines.push_back(fmt::format(
        "warning: the result is a skin about {:.2g} m thick along the triangles, hollow inside: "
        "right for an open sheet; where a solid body was meant, its gaps are wider than what the "
        "wrap bridges (try a larger {})",
        2.0 * core::volume_m3(repair.surface) / area_m2(repair.surface), request.terms->wrap));
  }
  lines.push_back(fmt::format("triangles: {} kept, {} turned, {} dropped, {} added", repair.kept,
                              repair.turned, repair.dropped, repair.added));
  lines.push_back(fmt::format("volume: {:.6g} m³ (before: {}), area: {:.6g} m² (before: {:.6g})",
                              core::volume_m3(repair.surface),
                              repair.volume_before_m3
                                  ? fmt::format("{:.6g}", *repair.volume_before_m3)
                                  : std::string{"none, it was open or not oriented"},
                              area_m2(repair.surface), repair.area_before_m2));
  if (repair.volume_before_m3 &&
      !is_about(core::volume_m3(repair.surface), *repair.volume_before_m3)) {
    lines.push_back(fmt::format(
        "warning: it encloses {:.3g} times what it did: it is another body, with another mass",
        core::volume_m3(repair.surface) / *repair.volume_before_m3));
  }
  lines.push_back(fmt::format(
      "largest distance at sampled points: {:.3g} m from the surface before, and of that {:.3g} m "
      "from this one",
      repair.farthest_from_old_m, repair.farthest_from_new_m));
  return lines;
}

std::optional<double> unfilled_hole_m(const TriangleSurface& surface) {
  int joined = 0;
  try {
    const Holes holes =
        mended(with_corners_joined(surface, RepairRequest{}.join_share, joined), {0.0, false, 0.0})
            .holes;
    return holes.longest_m > size_m(surface) ? std::optional{holes.longest_m} : std::nullopt;
  } catch (const core::ModelError&) {
    return std::nullopt;
  }
}

std::string filling(const RepairTerms& terms, double around_m) {
  return fmt::format("{}{}{:.3g}", terms.longest_hole, terms.before_number, 1.01 * around_m);
}

double advised_wrap_m(const TriangleSurface& surface) {
  return size_m(surface) / 50.0;
}

double area_m2(const TriangleSurface& surface) {
  double area = 0.0;
  for (Eigen::Index i = 0; i < surface.triangles.rows(); ++i) {
    const Vec3 a = corner_m(surface, i, 0);
    area += 0.5 * (corner_m(surface, i, 1) - a).cross(corner_m(surface, i, 2) - a).norm();
  }
  return area;
}

std::string ply_text(const TriangleSurface& surface) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
      "property double z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      surface.points_m.rows(), surface.triangles.rows());
  for (const auto& p : surface.points_m.rowwise()) {
    text += fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
  }
  for (const auto& t : surface.triangles.rowwise()) {
    text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  }
  return text;
}
}  // namespace tapstudy::protocols
