#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/triangle_surface.hpp"
#include "protocols/surface/mend_surface.hpp"
namespace tapstudy::protocols {
// How what a repair does is asked for, in what it says.
struct RepairTerms {
  const char* longest_hole;
  const char* wrap;
  const char* before_number;  // between one of these and its number
  const char* largest_piece;
  const char* max_triangles;
  const char* without_result;  // what a refusal adds
};
// Asks for a hole to be filled that is so long round its border.
std::string filling(const RepairTerms& terms, double around_m);
// Of `tapstudy repair`.
inline constexpr RepairTerms option_terms{
    "--largest-hole", "--wrap", " ", "--largest-piece", "--max-triangles", "; nothing is written"};

struct RepairRequest {
  double join_share{1e-5};                 // of the size: corners no further apart are one
  std::optional<double> longest_hole_m{};  // round its border; unset: as long as the surface's size
  // The rest is dropped. Where wrap_m is set, pieces no further than that from one that is kept are
  // kept and wrapped with it.
  bool is_largest_piece_only{false};
  std::optional<double> wrap_m{};      // unset: what cannot be mended is refused
  std::optional<int> max_triangles{};  // unset: as many as it has
  const RepairTerms* terms{&option_terms};
};
inline constexpr int fewest_triangles = 4;  // of a closed surface

// A hole by which a wrap goes inside: it encloses less than the surface does once that is filled.
struct EnteredHole {
  double around_m{};
  double filled_m3{};
};

struct SurfaceRepair {
  core::TriangleSurface surface;  // passes check_surface; as read_surface reads ply_text of it
  int corners_joined{};
  Holes holes{};
  int pieces_dropped{};
  std::optional<double> wrap_offset_m{};  // by which a wrap lies outside; unset: not wrapped
  std::optional<EnteredHole> entered{};   // by the wrap
  // By comparison of the triangles before, once their corners were joined, with those now.
  int kept{};
  int turned{};
  int dropped{};
  int added{};
  std::optional<double> volume_before_m3{};  // unset: it was open
  double area_before_m2{};
  // From sampled points of one surface to the nearest triangle of the other: the largest distance.
  double farthest_from_old_m{};
  double farthest_from_new_m{};
};

// What passes check_surface is returned as it is, if it has few enough triangles. All else is
// joined and mended, wrapped where that was asked for and mending did not do, then simplified; and
// wrapped, where that was asked for, if in the end it runs through itself or the mesher fails.
// Throws SurfaceFault, with what to try, where the result would still be refused, and ModelError
// where CGAL cannot do it.
SurfaceRepair repair_surface(const core::TriangleSurface& surface, const RepairRequest& request);

// What a repair changed, as measured: sentences, for people.
std::vector<std::string> describe_changes(const SurfaceRepair& repair,
                                          const RepairRequest& request);

// Round the border of the longest hole, where that is longer than what is filled unasked, the
// surface's size; else, or where it cannot be mended, unset.
std::optional<double> unfilled_hole_m(const core::TriangleSurface& surface);

// The gaps that a wrap of it bridges, if nothing else is known: a fiftieth of its size.
double advised_wrap_m(const core::TriangleSurface& surface);

double area_m2(const core::TriangleSurface& surface);

// A PLY of which read_surface makes the same surface, to the bit.
std::string ply_text(const core::TriangleSurface& surface);
}  // namespace tapstudy::protocols
