#include "runner/model_library.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "runner/progress.hpp"
namespace tapstudy::runner {
namespace {
// What is wrong with a model is wrong with the stimulus that asked for it.
template <class Build>
auto naming(const protocols::Stimulus& stimulus, const Build& build) {
  try {
    return build();
  } catch (const core::ModelError& error) {
    throw core::ModelError{fmt::format("stimulus '{}': {}", stimulus.name, error.what())};
  }
}
}  // namespace

core::PlateSpec plate_spec(const protocols::Protocol& protocol,
                           const protocols::Stimulus& stimulus) {
  const protocols::Plate& plate = protocol.plates.at(stimulus.plate);
  return {plate.shape, plate.mesh, plate.fixations, protocol.materials.at(stimulus.material),
          protocol.band_limit_hz};
}

core::BodySpec body_spec(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus) {
  core::BodySpec body = core::body_of(plate_spec(protocol, stimulus));
  for (const protocols::Stimulus& other : protocol.stimuli) {
    const core::Material& material = protocol.materials.at(other.material);
    if (other.technique->vibration && other.plate == stimulus.plate &&
        material.poissons_ratio == body.poissons_ratio) {
      body.band_limit_rad_per_m = std::max(body.band_limit_rad_per_m,
                                           core::kappa_rad_per_m(protocol.band_limit_hz, material));
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
                                      const protocols::Stimulus& stimulus) {
  core::check_material(protocol.materials.at(stimulus.material));
  const core::BodySpec spec = body_spec(protocol, stimulus);
  const std::string key = core::content_key(spec);
  Body& body = bodies_[key];
  if (body) {
    return body;
  }
  if (auto kept = cache_.find(key)) {
    body = std::make_shared<const core::BodyModes>(std::move(*kept));
    return body;
  }
  Progress progress{fmt::format("building the model of '{}'", stimulus.name)};
  body = std::make_shared<const core::BodyModes>(core::solve_body(spec, progress.hook()).modes);
  ++solved_;
  cache_.keep(key, *body);
  return body;
}

ModelLibrary::Body ModelLibrary::body_of(const protocols::Protocol& protocol,
                                         const protocols::Stimulus& stimulus) {
  const std::lock_guard lock{mutex_};
  return naming(stimulus, [&] { return body(protocol, stimulus); });
}

ModelLibrary::Plate ModelLibrary::plate_of(const protocols::Protocol& protocol,
                                           const protocols::Stimulus& stimulus) {
  const std::lock_guard lock{mutex_};
  const core::PlateSpec spec = plate_spec(protocol, stimulus);
  Plate& plate = plates_[fmt::format("{} {} {:a}", core::content_key(body_spec(protocol, stimulus)),
                                     core::content_key(spec.material), spec.band_limit_hz)];
  if (!plate) {
    plate = naming(stimulus, [&] {
      core::ModalModel model =
          core::model_of(*body(protocol, stimulus), spec.material, spec.band_limit_hz);
      return std::make_shared<const core::VibratingPlate>(
          vibrating_plate(spec.shape, std::move(model)));
    });
  }
  return plate;
}

core::TouchedShape touched_shape(const core::Shape& shape) {
  if (const auto* box = std::get_if<core::Box>(&shape)) {
    return core::PlateFace{box->high_m().x(), box->high_m().y()};
  }
  return std::get<core::Solid>(shape).triangles();
}

void ModelLibrary::build_all(const protocols::Protocol& protocol) {
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (stimulus.technique->vibration) {
      plate_of(protocol, stimulus);
    }
  }
}
}  // namespace tapstudy::runner
