#include <fmt/format.h>

#include "runner/recordings/writers.hpp"
namespace tapstudy::runner {
namespace {
std::string numbers(const core::Vec3& v) {
  return fmt::format("[{:.9g}, {:.9g}, {:.9g}]", v.x(), v.y(), v.z());
}

std::string place(const core::Fixation& fixation, bool is_of_box) {
  return is_of_box ? fmt::format("at_m: [{:.9g}, {:.9g}], face: {}", fixation.at_m.x(),
                                 fixation.at_m.y(), name_in(core::face_names, fixation.face))
                   : "at_m: " + numbers(fixation.at_m);
}

std::string where(const core::Fixation& fixation, bool is_of_box) {
  switch (fixation.shape) {
    case core::RegionShape::vertex:
      return place(fixation, is_of_box);
    case core::RegionShape::disc:
      return fmt::format("{}, radius_m: {:.9g}", place(fixation, is_of_box), fixation.radius_m);
    case core::RegionShape::ball:
      return fmt::format("at_m: {}, radius_m: {:.9g}", numbers(fixation.at_m), fixation.radius_m);
    case core::RegionShape::box:
      return fmt::format("low_m: {}, high_m: {}", numbers(fixation.low_m),
                         numbers(fixation.high_m));
    case core::RegionShape::side:
      break;
  }
  return fmt::format("side: {}", name_in(core::side_names, fixation.side));
}

std::string hold(const core::Fixation& fixation) {
  if (const auto& springs = fixation.springs_n_per_m) {
    return fmt::format("springs_n_per_m: [{:.5g}, {:.5g}, {:.5g}]", springs->x(), springs->y(),
                       springs->z());
  }
  std::string axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    axes += fixation.constrained_axes.at(axis) ? std::string(1, "xyz"[axis]) : "";
  }
  return "axes: " + axes;
}
}  // namespace

std::string fixation_yaml(const core::Fixation& fixation, bool is_of_box) {
  return fmt::format("{{region: {}, {}, {}}}", name_in(core::region_names, fixation.shape),
                     where(fixation, is_of_box), hold(fixation));
}
}  // namespace tapstudy::runner
