#include "protocols/surface/repair_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/text/plain_text.hpp"
#include "protocols/surface/repaired_surface.hpp"
namespace tapstudy::protocols {
namespace {
// Of which quadratic elements are within what a model may take.
constexpr Eigen::Index advised_triangles = 10'000;
// So many can still be meshed; a wrap of fewer may have more.
constexpr Eigen::Index most_triangles = 20'000;

std::string command(const core::TriangleSurface& surface, const std::string& file,
                    double metres_per_unit, Eigen::Index max_triangles) {
  return fmt::format(
      "tapstudy repair {} --metres-per-unit {} --wrap {:.2g} --largest-piece --max-triangles {} "
      "--out {}",
      core::shell_word(file), metres_per_unit, advised_wrap_m(surface), max_triangles,
      core::shell_word(std::filesystem::path{file}.stem().string() + "_repaired.ply"));
}

Eigen::Index triangles_left(const core::TriangleSurface& surface) {
  return surface.triangles.rows() <= most_triangles ? most_triangles : advised_triangles;
}
}  // namespace

std::string command_that_cures(const core::TriangleSurface& surface, const std::string& file,
                               double metres_per_unit) {
  return command(surface, file, metres_per_unit, triangles_left(surface));
}

std::string key_that_cures(const core::TriangleSurface& surface) {
  return fmt::format("repair: {{{}{}{:.2g}, {}, {}: {}}}", key_terms.wrap, key_terms.before_number,
                     advised_wrap_m(surface), key_terms.largest_piece, key_terms.max_triangles,
                     triangles_left(surface));
}

std::string command_that_simplifies(const core::TriangleSurface& surface, const std::string& file,
                                    double metres_per_unit) {
  return command(
      surface, file, metres_per_unit,
      std::clamp(surface.triangles.rows() / 2, Eigen::Index{fewest_triangles}, advised_triangles));
}
}  // namespace tapstudy::protocols
