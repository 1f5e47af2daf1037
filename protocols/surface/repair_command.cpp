#include "protocols/surface/repair_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "protocols/surface/repair_surface.hpp"
namespace tapstudy::protocols {
namespace {
// Of which quadratic elements are within what a model may take.
constexpr Eigen::Index advised_triangles = 10'000;
// So many can still be meshed; a wrap of fewer may have more.
constexpr Eigen::Index most_triangles = 20'000;

// As one word of a shell.
std::string word(const std::string& text) {
  const bool is_plain = std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view{"._-+/"}.find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (is_plain && !text.empty()) {
    return text;
  }
  std::string quoted{"'"};
  for (const char c : text) {
    quoted += c == '\'' ? std::string{"'\\''"} : std::string{c};
  }
  return quoted + "'";
}

std::string command(const core::TriangleSurface& surface, const std::string& file,
                    double metres_per_unit, Eigen::Index max_triangles) {
  return fmt::format(
      "tapstudy repair {} --metres-per-unit {} --wrap {:.2g} --largest-piece --max-triangles {} "
      "--out {}",
      word(file), metres_per_unit, advised_wrap_m(surface), max_triangles,
      word(std::filesystem::path{file}.stem().string() + "_repaired.ply"));
}
}  // namespace

std::string command_that_cures(const core::TriangleSurface& surface, const std::string& file,
                               double metres_per_unit) {
  const bool are_few = surface.triangles.rows() <= most_triangles;
  return command(surface, file, metres_per_unit, are_few ? most_triangles : advised_triangles);
}

std::string command_that_simplifies(const core::TriangleSurface& surface, const std::string& file,
                                    double metres_per_unit) {
  constexpr Eigen::Index fewest = 4;  // of a closed surface
  return command(surface, file, metres_per_unit,
                 std::clamp(surface.triangles.rows() / 2, fewest, advised_triangles));
}
}  // namespace tapstudy::protocols
