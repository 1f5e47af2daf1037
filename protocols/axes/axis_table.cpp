#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "protocols/axes/axis.hpp"
#include "protocols/axes/presented_stimulus.hpp"
namespace tapstudy::protocols {
namespace {
constexpr double max_factor = 100.0;  // of damping and gain

template <class Change>
void change_material(PresentedStimulus& stimulus, const Change& change) {
  Material material = *stimulus.material;
  change(material);
  stimulus.material = std::make_shared<const Material>(std::move(material));
}

template <class Change>
void change_plate(PresentedStimulus& stimulus, const Change& change) {
  Plate plate = *stimulus.plate;
  change(plate);
  stimulus.plate = std::make_shared<const Plate>(std::move(plate));
}

template <const Range& range>
Range constant(const PresentedStimulus& /*stimulus*/) {
  return range;
}

// The largest coefficient or ratio, as a share of what its key allows.
double share_used(const core::RayleighDamping& damping) {
  return std::max(damping.alpha_per_s / allowed::alpha_per_s.high,
                  damping.beta_s / allowed::beta_s.high);
}
double share_used(const core::TwoRatioDamping& damping) {
  return std::max(damping.first_ratio, damping.last_ratio) / allowed::damping_ratio.high;
}
double share_used(const core::FittedDamping& damping) {
  double largest = 0.0;
  for (const core::FittedDamping::Point& point : damping.points) {
    largest = std::max(largest, point.ratio);
  }
  return largest / allowed::damping_ratio.high;
}
double share_used(const core::ModalDamping& damping) {
  double largest = damping.further_ratio.value_or(0.0);
  for (const double ratio : damping.ratios) {
    largest = std::max(largest, ratio);
  }
  return largest / allowed::damping_ratio.high;
}
double share_used(const core::ConstantDamping& damping) {
  return damping.ratio / allowed::damping_ratio.high;
}
// Scaled damping stays within what its keys allow.
Range damping_factors(const PresentedStimulus& stimulus) {
  const double share = std::visit([](const auto& damping) { return share_used(damping); },
                                  stimulus.material->damping);
  return {0.0, max_factor * share > 1.0 ? 1.0 / share : max_factor};
}
Range gains(const PresentedStimulus& /*stimulus*/) {
  return {0.0, max_factor};
}
// Above half of the rate a sinusoid would alias.
Range frequencies_hz(const PresentedStimulus& stimulus) {
  Range range = allowed::sinusoid_frequency_hz;
  core::SinusoidShape of_one_hz = stimulus.rendering.sinusoid;
  of_one_hz.frequency_hz = 1.0;
  const double half_rate_hz = 0.5 / stimulus.rendering.dt_s / of_one_hz.highest_frequency_hz();
  if (half_rate_hz <= range.high) {
    range.high = half_rate_hz;
    range.high_included = false;
  }
  return range;
}

const core::Box& box_of(const PresentedStimulus& stimulus) {
  return std::get<core::Box>(stimulus.plate->shape);
}

// Sideways everything moves with the edges but radii, such as of a screw's head: fixations and
// tapping points. On the device the plate stays as large as it is and is tapped at the same places:
// participants must not tell plates apart by these.
void set_lateral_size(PresentedStimulus& stimulus, double size_m) {
  change_plate(stimulus, [&](Plate& plate) {
    auto& box = std::get<core::Box>(plate.shape);
    const double factor = size_m / box.size_m.x();
    box.size_m.x() = size_m;
    box.size_m.y() *= factor;
    for (core::Fixation& fixation : plate.fixations) {
      for (core::Vec3* const place : {&fixation.at_m, &fixation.low_m, &fixation.high_m}) {
        place->head<2>() *= factor;
      }
    }
    for (auto& [name, at_m] : plate.tapping_points_m) {
      at_m *= factor;
    }
    plate.lateral_ratio /= factor;
  });
  stimulus.rendering.lateral_ratio = stimulus.plate->lateral_ratio;
}
// Such that the other edge stays within what its key allows.
Range lateral_sizes_m(const PresentedStimulus& stimulus) {
  const core::Vec3& size_m = box_of(stimulus).size_m;
  const double aspect = size_m.x() / size_m.y();
  const Range& edge = allowed::edge_m;
  return {edge.low * std::max(1.0, aspect), edge.high * std::min(1.0, aspect)};
}

using Rendering = core::RenderSettings;
using Sinusoid = core::SinusoidShape;
template <double Rendering::*member>
double of_rendering(const PresentedStimulus& stimulus) {
  return stimulus.rendering.*member;
}
template <double Rendering::*member>
void set_rendering(PresentedStimulus& stimulus, double value) {
  stimulus.rendering.*member = value;
}
template <double Sinusoid::*member>
double of_sinusoid(const PresentedStimulus& stimulus) {
  return stimulus.rendering.sinusoid.*member;
}
template <double Sinusoid::*member>
void set_sinusoid(PresentedStimulus& stimulus, double value) {
  stimulus.rendering.sinusoid.*member = value;
}

bool vibrates(const core::Technique& technique) {
  return technique.needs_model();
}
bool vibrates_as_a_solid(const core::Technique& technique) {
  return technique.needs_model() && !technique.needs_beam();
}
bool scales_vibration(const core::Technique& technique) {
  return technique.has(core::plate_vibration) || technique.has(core::recorded_transient);
}
bool has_sinusoid(const core::Technique& technique) {
  return technique.has(core::decaying_sinusoid);
}
using P = PresentedStimulus;
constexpr std::array table{
    Axis{"youngs_modulus_pa", "Young's modulus", "Pa",
         "Young's modulus, of an orthotropic material along its first axis, the others and the "
         "shear moduli in proportion; for techniques with the plate's vibration",
         AxisKind::scaled, vibrates, false, true, constant<allowed::youngs_modulus_pa>,
         allowed::youngs_modulus_pa,
         [](const P& stimulus) { return stimulus.material->youngs_modulus_pa; },
         [](P& stimulus, double value) {
           change_material(stimulus, [&](Material& m) { m.youngs_modulus_pa = value; });
         },
         true},
    Axis{"density_kg_per_m3", "density", "kg/m³",
         "density; for techniques with the plate's vibration", AxisKind::scaled, vibrates, false,
         false, constant<allowed::density_kg_per_m3>, allowed::density_kg_per_m3,
         [](const P& stimulus) { return stimulus.material->density_kg_per_m3; },
         [](P& stimulus, double value) {
           change_material(stimulus, [&](Material& m) { m.density_kg_per_m3 = value; });
         },
         true},
    Axis{"damping_scale",
         "damping scale",
         "",
         "factor on every damping ratio of the material; for techniques with the plate's vibration",
         AxisKind::scaled,
         vibrates,
         false,
         false,
         damping_factors,
         {0.0, max_factor},
         [](const P& /*stimulus*/) { return 1.0; },
         [](P& stimulus, double value) {
           change_material(stimulus,
                           [&](Material& m) { m.damping = core::scaled(m.damping, value); });
         }},
    Axis{"vibration_gain",
         "vibration gain",
         "",
         "factor on the vibration force; for techniques of fem, beam and recorded; not of "
         "fem-coupled, where a scaled reaction would not be passive",
         AxisKind::scaled,
         scales_vibration,
         false,
         false,
         gains,
         {0.0, max_factor},
         of_rendering<&Rendering::vibration_gain>,
         set_rendering<&Rendering::vibration_gain>,
         false,
         true},
    Axis{"sinusoid_amplitude_n_s_per_m", "sinusoid amplitude", "N s/m",
         "amplitude per impact speed; for techniques with the sinusoid", AxisKind::scaled,
         has_sinusoid, false, false, constant<allowed::sinusoid_amplitude_n_s_per_m>,
         allowed::sinusoid_amplitude_n_s_per_m, of_sinusoid<&Sinusoid::amplitude_n_s_per_m>,
         set_sinusoid<&Sinusoid::amplitude_n_s_per_m>, false, true},
    Axis{"sinusoid_decay_per_s", "sinusoid decay rate", "1/s",
         "decay rate of the amplitude; for techniques with the sinusoid", AxisKind::scaled,
         has_sinusoid, false, false, constant<allowed::sinusoid_decay_per_s>,
         allowed::sinusoid_decay_per_s, of_sinusoid<&Sinusoid::decay_per_s>,
         set_sinusoid<&Sinusoid::decay_per_s>, false, true},
    Axis{"sinusoid_frequency_hz", "sinusoid frequency", "Hz",
         "frequency, below half of rate_hz; for techniques with the sinusoid", AxisKind::scaled,
         has_sinusoid, false, false, frequencies_hz, allowed::sinusoid_frequency_hz,
         of_sinusoid<&Sinusoid::frequency_hz>, set_sinusoid<&Sinusoid::frequency_hz>, false, true},
    Axis{"penalty_stiffness_n_per_m", "contact stiffness", "N/m",
         "contact spring; for every technique", AxisKind::scaled, nullptr, false, false,
         constant<allowed::penalty_stiffness_n_per_m>, allowed::penalty_stiffness_n_per_m,
         of_rendering<&Rendering::penalty_stiffness_n_per_m>,
         set_rendering<&Rendering::penalty_stiffness_n_per_m>, false, true},
    Axis{"poissons_ratio", "Poisson's ratio", "",
         "Poisson's ratio, a model for each value; for techniques with the plate's vibration",
         AxisKind::tabled, vibrates_as_a_solid, false, false, constant<allowed::poissons_ratio>,
         allowed::poissons_ratio,
         [](const P& stimulus) { return stimulus.material->poissons_ratio; },
         [](P& stimulus, double value) {
           change_material(stimulus, [&](Material& m) { m.poissons_ratio = value; });
         },
         false, false, true},
    Axis{
        "thickness_m", "thickness", "m",
        "thickness of a box, a model for each value; fixations stay where they are; for techniques "
        "with the plate's vibration",
        AxisKind::tabled, vibrates, true, false, constant<allowed::edge_m>, allowed::edge_m,
        [](const P& stimulus) { return box_of(stimulus).size_m.z(); },
        [](P& stimulus, double value) {
          change_plate(stimulus,
                       [&](Plate& plate) { std::get<core::Box>(plate.shape).size_m.z() = value; });
        }},
    Axis{"lateral_size_m", "lateral size", "m",
         "edge of a box along x, a model for each value; the other edge, fixations (not their "
         "radii) "
         "and tapping points move with it, on the device the plate stays as large as it is; for "
         "techniques with the plate's vibration",
         AxisKind::tabled, vibrates, true, false, lateral_sizes_m, allowed::edge_m,
         [](const P& stimulus) { return box_of(stimulus).size_m.x(); }, set_lateral_size, true},
};
}  // namespace

const std::vector<Axis>& axes() {
  static const std::vector<Axis> all{table.begin(), table.end()};
  return all;
}

const Axis* find_axis(std::string_view name) {
  const auto found = std::ranges::find(axes(), name, &Axis::name);
  return found == axes().end() ? nullptr : &*found;
}

std::vector<std::string> axis_names() {
  std::vector<std::string> names;
  std::ranges::transform(axes(), std::back_inserter(names),
                         [](const Axis& axis) { return std::string{axis.name}; });
  return names;
}

std::string refusal(const Axis& axis, const PresentedStimulus& stimulus) {
  if (axis.is_used_by != nullptr && !axis.is_used_by(*stimulus.technique)) {
    std::vector<std::string_view> users;
    for (const core::Technique& technique : core::techniques()) {
      if (axis.is_used_by(technique)) {
        users.push_back(technique.name);
      }
    }
    return fmt::format("technique '{}' does not use it ({} do)", stimulus.technique->name,
                       fmt::join(users, ", "));
  }
  if (axis.is_of_boxes && !std::holds_alternative<core::Box>(stimulus.plate->shape)) {
    return "only a plate given by size_m has it, not one with a surface from a file";
  }
  if (axis.is_of_isotropic && stimulus.material->orthotropy) {
    return "an orthotropic material has three of them (name stimuli of several materials instead)";
  }
  if (axis.is_without_springs && core::is_on_springs(stimulus.plate->fixations)) {
    return "a plate on springs does not scale with it (name stimuli of several materials instead)";
  }
  if (axis.is_without_contacts && stimulus.contacts) {
    return "a plate in contact with other bodies does not scale with it (name stimuli of several "
           "materials or sizes instead)";
  }
  return {};
}
}  // namespace tapstudy::protocols
