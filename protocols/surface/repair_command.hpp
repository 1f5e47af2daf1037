#pragma once
#include <string>

#include "core/geometry/triangle_surface.hpp"
namespace tapstudy::protocols {
// What should cure a surface which is refused, for its error: one command line and the key of a
// plate's surface that asks a study for the same. They mend it, fill its holes, wrap it where that
// does not do, drop pieces far from the largest, and simplify what then has more triangles than a
// mesh bears.
std::string cures(const core::TriangleSurface& surface, const std::string& file,
                  double metres_per_unit);

// The command for a surface which a mesher cannot fill: one of fewer triangles.
std::string command_that_simplifies(const core::TriangleSurface& surface, const std::string& file,
                                    double metres_per_unit);
}  // namespace tapstudy::protocols
