#pragma once
#include <string>
#include <vector>

namespace tapstudy::core {
// A piecewise linear complex, as TetGen takes it: points, and facets that are each made of
// polygons, the first one its outline, the others points or segments inside it.
struct TetgenInput {
  std::string switches;
  std::vector<double> coordinates;  // x, y, z of each point
  std::vector<std::vector<std::vector<int>>> facets;
};

struct TetgenOutput {
  std::vector<double> coordinates;
  std::vector<int> corners;  // four of each tetrahedron, in TetGen's order
};

// More Steiner points than these are refused: bounds refinement that may not end on a bad surface.
// Of so many there are four tetrahedra and more to a node, and these are more than max_tets.
inline constexpr int max_added_points = 75000;

// Runs TetGen in a process of its own, for it crashes or hangs on some surfaces. Throws ModelError.
TetgenOutput run_tetgen(const TetgenInput& input);
}  // namespace tapstudy::core
