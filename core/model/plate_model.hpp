#pragma once
#include "core/model/body_modes.hpp"
namespace tapstudy::core {
// kappa of a frequency in a material: 2 pi f / sqrt(E / rho), of an orthotropic one with E_1.
double kappa_rad_per_m(double frequency_hz, const Material& material);

// The unit-material body from which a plate's model is scaled, solved up to its band limit; of a
// plate on springs the body of this Young's modulus.
BodySpec body_of(const PlateSpec& plate);

// Scales the body to a material: frequencies and mode shapes scaled, damping applied, modes above
// the band omitted. joints: with which the body was solved; their damping counts, too. Throws
// InvalidInput for properties out of range, ModelError if the damping does not fit the modes or the
// body was solved for a lower band limit.
ModalModel model_of(const BodyModes& body, const Material& material, double band_limit_hz,
                    const Joints* joints = nullptr);
ModalModel model_of(const BodyModes& body, const PlateSpec& plate);

// The estimated discretisation error of a body's frequencies in a material.
struct FrequencyErrors {
  Eigen::ArrayXd relative;  // of each mode in the band: |f / f' - 1|, f' of the next element order
  int modes_at_least{};     // in the band, by the next element order
  std::string not_estimated;   // why `relative` is empty
  bool is_either_way{};        // or some may be too low: shells of the next order hold other nodes
  std::string held_in_part{};  // as ErrorEstimate
  double largest() const { return relative.size() > 0 ? relative.maxCoeff() : 0.0; }
};
FrequencyErrors frequency_errors(const BodyModes& body, const Material& material,
                                 double band_limit_hz);
// "3.2 %"; "over 50 %" beyond what the next element order can tell.
std::string describe_error(double relative);

struct PlateModel {
  ModalModel modal;
  SolvedBody body;
};

// Both steps in one. Throws InvalidInput for properties out of range, ModelError if the model
// cannot be built.
PlateModel build_plate_model(const PlateSpec& plate, const ProgressHook& progress = {},
                             ErrorEstimation estimation = ErrorEstimation::none);
}  // namespace tapstudy::core
