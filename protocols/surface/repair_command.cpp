#include "protocols/surface/repair_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
#include "protocols/surface/check_surface.hpp"
#include "protocols/surface/repair_surface.hpp"
#include "protocols/surface/repaired_surface.hpp"
namespace tapstudy::protocols {
namespace {
// Of which quadratic elements are within what a model may take.
constexpr Eigen::Index advised_triangles = 10'000;
// So many can still be meshed; a wrap of fewer may have more.
constexpr Eigen::Index most_triangles = 20'000;

std::string command(const std::string& file, double metres_per_unit, const std::string& options) {
  return fmt::format(
      "tapstudy repair {} --metres-per-unit {} {} --out {}", core::shell_word(file),
      metres_per_unit, options,
      core::shell_word(std::filesystem::path{file}.stem().string() + "_repaired.ply"));
}

std::string by_wrap(const core::TriangleSurface& surface, const std::string& filling,
                    Eigen::Index max_triangles) {
  return fmt::format("{}--wrap {:.2g} --largest-piece --max-triangles {}", filling,
                     advised_wrap_m(surface), max_triangles);
}

// Whether it is a body but for pieces that are nothing beside it, such as a triangle left over.
bool is_body_without_small_pieces(const core::TriangleSurface& surface) {
  constexpr double most_dropped = 0.01;  // of its area
  RepairRequest request;
  request.is_largest_piece_only = true;
  try {
    const SurfaceRepair repair = repair_surface(surface, request);
    return repair.pieces_dropped > 0 &&
           area_m2(repair.surface) >= (1.0 - most_dropped) * repair.area_before_m2;
  } catch (const core::Error&) {
    return false;
  }
}

}  // namespace

std::string cures(const core::TriangleSurface& surface, const std::string& file,
                  double metres_per_unit) {
  if (surface.triangles.rows() <= max_triangles && is_body_without_small_pieces(surface)) {
    return fmt::format("try: {}; or in the study, beside the file: repair: {{{}}}",
                       command(file, metres_per_unit, option_terms.largest_piece),
                       key_terms.largest_piece);
  }
  const Eigen::Index triangles =
      surface.triangles.rows() <= most_triangles ? most_triangles : advised_triangles;
  const auto hole_m =
      surface.triangles.rows() <= max_triangles ? unfilled_hole_m(surface) : std::nullopt;
  const std::string by_option = hole_m ? filling(option_terms, *hole_m) : "";
  const std::string by_key = hole_m ? filling(key_terms, *hole_m) : "";
  return fmt::format(
      "try: {}{}; or in the study, beside the file: repair: {{{}{}{}{}{:.2g}, {}, {}: {}}}",
      command(file, metres_per_unit, by_wrap(surface, by_option + (hole_m ? " " : ""), triangles)),
      hole_m ? fmt::format(" (of an open sheet without {}: a skin, or thickness_m)", by_option)
             : std::string{},
      by_key, hole_m ? ", " : "", key_terms.wrap, key_terms.before_number, advised_wrap_m(surface),
      key_terms.largest_piece, key_terms.max_triangles, triangles);
}

std::string command_that_simplifies(const core::TriangleSurface& surface, const std::string& file,
                                    double metres_per_unit) {
  return command(file, metres_per_unit,
                 by_wrap(surface, "",
                         std::clamp(surface.triangles.rows() / 2, Eigen::Index{fewest_triangles},
                                    advised_triangles)));
}
}  // namespace tapstudy::protocols
