#pragma once
#include "core/model/body_modes.hpp"
namespace tapstudy::core {
// kappa of a frequency in a material: 2 pi f / sqrt(E / rho).
double kappa_rad_per_m(double frequency_hz, const Material& material);

// The body that a plate's model is scaled from, solved up to the plate's own band limit.
BodySpec body_of(const PlateSpec& plate);

// The body made of a material: frequencies and shapes scaled, damping given, modes above the band
// left out. Throws InvalidInput for properties out of range, ModelError if the damping does not fit
// the modes or the body was solved for a lower band.
ModalModel model_of(const BodyModes& body, const Material& material, double band_limit_hz);

struct PlateModel {
  ModalModel modal;
  SolvedBody body;
};

// Body and model in one. Throws InvalidInput for properties out of range, ModelError for what
// cannot be built.
PlateModel build_plate_model(const PlateSpec& plate, const ProgressHook& progress = {});
}  // namespace tapstudy::core
