#include <fmt/format.h>

#include <array>
#include <string_view>

#include "runner/recordings/writers.hpp"
namespace tapstudy::runner {
namespace {
template <std::size_t Size, class Value>
std::string_view word_of(const std::array<std::string_view, Size>& words, Value value) {
  return words.at(static_cast<std::size_t>(value));
}
constexpr std::array<std::string_view, 5> regions{"vertex", "disc", "ball", "box", "side"};
constexpr std::array<std::string_view, 4> faces{"top", "bottom", "both", "through"};
constexpr std::array<std::string_view, 6> sides{"left", "right", "front", "back", "bottom", "top"};

std::string numbers(const core::Vec3& v) {
  return fmt::format("[{:.9g}, {:.9g}, {:.9g}]", v.x(), v.y(), v.z());
}

std::string place(const core::Fixation& fixation, bool is_of_box) {
  return is_of_box ? fmt::format("at_m: [{:.9g}, {:.9g}], face: {}", fixation.at_m.x(),
                                 fixation.at_m.y(), word_of(faces, fixation.face))
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
  return fmt::format("side: {}", word_of(sides, fixation.side));
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
  return fmt::format("{{region: {}, {}, {}}}", word_of(regions, fixation.shape),
                     where(fixation, is_of_box), hold(fixation));
}
}  // namespace tapstudy::runner
