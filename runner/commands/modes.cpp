#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "analysis/report/figures/colour_map.hpp"
#include "core/error.hpp"
#include "core/files/output_files.hpp"
#include "core/model/universal_file.hpp"
#include "core/model/vtu_file.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "runner/commands/check_models.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/commands/shared_options.hpp"
#include "runner/session/stimuli/model_library.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
namespace {
struct ModesOptions {
  std::string protocol;
  std::string stimulus;
  bool wants_json{false};
  std::string mesh_out;
  std::string vtu;
  std::string uff;
  std::string figure;
  std::vector<std::string> settings;
};

double peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-union-access): the C library hides it in one
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

core::FrequencyErrors errors_of(const core::PlateModel& plate, const core::PlateSpec& spec) {
  return core::frequency_errors(plate.body.modes, spec.material, spec.band_limit_hz);
}

// Without an estimate: why.
void add_errors(const core::FrequencyErrors& errors, nlohmann::ordered_json& json) {
  if (errors.not_estimated.empty()) {
    json["estimated_relative_errors"] =
        std::vector<double>(errors.relative.begin(), errors.relative.end());
    json["modes_in_band_at_least"] = errors.modes_at_least;
  } else {
    json["errors_not_estimated"] = errors.not_estimated;
  }
  if (!errors.held_in_part.empty()) {
    json["held_in_part"] = errors.held_in_part;
  }
}

void add_surfaces(const protocols::Protocol& protocol, nlohmann::ordered_json& json) {
  for (const protocols::SurfaceSource& source : protocol.surfaces) {
    const protocols::SurfaceNoise& noise = source.noise;
    if (!noise.describe().empty()) {
      json["surface_noise"].push_back({{"file", source.file},
                                       {"points_joined", noise.points},
                                       {"farthest_share_of_size", noise.farthest},
                                       {"triangles_without_area", noise.without_area}});
    }
    if (!source.changes.empty()) {
      json["surface_repairs"].push_back({{"name", source.file}, {"changes", source.changes}});
    }
  }
}

void print_json(const protocols::Protocol& protocol, const protocols::PresentedStimulus& stimulus,
                const core::PlateModel& plate, const core::PlateSpec& spec) {
  const core::ModelReport& report = plate.body.modes.report;
  nlohmann::ordered_json json{{"schema_version", 1}, {"stimulus", stimulus.name}};
  if (!stimulus.values.empty()) {
    json["values"] = stimulus.values;
  }
  json["frequencies_hz"] =
      std::vector<double>(plate.modal.frequency_hz.begin(), plate.modal.frequency_hz.end());
  json["damping_ratios"] =
      std::vector<double>(plate.modal.damping_ratio.begin(), plate.modal.damping_ratio.end());
  if (!stimulus.technique->needs_beam()) {
    add_errors(errors_of(plate, spec), json);
  }
  if (stimulus.contacts) {
    const auto share = plate.body.modes.kinetic_share.row(0);
    json["kinetic_energy_in_plate"] = std::vector<double>(share.begin(), share.end());
  }
  if (plate.modal.damping) {
    json["alpha_per_s"] = plate.modal.damping->alpha_per_s;
    json["beta_s"] = plate.modal.damping->beta_s;
  }
  add_surfaces(protocol, json);
  json["element_order"] = report.order();
  json["nodes"] = report.nodes;
  json["elements"] = report.tets;
  json["dof"] = report.dofs;
  for (std::size_t i = 0; i < report.bodies.size(); ++i) {
    const core::MeshedBody& body = report.bodies[i];
    json["bodies"].push_back({{"element_order", body.order},
                              {"radius_edge_ratio", body.radius_edge_ratio.used},
                              {"radius_edge_ratio_asked", body.radius_edge_ratio.asked},
                              {"folded_edges", folds_of(stimulus, i)}});
  }
  json["rigid_body_modes"] = report.rigid_body_modes;
  json["modes_in_band_by_inertia"] = report.counted_in_band;
  json["worst_residual"] = report.worst_residual;
  json["seconds"] = {
      {"mesh", report.cost.mesh_s},     {"assemble", report.cost.assemble_s},
      {"factor", report.cost.factor_s}, {"iterate", report.cost.iterate_s},
      {"total", report.cost.total_s()}, {"error_estimate", plate.body.modes.estimate.seconds}};
  json["peak_memory_bytes"] = peak_memory_bytes();
  for (const core::RefinementRound& round : report.refinement) {
    json["refinement"].push_back({{"elements", round.tets}, {"modes", round.modes}});
    if (std::isfinite(round.moved)) {
      json["refinement"].back()["moved"] = round.moved;
    }
  }
  fmt::print("{}\n", json.dump(2));
}

void print_refinement(const core::ModelReport& report) {
  for (const core::RefinementRound& round : report.refinement) {
    fmt::print("  {:>7} elements: {} modes", round.tets, round.modes);
    fmt::print("{}\n", std::isfinite(round.moved)
                           ? fmt::format(", moved {:.2g} % at most", 100.0 * round.moved)
                           : std::string{});
  }
  if (!report.refinement.empty()) {
    fmt::print("\n");
  }
}

void print_solution(const std::string& name, const core::ModelReport& report) {
  fmt::print(
      "{}: {} nodes, {}, {} free degrees of freedom\n"
      "  {:.3f} s (mesh {:.3f}, assemble {:.3f}, factor {:.3f}, iterate {:.3f}), {:.0f} MB at "
      "most\n\n",
      name, report.nodes, describe_elements(report), report.dofs, report.cost.total_s(),
      report.cost.mesh_s, report.cost.assemble_s, report.cost.factor_s, report.cost.iterate_s,
      1e-6 * peak_memory_bytes());
}

void print_completeness(const core::ModelReport& report, double band_limit_hz) {
  fmt::print("\n  {} below {} Hz by the inertia of K - sigma M", report.counted_in_band,
             band_limit_hz);
  if (report.rigid_body_modes > 0) {
    fmt::print(", {} of them motions of the rigid body, left out", report.rigid_body_modes);
  }
  fmt::print("; worst residual {:.1e}\n", report.worst_residual);
}

void print_modes(const core::PlateModel& plate, const core::FrequencyErrors& errors,
                 bool are_joined) {
  const bool has_errors = errors.relative.size() > 0;
  fmt::print("  mode  frequency_hz{}  damping_ratio{}\n", has_errors ? "  error_up_by" : "",
             are_joined ? "  in_plate" : "");
  for (Eigen::Index i = 0; i < plate.modal.frequency_hz.size(); ++i) {
    fmt::print("  {:>4}  {:>12.3f}{}  {:>13.4f}{}\n", i + 1, plate.modal.frequency_hz[i],
               has_errors ? fmt::format("  {:>11}", core::describe_error(errors.relative[i]))
                          : std::string{},
               plate.modal.damping_ratio[i],
               are_joined ? fmt::format("  {:>8.3f}", plate.body.modes.kinetic_share(0, i))
                          : std::string{});
  }
}

void print_table(const protocols::PresentedStimulus& stimulus, const core::PlateSpec& spec,
                 const core::PlateModel& plate) {
  const core::ModelReport& report = plate.body.modes.report;
  const bool is_beam = stimulus.technique->needs_beam();
  if (is_beam) {
    fmt::print("{}: an Euler-Bernoulli beam, in closed form\n\n", stimulus.name);
  } else {
    print_solution(stimulus.name, report);
  }
  for (const auto& [name, value] : stimulus.values) {
    fmt::print("  {} {}\n", name, value);
  }
  if (stimulus.contacts) {
    fmt::print("  bodies in contact: {}; in_plate: share of a mode's kinetic energy\n\n",
               stimulus.contacts->bodies.size() + 1);
  }
  print_refinement(report);
  const core::FrequencyErrors errors = errors_of(plate, spec);
  print_modes(plate, errors, stimulus.contacts != nullptr);
  if (!is_beam) {
    print_completeness(report, spec.band_limit_hz);
    fmt::print("  {}\n", describe_errors(errors));
    fmt::print("{}{}{}{}{}", note_of_folds(stimulus), note_of_hinges(stimulus),
               note_of_relaxation(stimulus, report), warning_of_order(stimulus, report),
               warning_of_errors(stimulus.name, errors));
  }
}

std::vector<std::string> outputs(const ModesOptions& options) {
  std::vector<std::string> files;
  if (!options.mesh_out.empty()) {
    files = {options.mesh_out + ".node", options.mesh_out + ".ele"};
  }
  for (const std::string& file : {options.vtu, options.uff, options.figure}) {
    if (!file.empty()) {
      files.push_back(file);
    }
  }
  return files;
}

void draw_modes(const ModesOptions& options, const core::Shape& shape, core::ModalModel model) {
  const auto* const box = std::get_if<core::Box>(&shape);
  if (box == nullptr) {
    throw core::InvalidInput{"--figure: draws plates from above only (--vtu takes any shape)"};
  }
  if (model.frequency_hz.size() == 0) {
    throw core::InvalidInput{"--figure: there is no mode inside the band"};
  }
  const core::VibratingPlate plate{std::move(model)};
  analysis::draw_svg(analysis::map_of_modes(plate, *box, "Modes of " + options.stimulus),
                     options.figure);
}

void run_modes(const ModesOptions& options) {
  const protocols::Protocol protocol = protocols::read_protocol(options.protocol);
  const protocols::PresentedStimulus stimulus =
      member_set_to(options.settings, protocol, protocol.stimulus(options.stimulus));
  core::PlateSpec spec = plate_spec(protocol, stimulus);
  if (spec.mesh.is_automatic) {
    spec.mesh.accuracy = ModelLibrary{}.automatic_mesh(protocol).accuracy;
  }
  if (stimulus.technique->needs_beam() &&
      !(options.mesh_out.empty() && options.vtu.empty() && options.uff.empty())) {
    throw core::InvalidInput{fmt::format(
        "--mesh-out, --vtu, --uff: stimulus '{}' is a beam, which has no mesh", options.stimulus)};
  }
  for (const std::string& file : outputs(options)) {
    core::check_is_new(file);
  }
  const core::PlateModel plate = [&] {
    Progress progress{fmt::format("building the model of '{}'", options.stimulus)};
    return at_its_line(stimulus, [&] {
      return core::build_plate_model(spec, progress.hook(), core::ErrorEstimation::wanted);
    });
  }();
  if (!options.mesh_out.empty()) {
    core::write_tetgen_files(plate.body.mesh, options.mesh_out);
  }
  if (!options.vtu.empty()) {
    core::write_vtu(plate.body, plate.modal, spec.material.density_kg_per_m3, options.vtu);
  }
  if (!options.uff.empty()) {
    core::write_universal_file(plate.body, plate.modal, spec.material.density_kg_per_m3,
                               options.uff);
  }
  if (!options.figure.empty()) {
    draw_modes(options, spec.shape, plate.modal);
  }
  if (options.wants_json) {
    print_json(protocol, stimulus, plate, spec);
  } else {
    fmt::print("{}", describe_surfaces(protocol));
    print_table(stimulus, spec, plate);
  }
}
}  // namespace

void add_modes(CommandParser& line) {
  Command command = line.add("modes", "Natural frequencies and damping of a stimulus's plate");
  const auto options = std::make_shared<ModesOptions>();
  command.shipped_file("protocol", options->protocol, "Study (YAML)");
  command.option("--stimulus", options->stimulus, "Which stimulus", Need::required);
  command.repeatable("--set", options->settings, set_help);
  command.flag("--json", options->wants_json, "Output as JSON");
  command.option("--mesh-out", options->mesh_out, "Write the mesh as PREFIX.node, PREFIX.ele");
  command.file("--vtu", options->vtu, ".vtu", "Write body and mode shapes for ParaView (.vtu)");
  command.file("--uff", options->uff, ".uff",
               "Write nodes, elements and mode shapes as a universal file (.uff)");
  command.file("--figure", options->figure, ".svg", "Draw the plate's modes from above (.svg)");
  command.on_run([options] { run_modes(*options); });
}
}  // namespace tapstudy::runner
