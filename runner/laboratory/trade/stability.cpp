#include "runner/laboratory/trade/stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>

#include "core/error.hpp"
#include "core/haptics/haptic_state.hpp"
#include "core/model/shape/shape.hpp"
#include "core/model/shells/shell_elements.hpp"
#include "core/techniques/technique.hpp"
#include "device/hand/penalty_limit.hpp"
#include "runner/laboratory/trade/rendering_accuracy.hpp"
#include "runner/session/stimuli/model_library.hpp"
namespace tapstudy::runner {
namespace {
constexpr double lasts_s = 2.0;
constexpr double last_part_s = 0.1;
constexpr double approach_s = 0.05;
constexpr double min_speed_m_s = 1e-6;
constexpr double pressing_s = 0.5;
constexpr double highest_m = 0.01;

device::PlannedTap planned(const TestTap& tap, const core::Placement& placement) {
  device::PlannedTap plan;
  plan.point_m = placement.point_to_device(tap.at_m);
  plan.speed_m_s = std::max(tap.speed_m_s, min_speed_m_s);
  plan.hover_m = std::min(highest_m, approach_s * plan.speed_m_s);
  plan.run_up_m = 0.0;
  plan.press_m = std::min(tap.press_m, pressing_s * plan.speed_m_s);
  plan.dwell_s = lasts_s;
  return plan;
}

class Swing {
 public:
  void add(double value) {
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
  }
  double size() const { return std::max(0.0, high_ - low_); }

 private:
  double low_{HUGE_VAL};
  double high_{-HUGE_VAL};
};

// Amplitude of the force oscillation at the end, relative to the whole duration.
class Parts {
 public:
  void add(double value, bool is_at_the_end) {
    whole_.add(value);
    if (is_at_the_end) {
      end_.add(value);
    }
  }
  double left() const { return whole_.size() > 0.0 ? end_.size() / whole_.size() : 0.0; }

 private:
  Swing whole_;
  Swing end_;
};
}  // namespace

LoopBehaviour tap_and_stay(core::TapRenderer& renderer, const core::HandBody& body, double dt_s,
                           const TestTap& tap) {
  const core::Placement placement;
  device::SimulatedHand hand{body, dt_s, device::SimulatedHand::Memory::none};
  hand.follow({planned(tap, placement)});
  LoopBehaviour behaviour;
  Parts penalty;
  Parts vibration;
  const auto ticks = static_cast<int>(std::lround(lasts_s / dt_s));
  const auto last_part = static_cast<int>(std::lround((lasts_s - last_part_s) / dt_s));
  double energy_j = 0.0;
  for (int tick = 0; tick < ticks && behaviour.is_finite; ++tick) {
    core::HandState state;
    static_cast<void>(hand.read(state, dt_s));
    core::HandState tip = placement.to_plate(state);
    tip.position_m.x() += tap.sliding_m * tick / ticks;
    const core::RenderedTick rendered = renderer.tick(tip);
    static_cast<void>(hand.write(core::Placement::force_to_device(rendered.force_n)));
    const double before_j = std::exchange(energy_j, renderer.energy_j());
    behaviour.is_finite = rendered.force_n.allFinite() && std::isfinite(energy_j);
    if (rendered.contact.impact) {
      ++behaviour.impacts;
    } else {
      behaviour.max_gain_j = std::max(behaviour.max_gain_j, energy_j - before_j);
    }
    behaviour.max_energy_j = std::max(behaviour.max_energy_j, energy_j);
    behaviour.max_force_n = std::max(behaviour.max_force_n, std::abs(rendered.parts.total_n()));
    penalty.add(rendered.parts.penalty_n, tick >= last_part);
    vibration.add(rendered.parts.vibration_n, tick >= last_part);
  }
  behaviour.residual_oscillation = std::max(penalty.left(), vibration.left());
  return behaviour;
}

namespace {
constexpr double rounding = 1e-12;
constexpr double little_left = 0.01;
constexpr double tets_at_most = 1000.0;

// A tapped stimulus whose parameters are set to one extreme at a time.
struct Stage {
  core::PlateSpec plate;
  core::RenderSettings rendering;
  core::HandBody hand;
  TestTap tap;
  Eigen::Vector2d point_m;              // where it is tapped
  std::optional<double> damping_ratio;  // of every mode, instead of the material's
  bool has_vibration{true};
};

double top_m(const core::Shape& shape, const Eigen::Vector2d& point_m) {
  return core::TopHeight{shape}.at_m(point_m).value_or(0.0);
}

// Its first tapping point over the body.
Eigen::Vector2d point_on(const protocols::Plate& plate) {
  const core::TopHeight top{plate.shape};
  for (const auto& [name, point_m] : plate.tapping_points_m) {
    if (top.at_m(point_m)) {
      return point_m;
    }
  }
  return Eigen::Vector2d::Zero();
}

Stage stage_of(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus) {
  const protocols::PresentedStimulus presented = stimulus_with(protocol, stimulus);
  Stage stage{plate_spec(protocol, presented),
              presented.rendering,
              protocol.simulation.hand,
              {},
              point_on(*presented.plate),
              {},
              true};
  stage.plate.mesh.accuracy.reset();
  stage.plate.mesh.is_automatic = false;
  stage.plate.mesh.size.max_tet_volume_m3 =
      std::abs(core::volume_m3(stage.plate.shape)) / tets_at_most;
  stage.tap.speed_m_s = protocol.simulation.taps.speed_m_s;
  stage.tap.press_m = protocol.simulation.taps.press_m;
  return stage;
}

Outcome outcome_of(const LoopBehaviour& seen) {
  if (!seen.is_finite || seen.max_gain_j > rounding * seen.max_energy_j) {
    return Outcome::failed;
  }
  return seen.residual_oscillation <= little_left ? Outcome::dies_out : Outcome::persists;
}

std::string described(const LoopBehaviour& seen) {
  const std::string left = seen.residual_oscillation < 1e-6
                               ? "nothing"
                               : fmt::format("{:.3g} %", 100.0 * seen.residual_oscillation);
  return fmt::format("{} impact{}, plate {:.2g} J and force {:.3g} N at most, {} of the swing left",
                     seen.impacts, seen.impacts == 1 ? "" : "s", seen.max_energy_j,
                     seen.max_force_n, left);
}

std::string described(const core::PlateModel& plate) {
  const int rigid = plate.body.modes.report.rigid_body_modes;
  return fmt::format("{} mode{}{}, ", plate.modal.frequency_hz.size(),
                     plate.modal.frequency_hz.size() == 1 ? "" : "s",
                     rigid > 0 ? fmt::format(" and {} of the rigid body", rigid) : "");
}

// The hand taps and stays.
void play(const Stage& stage, const core::VibratingPlate* plate, StabilityCase& played) {
  const core::Technique penalty_alone{"penalty alone", {}};
  core::TapRenderer renderer =
      core::make_renderer(plate != nullptr ? plate_alone() : penalty_alone, stage.rendering,
                          touched_shape(stage.plate.shape), plate);
  TestTap tap = stage.tap;
  tap.at_m << stage.point_m, top_m(stage.plate.shape, stage.point_m);
  const LoopBehaviour seen = tap_and_stay(renderer, stage.hand, stage.rendering.dt_s, tap);
  const bool has_missed = seen.is_finite && seen.impacts == 0 && stage.tap.speed_m_s > 0.0;
  played.outcome = has_missed ? Outcome::refused : outcome_of(seen);
  played.words += has_missed ? "the hand did not touch the body" : described(seen);
}

// That bend a plate, by Weyl's law: A k² / 4 pi less the rim's share of held ones, P k / 4 pi, k
// being the number of waves in bending at the band's limit; 0 where these tell nothing.
double modes_expected(const core::PlateSpec& plate) {
  const auto* const box = std::get_if<core::Box>(&plate.shape);
  const core::Material& material = plate.material;
  if (box == nullptr || material.orthotropy || plate.joints) {
    return 0.0;
  }
  const core::Vec3& size_m = box->size_m;
  const double rigidity_n_m = material.youngs_modulus_pa * std::pow(size_m.z(), 3) /
                              (12.0 * (1.0 - std::pow(material.poissons_ratio, 2)));
  const double k2 = 2.0 * std::numbers::pi * plate.band_limit_hz *
                    std::sqrt(material.density_kg_per_m3 * size_m.z() / rigidity_n_m);
  const bool is_thin = k2 * size_m.z() * size_m.z() < 1.0;
  const double rim_m = 2.0 * (size_m.x() + size_m.y());
  const double count =
      (size_m.x() * size_m.y() * k2 - rim_m * std::sqrt(k2)) / (4.0 * std::numbers::pi);
  return is_thin ? std::max(0.0, count) : 0.0;
}

StabilityCase play(const std::string& property, double value, const Stage& stage,
                   const core::ProgressHook& progress) {
  StabilityCase played{property, value, Outcome::refused, {}};
  try {
    if (!stage.has_vibration) {
      play(stage, nullptr, played);
      return played;
    }
    core::PlateModel built = core::build_plate_model(stage.plate, progress);
    played.words = described(built);
    const auto found = static_cast<double>(built.modal.frequency_hz.size());
    const double expected = modes_expected(stage.plate);
    if (found == 0.0 || found < 0.5 * expected) {
      played.outcome = Outcome::untested;
      played.words += found == 0.0 ? fmt::format("none below {:g} Hz", stage.plate.band_limit_hz)
                                   : fmt::format("where about {:.0f} are expected below {:g} Hz",
                                                 expected, stage.plate.band_limit_hz);
      return played;
    }
    if (stage.damping_ratio) {
      built.modal.damping_ratio.setConstant(*stage.damping_ratio);
    }
    const core::VibratingPlate plate = vibrating_plate(stage.plate.shape, std::move(built.modal));
    play(stage, &plate, played);
  } catch (const core::ModelError& error) {
    played.words = error.what();
  } catch (const core::InvalidInput& error) {
    played.words = error.what();
  }
  return played;
}

struct Extreme {
  std::string property;
  std::vector<double> values;
  std::function<void(Stage&, double)> set;
};

// An orthotropic material has no single Poisson's ratio, and keeps its own.
std::vector<Extreme> of_the_material(const core::Material& material) {
  std::vector<Extreme> extremes{
      {"youngs_modulus_pa",
       {1e3, 1e6, 1e9, 1e12},
       [](Stage& stage, double value) { stage.plate.material.youngs_modulus_pa = value; }},
      {"density_kg_per_m3",
       {1.0, 100.0, 20000.0},
       [](Stage& stage, double value) { stage.plate.material.density_kg_per_m3 = value; }},
      {"poissons_ratio",
       {-0.9, 0.0, 0.499, 0.4999},
       [](Stage& stage, double value) { stage.plate.material.poissons_ratio = value; }},
      {"damping_ratio",
       {0.0, 0.5, 1.0 - 1e-12, 1.0, 1.0 + 1e-12, 2.0, 100.0},
       [](Stage& stage, double value) { stage.damping_ratio = value; }}};
  if (material.orthotropy) {
    std::erase_if(extremes, [](const Extreme& one) { return one.property == "poissons_ratio"; });
  }
  return extremes;
}

// Sheets have shells: flat tetrahedra bend too stiffly, and most modes would not be in the band.
void make_thickness(Stage& stage, double to_width) {
  if (auto* box = std::get_if<core::Box>(&stage.plate.shape)) {
    constexpr double part_of_width = 0.25;
    box->size_m.z() = to_width * box->size_m.x();
    stage.plate.mesh.size.max_tet_volume_m3 = box->size_m.prod() / tets_at_most;
    stage.plate.mesh.shell_width_m.reset();
    if (core::is_sheet(stage.plate.shape)) {
      stage.plate.mesh.shell_width_m = part_of_width * std::min(box->size_m.x(), box->size_m.y());
    }
  }
}

std::vector<Extreme> of_the_body() {
  return {{"thickness_to_width", {1.0, 0.1, 0.01, 0.001}, make_thickness},
          {"fixations_held", {0.0}, [](Stage& stage, double) { stage.plate.fixations.clear(); }}};
}

std::vector<Extreme> of_the_tap(double penalty_limit_n_per_m) {
  std::vector<double> penalties;
  for (const double part : {0.1, 0.5, 0.9, 1.1, 2.0, 10.0}) {
    penalties.push_back(part * penalty_limit_n_per_m);
  }
  return {
      {"speed_m_s",
       {0.0, 0.001, 0.03, 1.0, 10.0},
       [](Stage& stage, double value) { stage.tap.speed_m_s = value; }},
      {"sliding_m", {0.01, 0.1}, [](Stage& stage, double value) { stage.tap.sliding_m = value; }},
      {"press_m", {0.0, 1e-6}, [](Stage& stage, double value) { stage.tap.press_m = value; }},
      {"penalty_stiffness_n_per_m", penalties, [](Stage& stage, double value) {
         stage.rendering.penalty_stiffness_n_per_m = value;
         stage.has_vibration = false;
       }}};
}
}  // namespace

std::string_view name(Outcome outcome) {
  switch (outcome) {
    case Outcome::dies_out:
      return "dies out";
    case Outcome::persists:
      return "persists";
    case Outcome::refused:
      return "refused";
    case Outcome::untested:
      return "nothing tested";
    case Outcome::failed:
      break;
  }
  return "FAILED";
}

Stability measure_stability(const protocols::Protocol& protocol,
                            const protocols::Stimulus& stimulus,
                            const core::ProgressHook& progress) {
  const Stage normal = stage_of(protocol, stimulus);
  Stability stability;
  stability.penalty_limit_n_per_m =
      device::largest_stable_penalty_n_per_m(normal.hand, normal.rendering.dt_s);
  for (const auto& group : {of_the_material(normal.plate.material), of_the_body(),
                            of_the_tap(stability.penalty_limit_n_per_m)}) {
    for (const Extreme& extreme : group) {
      for (const double value : extreme.values) {
        Stage stage = normal;
        extreme.set(stage, value);
        core::tell(progress, fmt::format("{} {:g}", extreme.property, value));
        stability.cases.push_back(play(extreme.property, value, stage, progress));
      }
    }
  }
  return stability;
}
}  // namespace tapstudy::runner
