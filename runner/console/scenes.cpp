#include "runner/console/scenes.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <variant>

#include "protocols/axes/presented_stimulus.hpp"
#include "runner/console/page_json.hpp"
namespace tapstudy::runner {
namespace {
Json json_of(const core::Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json box_of(const core::Vec3& low_m, const core::Vec3& high_m) {
  return {{"kind", "box"}, {"low_m", json_of(low_m)}, {"high_m", json_of(high_m)}};
}

// Of a body's bounding box. The lower face is not seen from above: null.
Json json_of(core::Side side, const core::Bounds& bounds) {
  core::Vec3 low_m = bounds.low_m;
  core::Vec3 high_m = bounds.high_m;
  switch (side) {
    case core::Side::left:
      high_m.x() = low_m.x();
      break;
    case core::Side::right:
      low_m.x() = high_m.x();
      break;
    case core::Side::front:
      high_m.y() = low_m.y();
      break;
    case core::Side::back:
      low_m.y() = high_m.y();
      break;
    case core::Side::top:
      break;
    case core::Side::bottom:
      return nullptr;
  }
  return box_of(low_m, high_m);
}

Json json_of(const core::Fixation& fixation, const core::Bounds& bounds) {
  switch (fixation.shape) {
    case core::RegionShape::vertex:
      return {{"kind", "vertex"}, {"at_m", json_of(fixation.at_m)}};
    case core::RegionShape::disc:
    case core::RegionShape::ball:
      return {{"kind", "disc"},
              {"at_m", {fixation.at_m.x(), fixation.at_m.y()}},
              {"radius_m", fixation.radius_m}};
    case core::RegionShape::box:
      return box_of(fixation.low_m.cwiseMax(bounds.low_m), fixation.high_m.cwiseMin(bounds.high_m));
    case core::RegionShape::side:
      return json_of(fixation.side, bounds);
  }
  return nullptr;
}

Json shape_of(const core::Box& box) {
  const core::Vec3 size_m = core::bounds(core::Shape{box}).size_m();
  return {{"kind", "box"}, {"size_m", json_of(size_m)}};
}

Json shape_of(const core::Solid& solid) {
  const core::TriangleSurface& surface = solid.surface();
  std::vector<double> points;
  for (const auto& point : surface.points_m.rowwise()) {
    points.insert(points.end(), {point.x(), point.y(), point.z()});
  }
  std::vector<int> triangles;
  for (const auto& triangle : surface.triangles.rowwise()) {
    triangles.insert(triangles.end(), {triangle[0], triangle[1], triangle[2]});
  }
  return {{"kind", "surface"}, {"points_m", points}, {"triangles", triangles}};
}

Json points_of(const protocols::Plate& plate) {
  Json points = Json::array();
  for (const auto& [name, point] : plate.tapping_points_m) {
    points.push_back({point.x(), point.y(), 0.0});
  }
  return points;
}

bool varies_in_size(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus) {
  const auto size_m = [&](const protocols::AxisRange& range, double value) {
    const auto member = stimulus_with(protocol, stimulus, {{std::string{range.axis->name}, value}});
    return core::bounds(member.plate->shape).size_m();
  };
  return std::ranges::any_of(stimulus.vary, [&](const protocols::AxisRange& range) {
    return size_m(range, range.from) != size_m(range, range.to);
  });
}
}  // namespace

Scenes::Scenes(const protocols::Protocol& protocol, const core::Placement& placement)
    : protocol_{protocol}, placement_{placement} {
  for (const auto& [name, plate] : protocol.plates) {
    Json json = std::visit([](const auto& shape) { return shape_of(shape); }, plate->shape);
    json["tapping_points_m"] =
        protocol.display.shows_tapping_points ? points_of(*plate) : Json::array();
    const std::string shape = json.dump();
    json["fixations"] = Json::array();
    for (const core::Fixation& fixation : plate->fixations) {
      if (const Json shown = json_of(fixation, core::bounds(plate->shape));
          protocol.display.shows_fixations && !shown.is_null()) {
        json["fixations"].push_back(shown);
      }
    }
    all_.push_back({plate.get(), placement.scaled(plate->lateral_ratio), json.dump(), shape});
  }
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (varies_in_size(protocol, stimulus)) {
      varying_.insert(stimulus.name);
    }
  }
}

// The same for all trials of a block: where catch trials have another shape, none is shown; nor
// where its size varies.
std::optional<int> Scenes::number_of(const std::string& stimulus,
                                     const protocols::Block& block) const {
  const int number = place_of(stimulus);
  const bool tells_apart = std::ranges::any_of(all_presented(block), [&](const std::string& other) {
    return varying_.contains(other) || at(place_of(other)).shape != at(number).shape;
  });
  return tells_apart ? std::nullopt : std::optional{number};
}

// Of plates that look the same the first, so that the number says no more than the picture.
int Scenes::place_of(const std::string& stimulus) const {
  const auto own = std::ranges::find(all_, protocol_.stimulus(stimulus).plate.get(), &Scene::plate);
  const auto first = std::ranges::find_if(all_, [&](const Scene& scene) {
    return scene.json == own->json && scene.plate->lateral_ratio == own->plate->lateral_ratio;
  });
  return static_cast<int>(first - all_.begin());
}

double Scenes::surface_along_normal_m() const {
  return core::along_normal(placement_.origin_m);
}

core::Vec3 Scenes::to_scene(int number, const core::Vec3& device_position_m) const {
  return at(number).placement.to_plate({device_position_m, core::Vec3::Zero()}).position_m;
}
}  // namespace tapstudy::runner
