#include "protocols/surface/repaired_surface.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "protocols/surface/surface_soup.hpp"
namespace tapstudy::protocols {
namespace {
constexpr std::string_view comment{"comment "};
constexpr std::string_view first_lines{"ply\nformat ascii 1.0\n"};
}  // namespace

std::string repaired_name(const std::string& file, const AskedRepair& asked) {
  const RepairRequest& request = asked.request;
  std::string how =
      fmt::format("metres_per_unit {}, join_share {}", asked.metres_per_unit, request.join_share);
  if (request.longest_hole_m) {
    how += fmt::format(", largest_hole_m {}", *request.longest_hole_m);
  }
  if (request.is_largest_piece_only) {
    how += ", largest_piece";
  }
  if (request.wrap_m) {
    how += fmt::format(", wrap_m {}", *request.wrap_m);
  }
  if (request.max_triangles) {
    how += fmt::format(", max_triangles {}", *request.max_triangles);
  }
  return fmt::format("{} repaired ({}).ply", file, how);
}

SurfaceSource repaired_source(const std::string& file, const core::TriangleSurface& surface,
                              const AskedRepair& asked) {
  const SurfaceRepair repair = repair_surface(surface, asked.request);
  std::string bytes = ply_text(repair.surface);
  std::string comments;
  for (const std::string& line : describe_changes(repair, asked.request)) {
    comments += fmt::format("{}{}\n", comment, line);
  }
  bytes.insert(first_lines.size(), comments);
  return repaired_source(repaired_name(file, asked), std::move(bytes));
}

SurfaceSource repaired_source(const std::string& name, std::string bytes) {
  SurfaceSource source = surface_source(name, std::move(bytes));
  std::string_view text{source.bytes};
  text.remove_prefix(std::min(first_lines.size(), text.size()));
  for (std::string_view line = take_line(text); line.starts_with(comment); line = take_line(text)) {
    source.changes.emplace_back(line.substr(comment.size()));
  }
  return source;
}
}  // namespace tapstudy::protocols
