#include "runner/model_library.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "runner/progress.hpp"
namespace tapstudy::runner {
core::PlateSpec plate_spec(const protocols::Protocol& protocol,
                           const protocols::Stimulus& stimulus) {
  const protocols::Plate& plate = protocol.plates.at(stimulus.plate);
  return {plate.box, plate.mesh, plate.fixations, protocol.materials.at(stimulus.material),
          protocol.band_limit_hz};
}

ModelLibrary::Plate ModelLibrary::plate_of(const protocols::Protocol& protocol,
                                           const protocols::Stimulus& stimulus) {
  const core::PlateSpec spec = plate_spec(protocol, stimulus);
  const std::lock_guard lock{mutex_};
  Plate& plate = plates_[core::content_key(spec)];
  if (!plate) {
    const Progress progress{fmt::format("building the model of '{}'", stimulus.name)};
    try {
      plate = std::make_shared<const core::VibratingPlate>(core::build_plate_model(spec).modal);
    } catch (const core::ModelError& error) {
      throw core::ModelError{fmt::format("stimulus '{}': {}", stimulus.name, error.what())};
    }
  }
  return plate;
}

void ModelLibrary::build_all(const protocols::Protocol& protocol) {
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (stimulus.technique->vibration) {
      plate_of(protocol, stimulus);
    }
  }
}
}  // namespace tapstudy::runner
