#include "runner/commands/check_models.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/smooth_normals.hpp"
#include "core/model/cubic_elements.hpp"
#include "core/model/element_order.hpp"
#include "core/model/mesh/tetgen_mesher.hpp"
#include "core/model/progress.hpp"
#include "core/model/shells/sheet_body.hpp"
#include "core/model/shells/shell_elements.hpp"
#include "core/techniques/compensated.hpp"
#include "core/techniques/technique.hpp"
#include "protocols/tasks/task.hpp"
#include "runner/session/stimuli/stimulus_family.hpp"
#include "runner/session/trial_loop/real_plates.hpp"
#include "runner/studies/counted.hpp"
namespace tapstudy::runner {
namespace {
double megabytes(const core::BodyModes& body) {
  const auto bytes = [](const auto& matrix) {
    return 1e-6 * static_cast<double>(sizeof(*matrix.data())) * static_cast<double>(matrix.size());
  };
  return bytes(body.shape) + bytes(body.touch_nodes_m) + bytes(body.touch_surface);
}

void print_crossings(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus,
                     const core::BodyModes& body) {
  for (const protocols::AxisRange& range : stimulus.vary) {
    const auto crossings = band_crossings(protocol, stimulus, range, body);
    if (!crossings.empty()) {
      fmt::print(
          "    note: a mode crosses the band limit at {} {:.3g}{}: a difference across such a "
          "value "
          "is told by the mode\n",
          range.axis->name, fmt::join(crossings, ", "),
          range.axis->unit.empty() ? "" : fmt::format(" {}", range.axis->unit));
    }
  }
}

void print_cost(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus,
                ModelLibrary& models) {
  const BandEnds ends = band_ends(protocol, stimulus);
  double solved_s = 0.0;
  double held_mb = 0.0;
  const auto bodies = models.bodies_of(protocol, stimulus);
  for (const ModelLibrary::Body& body : bodies) {
    solved_s += body->report.cost.total_s();
    held_mb += megabytes(*body);
  }
  core::Stopwatch watch;
  const auto most = models.plate_of(protocol, stimulus_with(protocol, stimulus, ends.most));
  const double member_s = watch.elapsed_s();
  const auto fewest = models.plate_of(protocol, stimulus_with(protocol, stimulus, ends.fewest));
  fmt::print("    {}, solved in {:.3f} s, {:.1f} MB; a member takes {:.1f} ms more\n",
             counted(bodies.size(), "model"), solved_s, held_mb, 1e3 * member_s);
  const auto least = static_cast<std::size_t>(fewest->model.frequency_hz.size());
  const auto greatest = static_cast<std::size_t>(most->model.frequency_hz.size());
  fmt::print("    {}{} below {} Hz at its own values of table axes\n",
             least == greatest ? "" : fmt::format("{} to ", least), counted(greatest, "mode"),
             protocol.band_limit_hz);
  print_crossings(protocol, stimulus, *models.body_of(protocol, stimulus_with(protocol, stimulus)));
}
}  // namespace

void print_families(const protocols::Protocol& protocol, ModelLibrary& models) {
  models.build_all(protocol);
  bool is_first = true;
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (stimulus.vary.empty()) {
      continue;
    }
    fmt::print("{}", is_first ? "\nfamilies\n" : "");
    is_first = false;
    std::vector<std::string> axes;
    std::ranges::transform(stimulus.vary, std::back_inserter(axes),
                           &protocols::AxisRange::described);
    fmt::print("  {}: {}\n", stimulus.name, fmt::join(axes, "; "));
    if (stimulus.technique->needs_model()) {
      print_cost(protocol, stimulus, models);
    } else {
      fmt::print("    no model: settings alone\n");
    }
  }
}

namespace {
struct Strike {
  std::string point;
  double energy_share{};
};
Strike strongest(const core::VibratingPlate& plate, const protocols::PresentedStimulus& stimulus) {
  Strike most;
  for (const auto& [name, at_m] : stimulus.plate->tapping_points_m) {
    const double share = impact_energy_share(plate, at_m, stimulus.rendering.finger.mass_kg);
    most = share > most.energy_share ? Strike{name, share} : most;
  }
  return most;
}
}  // namespace

double impact_energy_share(const core::VibratingPlate& plate, const Eigen::Vector2d& at_m,
                           double finger_kg) {
  return finger_kg * modes_at(plate, at_m).squaredNorm();
}

namespace {
std::string describe_accuracy(const core::Meshing& mesh, const AutomaticMesh& automatic) {
  if (!mesh.is_automatic) {
    return mesh.accuracy ? fmt::format("an accuracy of {:.2g} %", 100.0 * *mesh.accuracy)
                         : std::string{"the stated mesh, no accuracy is asked for"};
  }
  const auto& difference = automatic.difference;
  return fmt::format(
      "an accuracy of {:.2g} % (mesh: auto{})", 100.0 * automatic.accuracy,
      difference ? fmt::format("; {} and {} differ by {:.2g} %, the least", difference->first,
                               difference->second, 100.0 * difference->relative)
                 : std::string{});
}
}  // namespace

std::string describe_spending(const protocols::Protocol& protocol,
                              const protocols::PresentedStimulus& stimulus, ModelLibrary& models) {
  const auto body = models.body_of(protocol, stimulus);
  const core::PlateSpec spec = plate_spec(protocol, stimulus);
  const core::VibratingPlate whole = vibrating_plate(spec.shape, core::model_of(*body, spec));
  const auto which = protocol.drop_modes.value_or(protocols::DroppedModes{});
  const auto unfelt = unfelt_modes(whole, stimulus, which);
  const Eigen::Index all = whole.model.frequency_hz.size();
  const Eigen::Index rendered = models.plate_of(protocol, stimulus)->model.frequency_hz.size();
  const bool is_automatic = spec.mesh.is_automatic;
  std::string lines = fmt::format(
      "    spent: {} degrees of freedom, {:.3g} s and {:.3g} s of estimating, for {}; {} of {} in "
      "each tick\n",
      body->report.dofs, body->report.cost.total_s(), body->estimate.seconds,
      describe_accuracy(spec.mesh,
                        is_automatic ? models.automatic_mesh(protocol) : AutomaticMesh{}),
      rendered, counted(static_cast<std::size_t>(all), "mode"));
  if (!unfelt.empty()) {
    lines += fmt::format(
        "    {} modes that no tap within {} m of a tapping point excites ({:.0f} dB below the "
        "strongest there): {}\n",
        protocol.drop_modes ? "dropped:" : "rendering.drop_modes would leave out", which.within_m,
        which.below_db, describe(unfelt));
  }
  return lines;
}

void warn_of_light_plates(const protocols::Protocol& protocol, ModelLibrary& models) {
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (!stimulus.technique->needs_model()) {
      continue;
    }
    const protocols::PresentedStimulus own = stimulus_with(protocol, stimulus);
    const int rigid = models.body_of(protocol, own)->report.rigid_body_modes;
    if (rigid > 0) {
      fmt::print(
          "  warning: {} can move as a rigid body in {}, which are left out: there it is felt as "
          "held (fix it, or put it on springs)\n",
          stimulus.name, counted(static_cast<std::size_t>(rigid), "way"));
    }
    const Strike strike = strongest(*models.plate_of(protocol, own), own);
    if (stimulus.technique->has(core::plate_vibration) && strike.energy_share > 1.0) {
      fmt::print(
          "  warning: {} is too light for the finger: struck at {} it takes {:.3g} times the "
          "finger's energy (a smaller mass_kg; fem-coupled takes from the finger what it gives)\n",
          stimulus.name, strike.point, strike.energy_share);
    }
  }
}

namespace {
constexpr double usual_band_hz = 300.0;
constexpr double least_gain = 0.5;

double device_share(const protocols::Protocol& protocol, double frequency_hz) {
  const auto& crossover = protocol.rendering.crossover;
  return crossover ? 1.0 - crossover->actuator_share(frequency_hz) : 1.0;
}

struct Band {
  double highest_hz{};
  const core::DeviceResponse* response{};  // nullptr: not measured
  std::string words;
  bool holds(double frequency_hz) const {
    return frequency_hz <= highest_hz &&
           (response == nullptr || core::gain_at(frequency_hz, *response) >= least_gain);
  }
};

std::optional<Band> band_of(const protocols::Rig& rig) {
  const core::DeviceResponse* const response = rig.vibration_response.get();
  if (!rig.vibration_band_hz && response == nullptr && !rig.has_hardware) {
    return std::nullopt;
  }
  Band band{std::numeric_limits<double>::infinity(), response, {}};
  if (rig.vibration_band_hz || response == nullptr) {
    band.highest_hz = rig.vibration_band_hz.value_or(usual_band_hz);
    band.words = fmt::format("up to {} Hz{}", band.highest_hz,
                             rig.vibration_band_hz ? "" : ", as the rig states none");
  }
  if (response != nullptr) {
    band.words += fmt::format("{}where its response is at least {}", band.words.empty() ? "" : ", ",
                              least_gain);
  }
  return band;
}
}  // namespace

void print_unrendered_modes(const protocols::Protocol& protocol, ModelLibrary& models,
                            const protocols::Rig& rig) {
  const auto band = band_of(rig);
  if (!band) {
    return;
  }
  fmt::print("\nvibration band of the device: {}\n", band->words);
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (!stimulus.technique->needs_model()) {
      continue;
    }
    const auto plate = models.plate_of(protocol, stimulus_with(protocol, stimulus));
    const Eigen::ArrayXd frequencies_hz = plate->model.frequency_hz;
    std::vector<std::string> lost;
    for (const double frequency_hz : frequencies_hz) {
      if (!band->holds(frequency_hz) && device_share(protocol, frequency_hz) > 0.0) {
        lost.push_back(fmt::format("{:.0f}", frequency_hz));
      }
    }
    fmt::print("  {}: {}\n", stimulus.name,
               lost.empty() ? fmt::format("all {} modes", frequencies_hz.size())
                            : fmt::format("{} of {} modes are lost, at {} Hz", lost.size(),
                                          frequencies_hz.size(), fmt::join(lost, ", ")));
  }
}

void print_divided_modes(const protocols::Protocol& protocol, ModelLibrary& models) {
  const auto& crossover = protocol.rendering.crossover;
  if (!crossover) {
    return;
  }
  fmt::print("\nrendered by the device below {} Hz, by the actuator above {} Hz:\n",
             crossover->low_hz, crossover->high_hz);
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (stimulus.technique->has(core::recorded_transient)) {
      fmt::print("  {}: its recording, by frequency\n", stimulus.name);
    }
    if (!stimulus.technique->needs_model()) {
      continue;
    }
    int device = 0;
    int actuator = 0;
    int both = 0;
    const auto plate = models.plate_of(protocol, stimulus_with(protocol, stimulus));
    for (const double frequency_hz : plate->model.frequency_hz) {
      const double share = device_share(protocol, frequency_hz);
      ++(share == 1.0 ? device : share == 0.0 ? actuator : both);
    }
    fmt::print("  {}: modes: {} by the device, {} by the actuator, {} by both\n", stimulus.name,
               device, actuator, both);
  }
}

namespace {
constexpr double tolerated_error = 0.05;  // of a frequency
}  // namespace

namespace {
std::string model_key(const protocols::Protocol& protocol, const std::string& stimulus,
                      const protocols::AxisValues& values) {
  return core::content_key(
      body_spec(protocol, protocols::stimulus_at(protocol, protocol.stimulus(stimulus), values)));
}
}  // namespace

std::string describe_real_plates(const protocols::Protocol& protocol) {
  std::set<std::string> built;
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (stimulus.technique->needs_model()) {
      for (const auto& values : protocols::table_of_models(protocol, stimulus)) {
        built.insert(model_key(protocol, stimulus.name, values));
      }
    }
  }
  const protocols::Protocol reality = with_real_plates(protocol);
  std::set<std::string> further;
  for (const protocols::Block& block : protocol.blocks) {
    for (const auto& one : block.task->remembered(block, protocol.simulation)) {
      if (one.is_real && !built.contains(model_key(reality, one.stimulus, one.values))) {
        further.insert(one.stimulus);
      }
    }
  }
  return further.empty()
             ? ""
             : fmt::format(
                   "  `simulate` also builds the models of the real plates that simulated "
                   "participants remember: {}\n",
                   fmt::join(further, ", "));
}

std::string describe_surfaces(const protocols::Protocol& protocol) {
  std::string lines;
  for (const protocols::SurfaceSource& source : protocol.surfaces) {
    const std::string noise = source.noise.describe();
    lines += noise.empty() ? "" : fmt::format("  surface {}: {}\n", source.file, noise);
    if (!source.changes.empty()) {
      lines +=
          fmt::format("  surface {}:\n    {}\n", source.file, fmt::join(source.changes, "\n    "));
    }
  }
  return lines;
}

namespace {
// Of the plate that is tapped, or of a body that it touches, from 1.
const core::Plate& plate_of(const protocols::PresentedStimulus& stimulus, std::size_t body) {
  return body == 0 ? static_cast<const core::Plate&>(*stimulus.plate)
                   : stimulus.contacts->bodies.at(body - 1);
}
std::string name_of(const protocols::PresentedStimulus& stimulus, std::size_t body) {
  return body == 0 ? stimulus.name
                   : fmt::format("body {} that {} touches ({})", body, stimulus.name,
                                 stimulus.contacts->plates.at(body)->stated_at);
}
}  // namespace

std::string warning_of_order(const protocols::PresentedStimulus& stimulus,
                             const core::ModelReport& report) {
  std::string lines;
  for (std::size_t i = 0; i < report.bodies.size(); ++i) {
    const core::Meshing& mesh = plate_of(stimulus, i).mesh;
    if (!mesh.is_automatic && mesh.order == core::chosen_order && report.bodies[i].order == 1) {
      lines += fmt::format(
          "  warning: {} has linear elements, as quadratic ones would have more than {} unknowns: "
          "its frequencies may be far too high (of a box mesh: auto; fewer elements: a surface of "
          "fewer triangles or a larger max_tet_volume_m3; or order: 2, if time and memory allow)\n",
          name_of(stimulus, i), core::max_chosen_dofs);
    }
  }
  return lines;
}

std::string note_of_relaxation(const protocols::PresentedStimulus& stimulus,
                               const core::ModelReport& report) {
  std::string lines;
  for (std::size_t i = 0; i < report.bodies.size(); ++i) {
    const core::RadiusEdgeRatio& ratio = report.bodies[i].radius_edge_ratio;
    if (ratio.is_relaxed()) {
      lines += fmt::format(
          "  note: {} is meshed with radius_edge_ratio: {}, as {} takes too many elements\n",
          name_of(stimulus, i), ratio.used, ratio.asked);
    }
  }
  return lines;
}

std::size_t folds_of(const protocols::PresentedStimulus& stimulus, std::size_t body) {
  const auto* const solid = std::get_if<core::Solid>(&plate_of(stimulus, body).shape);
  return solid != nullptr && solid->sheet() ? core::folds_of(*solid->sheet()) : 0;
}

std::string note_of_folds(const protocols::PresentedStimulus& stimulus) {
  const std::size_t bodies = 1 + (stimulus.contacts ? stimulus.contacts->bodies.size() : 0);
  std::string lines;
  for (std::size_t i = 0; i < bodies; ++i) {
    if (const std::size_t folds = folds_of(stimulus, i); folds > 0) {
      lines += fmt::format(
          "  note: {} is folded along {} of its triangles, where neighbours turn by more than "
          "{:.0f} degrees (a sheet that is curved there takes smaller triangles)\n",
          name_of(stimulus, i), counted(folds, "edge"),
          core::SmoothNormals::sharp_above_rad * 180.0 / std::numbers::pi);
    }
  }
  return lines;
}

std::string note_of_hinges(const protocols::PresentedStimulus& stimulus) {
  if (!stimulus.contacts) {
    return {};
  }
  std::map<std::pair<std::size_t, std::size_t>, std::set<std::string>> regions;  // of two bodies
  for (const core::JointSpring& spring : stimulus.contacts->springs) {
    const auto [first, second] = std::minmax(spring.from.body, spring.to.body);
    regions[{first, second}].insert(core::content_key(spring.from.region) +
                                    core::content_key(spring.to.region));
  }
  std::string pairs;
  for (const auto& [bodies, joined] : regions) {
    if (joined.size() == 1) {
      pairs += fmt::format("{}{} and {}", pairs.empty() ? "" : ", ", bodies.first, bodies.second);
    }
  }
  return pairs.empty() ? ""
                       : fmt::format(
                             "  note: {} has bodies that are joined between one pair of regions "
                             "alone ({}; 0 is the plate): springs join mean displacements, and so "
                             "carry no moment (what is glued or welded there takes several small "
                             "regions)\n",
                             stimulus.name, pairs);
}

std::string describe_elements(const core::ModelReport& report) {
  if (report.order() == core::shell_order) {
    return counted(static_cast<std::size_t>(report.tets), "shell element");
  }
  const char* const order = report.order() == core::cubic_order ? "cubic"
                            : report.order() == 2               ? "quadratic"
                                                                : "linear";
  return fmt::format("{} {} tetrahedra", report.tets, order);
}

std::string describe_errors(const core::FrequencyErrors& errors) {
  if (!errors.not_estimated.empty()) {
    return fmt::format("error of the frequencies not estimated: {}", errors.not_estimated);
  }
  const std::string missing =
      errors.modes_at_least > errors.relative.size()
          ? fmt::format(", and at least {} in the band",
                        counted(static_cast<std::size_t>(errors.modes_at_least), "mode"))
          : "";
  return fmt::format(
      "estimated error: frequencies are {} by up to {}, by elements of the next order{}",
      errors.is_either_way ? "too high or too low" : "too high",
      core::describe_error(errors.largest()), missing);
}

std::string warning_of_errors(const std::string& stimulus, const core::FrequencyErrors& errors) {
  const bool is_missing = errors.modes_at_least > errors.relative.size();
  std::string lines;
  if (!errors.held_in_part.empty()) {
    lines = fmt::format(
        "  warning: {}: {}: the frequencies are those of a smaller fixation, and the estimated "
        "error does not say by how much they differ (smaller elements, or a larger region)\n",
        stimulus, errors.held_in_part);
  }
  if (errors.not_estimated.empty() && errors.largest() <= tolerated_error && !is_missing) {
    return lines;
  }
  return lines + fmt::format(
                     "  warning: {}: {} (mesh: order 2, of thin walls 3, a smaller "
                     "max_tet_volume_m3 or less flattening, of shell elements a smaller "
                     "shell_width_m; accuracy: 0.02 refines until they hold still)\n",
                     stimulus, describe_errors(errors));
}
}  // namespace tapstudy::runner
