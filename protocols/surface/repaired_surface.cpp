#include "protocols/surface/repaired_surface.hpp"

#include <fmt/format.h>

#include <map>
#include <mutex>
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

namespace {
std::string repaired_bytes(const core::TriangleSurface& surface, const RepairRequest& request) {
  const SurfaceRepair repair = repair_surface(surface, request);
  std::string bytes = ply_text(repair.surface);
  std::string comments;
  for (const std::string& line : describe_changes(repair, request)) {
    comments += fmt::format("{}{}\n", comment, line);
  }
  bytes.insert(first_lines.size(), comments);
  return bytes;
}

// What was repaired in this process, by file's contents and name of the result: a command reads a
// protocol several times, and repairs and measures once.
struct Repairs {
  std::mutex mutex;
  std::map<std::string, std::string> bytes;
};
Repairs& repairs() {
  static Repairs all;
  return all;
}
}  // namespace

SurfaceSource repaired_source(const SurfaceSource& file, const core::TriangleSurface& surface,
                              const AskedRepair& asked) {
  const std::string name = repaired_name(file.file, asked);
  Repairs& all = repairs();
  const std::lock_guard lock{all.mutex};
  const std::string key = file.sha256 + " " + name;
  auto known = all.bytes.find(key);
  if (known == all.bytes.end()) {
    known = all.bytes.emplace(key, repaired_bytes(surface, asked.request)).first;
  }
  return repaired_source(name, known->second);
}

std::size_t repairs_made() {
  Repairs& all = repairs();
  const std::lock_guard lock{all.mutex};
  return all.bytes.size();
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
