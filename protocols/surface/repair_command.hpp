#pragma once
#include <string>

#include "core/geometry/triangle_surface.hpp"
namespace tapstudy::protocols {
// The one command line that should cure a surface which is refused: it mends it, wraps it where
// that does not do, drops pieces far from the largest, and simplifies what then has more
// triangles than a mesh bears.
std::string command_that_cures(const core::TriangleSurface& surface, const std::string& file,
                               double metres_per_unit);

// The key of a plate's surface that asks a study for the same.
std::string key_that_cures(const core::TriangleSurface& surface);

// The command for a surface which a mesher cannot fill: one of fewer triangles.
std::string command_that_simplifies(const core::TriangleSurface& surface, const std::string& file,
                                    double metres_per_unit);
}  // namespace tapstudy::protocols
