// Plates: shape, mesh and fixations.
#include <algorithm>

#include "core/error.hpp"
#include "protocols/read_sections.hpp"
#include "protocols/surface/check_surface.hpp"
#include "protocols/surface/surface_file.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;
constexpr Range coordinate_m{-10.0, 10.0};

std::array<bool, 3> read_axes(MapReader& fixation) {
  const std::string axes = fixation.word(
      "axes", "set of axes", {"xyz", "xy", "xz", "yz", "x", "y", "z"}, std::string{"xyz"});
  const auto has = [&](char axis) { return axes.find(axis) != std::string::npos; };
  return {has('x'), has('y'), has('z')};
}

void read_place(MapReader& reader, bool is_box, core::Fixation& fixation) {
  if (!is_box) {
    fixation.at_m = reader.numbers("at_m", 3, coordinate_m);
    return;
  }
  fixation.at_m.head<2>() = reader.numbers("at_m", 2, coordinate_m);
  fixation.face = reader.one_of<core::Face>("face",
                                            {{"both", core::Face::both},
                                             {"top", core::Face::top},
                                             {"bottom", core::Face::bottom},
                                             {"through", core::Face::through}},
                                            "both");
}

core::Fixation read_fixation(MapReader& reader, bool is_box) {
  using core::RegionShape;
  core::Fixation fixation;
  fixation.shape = reader.one_of<RegionShape>("region", {{"vertex", RegionShape::vertex},
                                                         {"disc", RegionShape::disc},
                                                         {"ball", RegionShape::ball},
                                                         {"box", RegionShape::box},
                                                         {"side", RegionShape::side}});
  switch (fixation.shape) {
    case RegionShape::disc:
      if (!is_box) {
        reader.reject("region", "a disc lies on a plate; on a surface from a file use a ball");
      }
      [[fallthrough]];
    case RegionShape::vertex:
      read_place(reader, is_box, fixation);
      break;
    case RegionShape::ball:
      fixation.at_m = reader.numbers("at_m", 3, coordinate_m);
      break;
    case RegionShape::box:
      fixation.low_m = reader.numbers("low_m", 3, coordinate_m);
      fixation.high_m = reader.numbers("high_m", 3, coordinate_m);
      if ((fixation.low_m.array() > fixation.high_m.array()).any()) {
        reader.reject("low_m", "is not below high_m along every axis");
      }
      break;
    case RegionShape::side:
      fixation.side = reader.one_of<core::Side>("side", {{"left", core::Side::left},
                                                         {"right", core::Side::right},
                                                         {"front", core::Side::front},
                                                         {"back", core::Side::back},
                                                         {"bottom", core::Side::bottom},
                                                         {"top", core::Side::top}});
      break;
  }
  if (fixation.shape == RegionShape::disc || fixation.shape == RegionShape::ball) {
    fixation.radius_m = reader.number("radius_m", Range::positive(10.0));
  }
  fixation.constrained_axes = read_axes(reader);
  return fixation;
}

core::Meshing read_mesh(MapReader& mesh) {
  core::Meshing meshing;
  meshing.order = mesh.integer("order", 1, 2, 1);
  if (mesh.has("max_tet_volume_m3")) {
    meshing.size.max_tet_volume_m3 = mesh.number("max_tet_volume_m3", Range::positive(1e6));
  }
  meshing.size.radius_edge_ratio = mesh.number("radius_edge_ratio", {1.1, 10.0}, 1.414);
  meshing.size.flattening = mesh.number("flattening", {1.0, core::max_flattening}, 1.0);
  if (mesh.has("accuracy")) {
    meshing.accuracy = mesh.number("accuracy", {1e-5, 1.0, true, false});
  }
  return meshing;
}

// Read once, however many plates have it: what is modelled is what is stored.
const SurfaceSource& surface_of(const std::string& file, const ReadFile& read_file,
                                Protocol& protocol) {
  const auto known = std::ranges::find(protocol.surfaces, file, &SurfaceSource::file);
  if (known != protocol.surfaces.end()) {
    return *known;
  }
  return protocol.surfaces.emplace_back(surface_source(file, read_file(file)));
}

// Problems of the surface itself are reported at its key; reading then continues.
core::Shape read_surface_shape(MapReader& plate, const ReadFile& read_file, Protocol& protocol) {
  core::Shape shape = core::Box{core::Vec3::Constant(10.0)};  // placeholder until read
  plate.map("surface", Presence::required, [&](MapReader& reader) {
    const std::string file = reader.text("file");
    const double metres_per_unit = reader.number("metres_per_unit", Range::positive(1000.0));
    try {
      const SurfaceSource& source = surface_of(file, read_file, protocol);
      core::TriangleSurface surface = read_surface(source, metres_per_unit);
      check_surface(surface);
      shape = core::Solid{std::move(surface)};
    } catch (const core::InvalidInput& error) {
      reader.reject("file", error.what());
    }
  });
  return shape;
}
}  // namespace

void read_plates(MapReader& top, Protocol& protocol, const ReadFile& read_file) {
  top.each("plates", Presence::required, [&](const std::string& name, MapReader& reader) {
    core::Plate plate;
    const bool is_box = !reader.has("surface");
    plate.shape = is_box ? core::Shape{core::Box{reader.numbers("size_m", 3, {1e-4, 10.0})}}
                         : read_surface_shape(reader, read_file, protocol);
    reader.map("mesh", Presence::optional, [&](MapReader& mesh) { plate.mesh = read_mesh(mesh); });
    reader.list("fixations", Presence::required, [&](MapReader& fixation) {
      plate.fixations.push_back(read_fixation(fixation, is_box));
    });
    if (!is_box && protocol.placement.lateral_scale != 1.0) {
      reader.reject("surface",
                    "needs placement.lateral_scale: 1 (only a flat plate can be scaled sideways)");
    }
    protocol.plates[name] = std::make_shared<const core::Plate>(std::move(plate));
  });
}
}  // namespace tapstudy::protocols
