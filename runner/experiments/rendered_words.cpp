#include "runner/experiments/rendered_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "runner/experiments/cached_model.hpp"
namespace tapstudy::runner {
namespace {
std::string millimetres(double length_m) {
  return fmt::format("{:.4g}", 1e3 * length_m);
}

const char* face_words(core::Face face) {
  switch (face) {
    case core::Face::top:
      return "on the tapped face";
    case core::Face::bottom:
      return "on the face below";
    case core::Face::both:
      return "on both faces";
    case core::Face::through:
      return "through the plate";
  }
  return "";
}

const char* side_words(core::Side side) {
  switch (side) {
    case core::Side::left:
      return "left side";
    case core::Side::right:
      return "right side";
    case core::Side::front:
      return "front side";
    case core::Side::back:
      return "back side";
    case core::Side::bottom:
      return "underside";
    case core::Side::top:
      return "upper side";
  }
  return "";
}

std::string region_words(const core::Fixation& fixation) {
  switch (fixation.shape) {
    case core::RegionShape::vertex:
      return fmt::format("vertex {}", face_words(fixation.face));
    case core::RegionShape::disc:
      return fmt::format("disc of radius {} mm {}", millimetres(fixation.radius_m),
                         face_words(fixation.face));
    case core::RegionShape::ball:
      return fmt::format("ball of radius {} mm", millimetres(fixation.radius_m));
    case core::RegionShape::box: {
      const core::Vec3 size_m = fixation.high_m - fixation.low_m;
      return fmt::format("box of {} × {} × {} mm", millimetres(size_m.x()), millimetres(size_m.y()),
                         millimetres(size_m.z()));
    }
    case core::RegionShape::side:
      return side_words(fixation.side);
  }
  return "";
}

// Nothing of what is held along all axes.
std::string hold_words(const core::Fixation& fixation) {
  if (fixation.springs_n_per_m) {
    const core::Vec3& springs = *fixation.springs_n_per_m;
    return fmt::format(", on springs of {:.3g}, {:.3g}, {:.3g} N/m", springs.x(), springs.y(),
                       springs.z());
  }
  std::string axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    axes += fixation.constrained_axes[axis] ? std::string(1, "xyz"[axis]) : "";
  }
  return axes == "xyz" ? "" : ", held along " + axes;
}
}  // namespace

std::string size_words(const core::Shape& shape) {
  const core::Vec3 size_m = core::bounds(shape).size_m();
  return fmt::format("{}{} × {} × {} mm",
                     std::holds_alternative<core::Box>(shape) ? "" : "surface within ",
                     millimetres(size_m.x()), millimetres(size_m.y()), millimetres(size_m.z()));
}

std::string fixation_words(const std::vector<core::Fixation>& fixations) {
  std::vector<std::pair<std::string, int>> alike;
  for (const core::Fixation& fixation : fixations) {
    const std::string words = region_words(fixation) + hold_words(fixation);
    const auto found = std::ranges::find(alike, words, &std::pair<std::string, int>::first);
    if (found == alike.end()) {
      alike.emplace_back(words, 1);
    } else {
      ++found->second;
    }
  }
  std::vector<std::string> parts;
  for (const auto& [words, times] : alike) {
    parts.push_back(times == 1 ? words : fmt::format("{} × {}", times, words));
  }
  return parts.empty() ? "free" : fmt::format("{}", fmt::join(parts, "; "));
}

std::string contact_words(const protocols::Protocol& protocol,
                          const protocols::Stimulus& stimulus) {
  if (!stimulus.contacts) {
    return "";
  }
  std::vector<std::string> bodies;
  for (std::size_t i = 0; i < stimulus.contacts->bodies.size(); ++i) {
    bodies.push_back(fmt::format("{} of {:.3g} Pa, {:.4g} kg/m³",
                                 name_in(protocol.plates, stimulus.contacts->plates.at(i + 1)),
                                 stimulus.contacts->bodies[i].material.youngs_modulus_pa,
                                 stimulus.contacts->bodies[i].material.density_kg_per_m3));
  }
  const std::size_t springs = stimulus.contacts->springs.size();
  return fmt::format("; touches {} by {} spring{}", fmt::join(bodies, ", "), springs,
                     springs == 1 ? "" : "s");
}
}  // namespace tapstudy::runner
