#pragma once
#include <memory>
#include <string_view>

#include "core/settings/render_settings.hpp"
#include "core/tick/added_force.hpp"
#include "core/tick/vibrating_plate.hpp"
namespace tapstudy::core {
// A force component that techniques add to the penalty force: requirements and factory (set-up).
struct ForcePart {
  bool needs_model{};  // a plate's modal model
  // The missing setting, as protocol key and allowed values; empty if complete.
  std::string_view (*missing)(const RenderSettings& settings){};
  // plate is non-null if a model is needed; it must outlive the returned object.
  std::unique_ptr<AddedForce> (*make)(const RenderSettings& settings,
                                      const VibratingPlate* plate){};
  // Of a slow press, beside the contact spring; null: it adds none.
  double (*added_stiffness_n_per_m)(const RenderSettings& settings){};
};

extern const ForcePart plate_vibration;     // plate_vibration_part.cpp
extern const ForcePart coupled_vibration;   // coupled_vibration_part.cpp
extern const ForcePart decaying_sinusoid;   // decaying_sinusoid_part.cpp
extern const ForcePart recorded_transient;  // recorded_transient_part.cpp
}  // namespace tapstudy::core
