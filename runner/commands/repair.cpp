#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "core/error.hpp"
#include "core/files/output_files.hpp"
#include "protocols/surface/repair_surface.hpp"
#include "protocols/surface/repaired_surface.hpp"
#include "protocols/surface/surface_file.hpp"
#include "protocols/yaml/text_file.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
namespace {
constexpr double longest_m = 100.0;

struct RepairOptions {
  std::string file;
  std::string out;
  double metres_per_unit{1.0};
  double join_share{protocols::RepairRequest{}.join_share};
  double largest_hole_m{0.0};
  bool is_largest_piece_only{false};
  double wrap_m{0.0};
  int max_triangles{0};
};

protocols::RepairRequest request_of(const RepairOptions& options) {
  protocols::RepairRequest request;
  request.join_share = options.join_share;
  request.is_largest_piece_only = options.is_largest_piece_only;
  if (options.largest_hole_m > 0.0) {
    request.longest_hole_m = options.largest_hole_m;
  }
  if (options.wrap_m > 0.0) {
    request.wrap_m = options.wrap_m;
  }
  if (options.max_triangles != 0) {
    if (options.max_triangles < protocols::fewest_triangles) {
      throw core::InvalidInput{fmt::format("--max-triangles {}: a closed surface has {} at least",
                                           options.max_triangles, protocols::fewest_triangles)};
    }
    request.max_triangles = options.max_triangles;
  }
  return request;
}

void repair(const RepairOptions& options) {
  const protocols::RepairRequest request = request_of(options);
  core::check_is_new(options.out);
  const protocols::ReadSurface read = protocols::read_to_repair(
      protocols::surface_source(options.file,
                                protocols::contents_of(options.file, protocols::max_surface_bytes)),
      options.metres_per_unit);
  const protocols::SurfaceRepair repaired = [&] {
    const Progress progress{fmt::format("repairing '{}'", options.file)};
    try {
      return protocols::repair_surface(read.surface, request);
    } catch (const core::InvalidInput& error) {
      throw core::InvalidInput{fmt::format("{}: {}", options.file, error.what())};
    }
  }();
  core::write_new_file(options.out, protocols::ply_text(repaired.surface));
  if (!read.noise.describe().empty()) {
    fmt::print("read: {}\n", read.noise.describe());
  }
  for (const std::string& line : protocols::describe_changes(repaired, request)) {
    fmt::print("{}\n", line);
  }
  fmt::print("{}: {} triangles, in metres (metres_per_unit: 1)\n", options.out,
             repaired.surface.triangles.rows());
}
}  // namespace

void add_repair(CommandParser& line) {
  Command command =
      line.add("repair", "Make of a surface's file one that encloses a body, and say what changed");
  const auto options = std::make_shared<RepairOptions>();
  command.argument("file", options->file, "STL, PLY, OFF or OBJ");
  command.file("--out", options->out, ".ply", "The repaired surface (.ply), in metres",
               Need::required);
  command.number_within("--metres-per-unit", options->metres_per_unit, 1e-9, 1000.0,
                        "0.001 for a file in millimetres");
  command.number_within("--join", options->join_share, 0.0, 0.01,
                        "Corners no further apart than this share of the size are one");
  command.number_within("--largest-hole", options->largest_hole_m, 0.0, longest_m,
                        "Fill holes up to this many metres round; 0: as the surface's size");
  command.flag(
      "--largest-piece", options->is_largest_piece_only,
      "Drop all pieces but the one of the largest area, and those that --wrap bridges to it");
  command.number_within("--wrap", options->wrap_m, 0.0, longest_m,
                        "Where mending or simplifying does not do: a new surface around all, which "
                        "bridges this many metres; 0: none");
  command.option_with_default("--max-triangles", options->max_triangles,
                              "Simplify to this many triangles at most; 0: as many as it has");
  command.on_run([options] { repair(*options); });
}
}  // namespace tapstudy::runner
