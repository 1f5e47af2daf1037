// Rendering, placement and materials.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "protocols/axes/axis.hpp"
#include "protocols/reader/read_sections.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;

core::Damping read_fit(MapReader& damping) {
  core::FittedDamping fitted;
  damping.list(
      {"measured", "ratios at two or more different frequencies, fitted by least squares"},
      Presence::at_least_one, [&](MapReader& point) {
        fitted.points.push_back(
            {point.number({"frequency_hz", "frequency of the measurement"}, Range::positive(1e5)),
             point.number({"ratio", "damping ratio at this frequency"}, allowed::damping_ratio)});
      });
  const auto lies_elsewhere = [&](const core::FittedDamping::Point& point) {
    return point.frequency_hz != fitted.points.front().frequency_hz;
  };
  damping.check(
      "measured", fitted.points.empty() || std::ranges::any_of(fitted.points, lies_elsewhere),
      R"({"minItems": 2})", "has one frequency only (a fit needs two different ones at least)");
  return fitted;
}

core::Damping read_damping(MapReader& damping) {
  if (damping.has("modal_ratios")) {
    damping.refuse_beside("modal_ratios", {"ratio", "measured", "first_ratio", "last_ratio",
                                           "alpha_per_s", "beta_s"});
    core::ModalDamping modal{damping.number_list(
        {"modal_ratios", "one ratio per mode in the band, lowest first"}, allowed::damping_ratio)};
    if (damping.has("further_ratio")) {
      modal.further_ratio = damping.number({"further_ratio",
                                            "damping ratio of the modes beyond the list; unset: "
                                            "the list must reach for every plate"},
                                           allowed::damping_ratio);
    }
    return modal;
  }
  if (damping.has("ratio")) {
    damping.refuse_beside("ratio",
                          {"measured", "first_ratio", "last_ratio", "alpha_per_s", "beta_s"});
    return core::ConstantDamping{
        damping.number({"ratio", "the same damping ratio for every mode"}, allowed::damping_ratio)};
  }
  if (damping.has("measured")) {
    damping.refuse_beside("measured", {"first_ratio", "last_ratio", "alpha_per_s", "beta_s"});
    return read_fit(damping);
  }
  if (damping.has("first_ratio") || damping.has("last_ratio")) {
    damping.refuse_beside("first_ratio", {"alpha_per_s", "beta_s"});
    return core::TwoRatioDamping{
        damping.number({"first_ratio", "damping ratio of the lowest mode in the band"},
                       allowed::damping_ratio),
        damping.number({"last_ratio", "damping ratio of the highest mode in the band"},
                       allowed::damping_ratio)};
  }
  return core::RayleighDamping{
      damping.number({"alpha_per_s", "mass-proportional coefficient: C = alpha M + beta K"},
                     allowed::alpha_per_s),
      damping.number({"beta_s", "stiffness-proportional coefficient: C = alpha M + beta K"},
                     allowed::beta_s)};
}

void read_isotropic(MapReader& reader, core::Material& material) {
  material.youngs_modulus_pa =
      reader.number({"youngs_modulus_pa", "Young's modulus of an isotropic material"},
                    reader.narrowed(allowed::youngs_modulus_pa,
                                    Range::positive(allowed::youngs_modulus_pa.high)));
  constexpr double softest_pa = allowed::youngs_modulus_pa.low;
  if (material.youngs_modulus_pa > 0.0 && material.youngs_modulus_pa < softest_pa) {
    reader.reject("youngs_modulus_pa",
                  fmt::format("{} Pa is softer than any solid (did you mean {}e9?)",
                              material.youngs_modulus_pa, material.youngs_modulus_pa));
  }
  material.poissons_ratio = reader.number(
      {"poissons_ratio", "Poisson's ratio of an isotropic material"}, allowed::poissons_ratio);
}

std::array<double, 3> three_numbers(MapReader& reader, const Key& key, const Range& range) {
  const Eigen::Vector3d numbers = reader.numbers(key, 3, range);
  return {numbers.x(), numbers.y(), numbers.z()};
}

void read_orthotropic(MapReader& reader, core::Material& material) {
  const std::size_t earlier_problems = reader.problems_in_file();
  for (const char* const key : {"youngs_modulus_pa", "poissons_ratio"}) {
    reader.refuse(key, "not beside youngs_moduli_pa, of an orthotropic material");
  }
  core::Orthotropy elasticity;
  elasticity.moduli = three_numbers(reader,
                                    {"youngs_moduli_pa",
                                     "of an orthotropic material, such as wood: Young's moduli "
                                     "along its axes 1, 2 and 3; unset: isotropic"},
                                    allowed::youngs_modulus_pa);
  elasticity.poissons_ratios =
      three_numbers(reader,
                    {"poissons_ratios",
                     "beside youngs_moduli_pa: 12, 13 and 23, ij being the contraction along j "
                     "over the extension along i under a load along i"},
                    allowed::poissons_ratios);
  elasticity.shear_moduli = three_numbers(
      reader, {"shear_moduli_pa", "beside youngs_moduli_pa: of the planes 12, 13 and 23"},
      allowed::youngs_modulus_pa);
  if (reader.has("axes_rotation_rad")) {
    elasticity.rotation_rad =
        three_numbers(reader,
                      {"axes_rotation_rad",
                       "beside youngs_moduli_pa: the material's axes are the plate frame's x, y "
                       "and z, turned about the direction of this vector by its length; unset: "
                       "not turned"},
                      {-6.3, 6.3});
  }
  if (reader.problems_in_file() > earlier_problems) {
    return;
  }
  material.youngs_modulus_pa = elasticity.moduli[0];
  for (std::array<double, 3>* const values : {&elasticity.moduli, &elasticity.shear_moduli}) {
    for (double& value : *values) {
      value /= material.youngs_modulus_pa;
    }
  }
  if (const auto fault = core::fault_of(elasticity)) {
    reader.reject(fault->property, fault->words);
  }
  material.orthotropy = elasticity;
}

core::Material read_material(MapReader& reader) {
  core::Material material;
  if (reader.has("youngs_moduli_pa")) {
    read_orthotropic(reader, material);
  } else {
    read_isotropic(reader, material);
  }
  material.density_kg_per_m3 =
      reader.number({"density_kg_per_m3", "density"}, allowed::density_kg_per_m3);
  reader.map({"damping",
              "Rayleigh coefficients; or ratios of the lowest and highest mode in the band; or "
              "measured ratios, fitted by Rayleigh damping; or one ratio per mode"},
             Presence::required,
             [&](MapReader& damping) { material.damping = read_damping(damping); });
  return material;
}

core::SinusoidShape::ByPlace read_by_place(MapReader& reader) {
  const Range coordinate_m{-10.0, 10.0};
  core::SinusoidShape::ByPlace by_place;
  const Eigen::Vector2d from_m =
      reader.numbers({"from_m", "where amplitude and frequency are as above, in the plate frame"},
                     2, coordinate_m);
  const Eigen::Vector2d to_m = reader.numbers(
      {"to_m",
       "where they are the factors' times as much; in between in proportion, beyond as at the end"},
      2, coordinate_m);
  by_place.from_m = {from_m.x(), from_m.y()};
  by_place.to_m = {to_m.x(), to_m.y()};
  if (from_m == to_m) {
    reader.reject("to_m", "is the same as from_m");
  }
  const Range factor{0.01, 100.0};
  by_place.amplitude_factor = reader.number({"amplitude_factor", "of the amplitude"}, factor, 1.0);
  by_place.frequency_factor = reader.number({"frequency_factor", "of the frequency"}, factor, 1.0);
  return by_place;
}

void read_sinusoid(MapReader& rendering, core::SinusoidShape& sinusoid) {
  rendering.map(
      {"sinusoid",
       "A e^(-decay t) sin(2 pi frequency t) after each impact, for techniques with the sinusoid; "
       "unset: none"},
      Presence::optional, [&](MapReader& reader) {
        sinusoid.amplitude_n_s_per_m = reader.number(
            {"amplitude_n_s_per_m", "A per impact speed; above 0 if a technique uses it"},
            allowed::sinusoid_amplitude_n_s_per_m);
        sinusoid.decay_per_s = reader.number({"decay_per_s", "decay rate of the amplitude"},
                                             allowed::sinusoid_decay_per_s, 600.0);
        sinusoid.frequency_hz = reader.number({"frequency_hz", "frequency of the sinusoid"},
                                              allowed::sinusoid_frequency_hz, 250.0);
        reader.map({"by_place",
                    "a sinusoid that tells where the impact was (Sreng et al. 2008); unset: it is "
                    "the same everywhere"},
                   Presence::optional,
                   [&](MapReader& inner) { sinusoid.by_place = read_by_place(inner); });
      });
}

void read_crossover(MapReader& rendering, Protocol& protocol) {
  if (!rendering.has("crossover_hz")) {
    return;
  }
  const Eigen::Vector2d edges_hz = rendering.numbers(
      {"crossover_hz",
       "two edges: modes below the first are rendered by the force device, above the second by the "
       "rig's actuator, in between by both; unset: all by the device"},
      2, {1.0, 5000.0});
  protocol.rendering.crossover = {edges_hz.x(), edges_hz.y()};
  if (edges_hz.x() >= edges_hz.y()) {
    rendering.reject("crossover_hz", "does not ascend");
  }
  if (edges_hz.y() >= protocol.rate_hz / 2.0) {
    rendering.reject("crossover_hz",
                     "does not end below half of rate_hz: what the device renders would alias");
  }
  protocol.stores_actuator = rendering.yes_or_no(
      {"stores_actuator",
       "what the actuator renders is stored with each trial, sample by sample; with crossover_hz"},
      true);
}

void read_band(MapReader& rendering, Protocol& protocol) {
  protocol.rate_hz =
      rendering.number({"rate_hz", "update rate of the haptic loop"}, {500.0, 10000.0});
  protocol.band_limit_hz = rendering.number(
      {"band_limit_hz",
       "modes above it are omitted; below half of rate_hz, unless there is a crossover"},
      Range::positive(1e5));
  read_crossover(rendering, protocol);
  if (!protocol.rendering.crossover && protocol.band_limit_hz >= protocol.rate_hz / 2.0) {
    rendering.reject("band_limit_hz",
                     "is not below half of rate_hz: higher modes cannot be "
                     "rendered and would alias");
  }
}
}  // namespace

void read_rendering(MapReader& top, Protocol& protocol) {
  core::RenderSettings& settings = protocol.rendering;
  top.map({"finger", "effective mass at impact; spring and damper through which vibration is felt"},
          Presence::required, [&](MapReader& finger) {
            settings.finger.mass_kg =
                finger.number({"mass_kg",
                               "effective mass at impact, grip included; for the technique "
                               "fem-coupled of the bare finger (0.0058)"},
                              Range::positive(10.0));
            settings.finger.stiffness_n_per_m = finger.number(
                {"stiffness_n_per_m", "vibration force per displacement of the plate"}, {0.0, 1e6});
            settings.finger.damping_n_s_per_m = finger.number(
                {"damping_n_s_per_m", "vibration force per velocity of the plate"}, {0.0, 1e4});
          });
  top.map(
      {"rendering", "haptic loop and contact forces"}, Presence::required,
      [&](MapReader& rendering) {
        read_band(rendering, protocol);
        settings.dt_s = 1.0 / protocol.rate_hz;
        settings.penalty_stiffness_n_per_m = rendering.number(
            {"penalty_stiffness_n_per_m", "contact spring: force per penetration depth"},
            allowed::penalty_stiffness_n_per_m);
        settings.release_height_m = rendering.number(
            {"release_height_m", "the finger must rise above it before the next impact counts"},
            {0.0, 0.1}, 5e-4);
        settings.integrator = rendering.one_of<core::Integrator>(
            {"integrator",
             "of the modes: exact recurrence, or Newmark's method with beta = 1/4, gamma = 1/2"},
            {{"exact", core::Integrator::exact}, {"newmark", core::Integrator::newmark}}, "exact");
        rendering.map(
            {"drop_modes",
             "leaves out modes that no tap excites: struck and felt at and around every tapping "
             "point they stay far below the strongest mode there; unset: none"},
            Presence::optional, [&](MapReader& drop) {
              DroppedModes& which = protocol.drop_modes.emplace();
              which.below_db = drop.number({"below_db", "so far below"}, {20.0, 300.0}, 60.0);
              which.within_m = drop.number(
                  {"within_m", "around a tapping point, on the plate; 0: the point alone"},
                  {0.0, 10.0}, 0.03);
            });
        read_sinusoid(rendering, settings.sinusoid);
        if (rendering.has("sinusoid") &&
            settings.sinusoid.highest_frequency_hz() >= protocol.rate_hz / 2.0 &&
            !(settings.crossover &&
              settings.crossover->actuator_share(settings.sinusoid.frequency_hz) == 1.0)) {
          rendering.reject("sinusoid",
                           "its frequency is not below half of rate_hz: it would alias");
        }
      });
}

void read_placement(MapReader& top, const Key& key, Presence presence,
                    const std::function<void(const core::Placement&)>& take) {
  top.map(key, presence, [&](MapReader& reader) {
    core::Placement placement;
    placement.origin_m = reader.numbers({"origin_m",
                                         "centre of the plate's upper face in the device frame: x "
                                         "right, y up, z towards the participant"},
                                        3, {-1.0, 1.0});
    placement.lateral_scale =
        reader.number({"lateral_scale",
                       "metres of device per metre of plate, sideways; 1 for surfaces from a file"},
                      Range::positive(1000.0));
    take(placement);
  });
}

void read_materials(MapReader& top, Protocol& protocol) {
  top.each(
      {"materials", "named materials: homogeneous, linearly elastic, isotropic or orthotropic"},
      Presence::required, [&](const std::string& name, MapReader& reader) {
        protocol.materials[name] = std::make_shared<const Material>(
            Material{read_material(reader), reader.stated_at("damping")});
      });
}

// Measured transients, by name.
namespace {
constexpr Range recorded_place_m{-10.0, 10.0};
constexpr Range force_n{-1e4, 1e4};  // devices limit what they push
constexpr std::size_t max_samples = 100'000;

core::RecordedTap read_tap(MapReader& reader) {
  core::RecordedTap tap;
  tap.at_m = reader.numbers(
      {"at_m", "place of the tap, x, y in the plate frame; an impact plays the nearest"}, 2,
      recorded_place_m);
  tap.speed_m_s =
      reader.number({"speed_m_s", "speed of the impact; the force is scaled in proportion to it"},
                    Range::positive(100.0));
  tap.force_n = reader.number_list({"force_n",
                                    "vibration force on the finger from the impact on, outward "
                                    "positive, without the contact force"},
                                   force_n);
  reader.check("force_n", tap.force_n.size() <= max_samples,
               fmt::format(R"({{"maxItems": {}}})", max_samples),
               fmt::format("has {} samples (at most {})", tap.force_n.size(), max_samples));
  return tap;
}
}  // namespace

void read_recordings(MapReader& top, Protocol& protocol) {
  top.each(
      {"recordings", "measured transients by name, played by technique recorded; unset: none"},
      MapReader::Presence::optional, [&](const std::string& name, MapReader& reader) {
        core::RecordedTaps recorded;
        recorded.rate_hz = reader.number(
            {"rate_hz",
             "samples a second; they are resampled to the loop's rate, limited to the lower band"},
            {100.0, 200'000.0});
        reader.list({"taps",
                     "measured taps, each at a place; of several at one place the one whose speed "
                     "is nearest is played"},
                    MapReader::Presence::at_least_one,
                    [&](MapReader& tap) { recorded.taps.push_back(read_tap(tap)); });
        protocol.recordings[name] = std::make_shared<const core::RecordedTaps>(std::move(recorded));
      });
}
}  // namespace tapstudy::protocols
