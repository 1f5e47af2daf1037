#pragma once
#include <string>

#include "protocols/surface/repair_surface.hpp"
#include "protocols/surface/surface_file.hpp"
namespace tapstudy::protocols {
// Of a protocol's key `repair`.
inline constexpr RepairTerms key_terms{"largest_hole_m",      "wrap_m",        ": ",
                                       "largest_piece: true", "max_triangles", ""};

// A file's surface as its protocol asks for it to be repaired.
struct AskedRepair {
  double metres_per_unit{};
  RepairRequest request;
};

// As read_surface, but a face that cannot be cut into triangles is a fan of them, in place of a
// fault: what a repair begins with.
ReadSurface read_to_repair(const SurfaceSource& source, double metres_per_unit);

// The name of the result, which says of what and how it was made.
std::string repaired_name(const std::string& file, const AskedRepair& asked);

// The result as it is stored with a study: under that name a PLY in metres, whose comments say what
// changed; made once in a process, however often a protocol is read. surface: as read of the file.
// Throws as repair_surface.
SurfaceSource repaired_source(const SurfaceSource& file, const core::TriangleSurface& surface,
                              const AskedRepair& asked);
// How many different ones this process has made.
std::size_t repairs_made();

// The same from its bytes.
SurfaceSource repaired_source(const std::string& name, std::string bytes);
}  // namespace tapstudy::protocols
