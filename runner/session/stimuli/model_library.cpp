#include "runner/session/stimuli/model_library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "core/error.hpp"
#include "core/model/plate_model.hpp"
#include "core/techniques/actuated.hpp"
#include "core/techniques/technique.hpp"
#include "protocols/axes/presented_stimulus.hpp"
#include "runner/build_info/build_info.hpp"
#include "runner/session/stimuli/stimulus_family.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
namespace {
std::string cache_directory() {
  const auto variable = [](const char* name) {
    const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): set-up only
    return value == nullptr ? std::string{} : std::string{value};
  };
  if (!variable("TAPSTUDY_CACHE").empty()) {
    return variable("TAPSTUDY_CACHE");
  }
  if (!variable("XDG_CACHE_HOME").empty()) {
    return variable("XDG_CACHE_HOME") + "/tapstudy";
  }
  return variable("HOME").empty() ? std::string{} : variable("HOME") + "/.cache/tapstudy";
}

// Sought in ever wider bands.
std::string first_frequency(core::PlateSpec spec) {
  constexpr int max_doublings = 8;
  for (int i = 0; i < max_doublings; ++i) {
    spec.band_limit_hz *= 2.0;
    const core::ModalModel model =
        core::model_of(core::solve_body(core::body_of(spec), {}).modes, spec);
    if (model.frequency_hz.size() > 0) {
      return fmt::format("{:.4g} Hz", model.frequency_hz[0]);
    }
  }
  return fmt::format("more than {:.4g} Hz (is youngs_modulus_pa right?)", spec.band_limit_hz);
}
// Of all that damps: the bodies' materials, and the contacts between them.
std::string damping_key(const protocols::PresentedStimulus& stimulus) {
  std::string key = core::content_key(*stimulus.material);
  if (stimulus.contacts) {
    for (const core::JoinedBody& body : stimulus.contacts->bodies) {
      key += " " + core::content_key(body.material);
    }
    for (const core::JointSpring& spring : stimulus.contacts->springs) {
      key += fmt::format(" {:a}", spring.loss_factor);
    }
  }
  return key;
}

// Of all on which it depends which modes are rendered; empty where all are.
std::string dropped_key(const protocols::Protocol& protocol,
                        const protocols::PresentedStimulus& stimulus) {
  if (!protocol.drop_modes) {
    return {};
  }
  const core::Finger& finger = stimulus.rendering.finger;
  std::string key = fmt::format(" {:a} {:a} {:a} {:a}", protocol.drop_modes->below_db,
                                protocol.drop_modes->within_m, finger.stiffness_n_per_m,
                                finger.damping_n_s_per_m);
  for (const auto& [name, at_m] : stimulus.plate->tapping_points_m) {
    key += fmt::format(" {:a},{:a}", at_m.x(), at_m.y());
  }
  return key;
}

bool chooses_mesh(const core::Plate& plate) {
  return plate.mesh.is_automatic && plate.theory == core::Theory::solid;
}

core::BodySpec body_as_accurate(const protocols::Protocol& protocol,
                                const protocols::PresentedStimulus& stimulus, double accuracy) {
  core::BodySpec spec = body_spec(protocol, stimulus);
  if (chooses_mesh(spec)) {
    spec.mesh.accuracy = accuracy;
  }
  return spec;
}
}  // namespace

void check_has_mode(Eigen::Index modes_in_band, const core::PlateSpec& spec) {
  if (modes_in_band > 0) {
    return;
  }
  throw core::ModelError{fmt::format(
      "no mode lies below band_limit_hz ({} Hz), so that it would not vibrate: its first is at "
      "{}",
      spec.band_limit_hz, first_frequency(spec))};
}

core::ModelCache user_model_cache() {
  return {cache_directory(), fmt::format("{} {}", program_version(), git_hash())};
}

core::PlateSpec plate_spec(const protocols::Protocol& protocol,
                           const protocols::PresentedStimulus& stimulus) {
  core::PlateSpec spec{*stimulus.plate, *stimulus.material, protocol.band_limit_hz};
  spec.theory = stimulus.technique->theory;
  spec.joints = stimulus.contacts;
  return spec;
}

core::BodySpec body_spec(const protocols::Protocol& protocol,
                         const protocols::PresentedStimulus& stimulus) {
  core::BodySpec body = core::body_of(plate_spec(protocol, stimulus));
  const core::Material& own = *stimulus.material;
  const auto may_share = [&](const protocols::Stimulus& other) {
    return other.technique->needs_model() && other.technique->theory == body.theory &&
           other.plate == stimulus.own_plate && other.contacts == stimulus.contacts &&
           other.material->orthotropy == own.orthotropy &&
           (!core::is_on_springs(body.fixations) ||
            other.material->youngs_modulus_pa == own.youngs_modulus_pa) &&
           (!stimulus.contacts || (other.material->youngs_modulus_pa == own.youngs_modulus_pa &&
                                   other.material->density_kg_per_m3 == own.density_kg_per_m3)) &&
           std::ranges::count(poissons_ratios(protocol, other), body.poissons_ratio) > 0;
  };
  for (const protocols::Stimulus& other : protocol.stimuli) {
    if (may_share(other)) {
      body.band_limit_rad_per_m =
          std::max(body.band_limit_rad_per_m, largest_kappa_rad_per_m(protocol, other));
    }
  }
  return body;
}

core::VibratingPlate vibrating_plate(const core::Shape& shape, core::ModalModel model) {
  return std::holds_alternative<core::Box>(shape)
             ? core::VibratingPlate{std::move(model)}
             : core::VibratingPlate::touched_all_over(std::move(model));
}

ModelLibrary::Body ModelLibrary::body(const protocols::Protocol& protocol,
                                      const protocols::PresentedStimulus& stimulus) {
  core::check_material(*stimulus.material);
  core::BodySpec spec = body_spec(protocol, stimulus);
  if (chooses_mesh(spec)) {
    spec.mesh.accuracy = mesh_for(protocol).accuracy;
  }
  return solved_once(spec, stimulus.name);
}

AutomaticMesh ModelLibrary::mesh_for(const protocols::Protocol& protocol) {
  const auto find = [&](const protocols::PresentedStimulus& stimulus, double accuracy) -> Body {
    try {
      return solved_once(body_as_accurate(protocol, stimulus, accuracy), stimulus.name);
    } catch (const core::ModelError&) {  // told at its own line, once it is built itself
      return nullptr;
    }
  };
  return runner::automatic_mesh(protocol, find).value_or(AutomaticMesh{});
}

AutomaticMesh ModelLibrary::automatic_mesh(const protocols::Protocol& protocol) {
  const std::lock_guard lock{mutex_};
  return mesh_for(protocol);
}

ModelLibrary::Body ModelLibrary::solved_once(const core::BodySpec& spec, const std::string& name) {
  const std::string key = core::content_key(spec);
  Body& body = bodies_[key];
  if (body) {
    return body;
  }
  if (auto kept = cache_.find(key)) {
    body = std::make_shared<const core::BodyModes>(std::move(*kept));
    return body;
  }
  Progress progress{fmt::format("building the model of '{}'", name)};
  body = std::make_shared<const core::BodyModes>(
      core::solve_body(spec, progress.hook(), estimation_).modes);
  ++solved_;
  if (!cache_.store(key, *body)) {
    warn(fmt::format("{}: models cannot be cached here and will be rebuilt", cache_.directory()));
  }
  return body;
}

ModelLibrary::Body ModelLibrary::body_of(const protocols::Protocol& protocol,
                                         const protocols::PresentedStimulus& stimulus) {
  const std::lock_guard lock{mutex_};
  return at_its_line(stimulus, [&] { return body(protocol, stimulus); });
}

ModelLibrary::Plate ModelLibrary::make_plate(const protocols::Protocol& protocol,
                                             const protocols::PresentedStimulus& stimulus) {
  return at_its_line(stimulus, [&] {
    const core::PlateSpec spec = plate_spec(protocol, stimulus);
    core::ModalModel model = core::model_of(*body(protocol, stimulus), spec);
    check_has_mode(model.frequency_hz.size(), spec);
    return std::make_shared<const core::VibratingPlate>(
        vibrating_plate(spec.shape, rendered_model(protocol, stimulus, std::move(model))));
  });
}

ModelLibrary::Plate ModelLibrary::plate_of(const protocols::Protocol& protocol,
                                           const protocols::PresentedStimulus& stimulus) {
  const std::lock_guard lock{mutex_};
  if (!stimulus.changed.empty()) {
    return make_plate(protocol, stimulus);
  }
  Plate& plate = plates_[fmt::format(
      "{} {} {:a}{}", core::content_key(body_spec(protocol, stimulus)), damping_key(stimulus),
      protocol.band_limit_hz, dropped_key(protocol, stimulus))];
  if (!plate) {
    plate = make_plate(protocol, stimulus);
  }
  return plate;
}

std::vector<ModelLibrary::Body> ModelLibrary::bodies_of(const protocols::Protocol& protocol,
                                                        const protocols::Stimulus& stimulus) {
  std::vector<Body> bodies;
  const protocols::AxisValues softest = band_ends(protocol, stimulus).most;
  for (protocols::AxisValues values : protocols::table_of_models(protocol, stimulus)) {
    values.insert(softest.begin(), softest.end());  // what is solved for, should it fail
    bodies.push_back(body_of(protocol, stimulus_with(protocol, stimulus, values)));
  }
  return bodies;
}

core::TouchedShape touched_shape(const core::Shape& shape) {
  if (const auto* box = std::get_if<core::Box>(&shape)) {
    return core::PlateFace{box->high_m().x(), box->high_m().y()};
  }
  return std::get<core::Solid>(shape).triangles();
}

void ModelLibrary::build_all(const protocols::Protocol& protocol) {
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (!stimulus.technique->needs_model()) {
      continue;
    }
    const auto tables = protocols::table_of_models(protocol, stimulus);
    const std::vector<Body> bodies = bodies_of(protocol, stimulus);
    for (std::size_t i = 0; i < tables.size(); ++i) {
      check_members(protocol, stimulus, tables[i], *bodies[i]);
    }
    plate_of(protocol, stimulus_with(protocol, stimulus));
  }
}

ModelLibrary::Plate ModelLibrary::rendered_by(core::RenderedBy by,
                                              const protocols::Protocol& protocol,
                                              const protocols::PresentedStimulus& stimulus) {
  if (!stimulus.technique->needs_model()) {
    return nullptr;
  }
  const Plate whole = plate_of(protocol, stimulus);
  const auto& crossover = stimulus.rendering.crossover;
  if (!crossover) {
    return by == core::RenderedBy::device ? whole : nullptr;
  }
  const auto share = [&] {
    return std::make_shared<const core::VibratingPlate>(
        vibrating_plate(stimulus.plate->shape, core::share_of(whole->model, *crossover, by)));
  };
  if (!stimulus.changed.empty()) {
    return share();
  }
  const std::lock_guard lock{mutex_};
  Plate& kept = shares_[{whole, by}];
  if (!kept) {
    kept = share();
  }
  return kept;
}

TrialStimuli build_trial_stimuli(const protocols::Protocol& protocol,
                                 const std::vector<protocols::PresentedStimulus>& stimuli,
                                 ModelLibrary& models, const core::ActuatorOutput* actuator) {
  TrialStimuli built;
  for (const protocols::PresentedStimulus& stimulus : stimuli) {
    using core::RenderedBy;
    built.plates.push_back(models.rendered_by(RenderedBy::device, protocol, stimulus));
    built.alternatives.push_back(core::make_renderer(*stimulus.technique, stimulus.rendering,
                                                     touched_shape(stimulus.plate->shape),
                                                     built.plates.back().get()));
    if (actuator != nullptr) {
      built.plates.push_back(models.rendered_by(RenderedBy::actuator, protocol, stimulus));
      built.voices.push_back(core::make_voice(*stimulus.technique, stimulus.rendering,
                                              built.plates.back().get(), actuator->response,
                                              1.0 / actuator->rate_hz));
    }
  }
  return built;
}

TrialStimuli build_trial_stimuli(const protocols::Protocol& protocol,
                                 const std::vector<std::string>& stimuli, ModelLibrary& models) {
  std::vector<protocols::PresentedStimulus> presented;
  for (const std::string& name : stimuli) {
    presented.push_back(stimulus_with(protocol, protocol.stimulus(name)));
  }
  return build_trial_stimuli(protocol, presented, models);
}

std::optional<CachedModel> cached_model(const protocols::Protocol& protocol,
                                        const protocols::Stimulus& stimulus,
                                        const core::ModelCache& cache) {
  const protocols::PresentedStimulus presented = protocols::stimulus_with(protocol, stimulus);
  const auto find = [&](const protocols::PresentedStimulus& one,
                        double accuracy) -> std::shared_ptr<const core::BodyModes> {
    auto kept = cache.find(core::content_key(body_as_accurate(protocol, one, accuracy)));
    return kept ? std::make_shared<const core::BodyModes>(std::move(*kept)) : nullptr;
  };
  const auto mesh = has_automatic_mesh(protocol) ? automatic_mesh(protocol, find)
                                                 : std::optional{AutomaticMesh{}};
  const auto body = mesh ? find(presented, mesh->accuracy) : nullptr;
  if (!body) {
    return std::nullopt;
  }
  const core::PlateSpec plate = plate_spec(protocol, presented);
  core::ModalModel all = core::model_of(*body, plate);
  std::vector<UnfeltMode> dropped;
  if (protocol.drop_modes && all.frequency_hz.size() > 0) {
    dropped = unfelt_modes(vibrating_plate(plate.shape, all), presented, *protocol.drop_modes);
  }
  return CachedModel{rendered_model(protocol, presented, std::move(all)), std::move(dropped),
                     body->report,
                     core::frequency_errors(*body, plate.material, plate.band_limit_hz)};
}
}  // namespace tapstudy::runner
