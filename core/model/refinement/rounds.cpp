#include "core/model/refinement/rounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
namespace tapstudy::core {
void add(const ModelCost& more, ModelCost& to) {
  to.mesh_s += more.mesh_s;
  to.assemble_s += more.assemble_s;
  to.factor_s += more.factor_s;
  to.iterate_s += more.iterate_s;
}

double largest_change(const Eigen::ArrayXd& before, const Eigen::ArrayXd& after) {
  const Eigen::Index both = std::min(before.size(), after.size());
  return both == 0 ? 0.0 : (before.head(both) / after.head(both) - 1.0).abs().maxCoeff();
}

void check_can_settle(const std::vector<Fixation>& fixations, const char* key) {
  for (std::size_t i = 0; i < fixations.size(); ++i) {
    if (!can_hold_a_solid(fixations[i])) {
      throw ModelError{fmt::format(
          "{}: fixation {} is a point or a line, under which a solid's frequencies never settle "
          "(hold a disc, a side or a box, or state the mesh without it)",
          key, i + 1)};
    }
  }
}

std::string nonconverged_region(const std::vector<double>& before_m2,
                                const std::vector<double>& after_m2) {
  constexpr double still = 0.1;
  for (std::size_t i = 0; i < after_m2.size(); ++i) {
    if (after_m2[i] == 0.0) {
      return fmt::format("fixation {} is smaller than the elements: it holds single nodes", i + 1);
    }
    if (i >= before_m2.size() || std::abs(before_m2[i] / after_m2[i] - 1.0) > still) {
      return fmt::format(
          "fixation {} catches more nodes as the mesh is refined: {:.3g} m2, then {:.3g} m2", i + 1,
          i < before_m2.size() ? before_m2[i] : 0.0, after_m2[i]);
    }
  }
  return "";
}
}  // namespace tapstudy::core
