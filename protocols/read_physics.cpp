// Rendering, placement, materials and plates.
#include <cmath>

#include "protocols/read_sections.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;

core::Damping read_damping(MapReader& damping) {
  if (damping.has("first_ratio") || damping.has("last_ratio")) {
    return core::TwoRatioDamping{damping.number("first_ratio", {0.0, 100.0}),
                                 damping.number("last_ratio", {0.0, 100.0})};
  }
  return core::RayleighDamping{damping.number("alpha_per_s", {0.0, 1e6}),
                               damping.number("beta_s", {0.0, 1e3})};
}

std::array<bool, 3> read_axes(MapReader& fixation) {
  const std::string axes = fixation.word(
      "axes", "set of axes", {"xyz", "xy", "xz", "yz", "x", "y", "z"}, std::string{"xyz"});
  const auto has = [&](char axis) { return axes.find(axis) != std::string::npos; };
  return {has('x'), has('y'), has('z')};
}

void read_fixation(MapReader& reader, Plate& plate) {
  core::Fixation fixation;
  fixation.shape = reader.one_of<core::RegionShape>(
      "region", {{"vertex", core::RegionShape::vertex}, {"disc", core::RegionShape::disc}});
  fixation.at_m = reader.numbers("at_m", 2, {-100.0, 100.0});
  fixation.face = reader.one_of<core::Face>("face",
                                            {{"both", core::Face::both},
                                             {"top", core::Face::top},
                                             {"bottom", core::Face::bottom},
                                             {"through", core::Face::through}},
                                            "both");
  if (fixation.shape == core::RegionShape::disc) {
    fixation.radius_m = reader.number("radius_m", Range::positive(100.0));
  }
  fixation.holds = read_axes(reader);
  plate.fixations.push_back(fixation);
}

core::Material read_material(MapReader& reader) {
  core::Material material;
  material.youngs_modulus_pa = reader.number("youngs_modulus_pa", Range::positive(1e13));
  material.density_kg_per_m3 = reader.number("density_kg_per_m3", Range::positive(1e5));
  material.poissons_ratio = reader.number("poissons_ratio", {-1.0, 0.5, false, false});
  reader.map("damping", Presence::required,
             [&](MapReader& damping) { material.damping = read_damping(damping); });
  return material;
}

void read_sinusoid(MapReader& rendering, core::SinusoidShape& sinusoid) {
  rendering.map("sinusoid", Presence::optional, [&](MapReader& reader) {
    sinusoid.amplitude_n_s_per_m = reader.number("amplitude_n_s_per_m", {0.0, 1000.0});
    sinusoid.decay_per_s = reader.number("decay_per_s", Range::positive(1e6), 600.0);
    sinusoid.frequency_hz = reader.number("frequency_hz", Range::positive(1e4), 250.0);
  });
}
}  // namespace

void read_rendering(MapReader& top, Protocol& protocol) {
  core::RenderSettings& settings = protocol.rendering;
  top.map("finger", Presence::required, [&](MapReader& finger) {
    settings.finger.mass_kg = finger.number("mass_kg", Range::positive(10.0));
    settings.finger.stiffness_n_per_m = finger.number("stiffness_n_per_m", {0.0, 1e6});
    settings.finger.damping_n_s_per_m = finger.number("damping_n_s_per_m", {0.0, 1e4});
  });
  top.map("rendering", Presence::required, [&](MapReader& rendering) {
    protocol.rate_hz = rendering.number("rate_hz", {500.0, 10000.0});
    protocol.band_limit_hz = rendering.number("band_limit_hz", Range::positive(1e5));
    if (protocol.band_limit_hz >= protocol.rate_hz / 2.0) {
      rendering.reject("band_limit_hz",
                       "is not below half of rate_hz: faster modes cannot be "
                       "rendered and must not be folded back");
    }
    settings.dt_s = 1.0 / protocol.rate_hz;
    settings.penalty_stiffness_n_per_m =
        rendering.number("penalty_stiffness_n_per_m", Range::positive(1e6));
    settings.release_height_m = rendering.number("release_height_m", {0.0, 0.1}, 5e-4);
    settings.integrator = rendering.one_of<core::Integrator>(
        "integrator", {{"exact", core::Integrator::exact}, {"newmark", core::Integrator::newmark}},
        "exact");
    read_sinusoid(rendering, settings.sinusoid);
  });
}

void read_placement(MapReader& top, Presence presence,
                    const std::function<void(const core::Placement&)>& take) {
  top.map("placement", presence, [&](MapReader& reader) {
    core::Placement placement;
    placement.origin_m = reader.numbers("origin_m", 3, {-1.0, 1.0});
    placement.lateral_scale = reader.number("lateral_scale", Range::positive(1000.0));
    take(placement);
  });
}

void read_materials(MapReader& top, Protocol& protocol) {
  top.each("materials", Presence::required, [&](const std::string& name, MapReader& reader) {
    protocol.materials[name] = read_material(reader);
  });
}

void read_plates(MapReader& top, Protocol& protocol) {
  top.each("plates", Presence::required, [&](const std::string& name, MapReader& reader) {
    Plate plate;
    plate.box.size_m = reader.numbers("size_m", 3, {1e-4, 100.0});
    reader.map("mesh", Presence::optional, [&](MapReader& mesh) {
      mesh.integer("order", 1, 1, 1);
      if (mesh.has("max_tet_volume_m3")) {
        plate.mesh.max_tet_volume_m3 = mesh.number("max_tet_volume_m3", Range::positive(1e6));
      }
      plate.mesh.radius_edge_ratio = mesh.number("radius_edge_ratio", {1.1, 10.0}, 1.414);
    });
    reader.list("fixations", Presence::required,
                [&](MapReader& fixation) { read_fixation(fixation, plate); });
    protocol.plates[name] = plate;
  });
}
}  // namespace tapstudy::protocols
