#pragma once
#include <memory>
#include <string_view>

#include "core/settings/render_settings.hpp"
#include "core/tick/added_force.hpp"
#include "core/tick/vibrating_plate.hpp"
namespace tapstudy::core {
// One thing that techniques add to the penalty force: what it needs, and how to make it. Set-up.
struct ForcePart {
  bool needs_model{};  // a plate's modal model, which takes a finite element solution
  // What of the settings it lacks, as the key of the protocol and what is allowed; empty: nothing.
  std::string_view (*missing)(const RenderSettings& settings){};
  // plate is not null where a model is needed; it must outlive what is made.
  std::unique_ptr<AddedForce> (*make)(const RenderSettings& settings,
                                      const VibratingPlate* plate){};
};

extern const ForcePart plate_vibration;    // plate_vibration_part.cpp
extern const ForcePart decaying_sinusoid;  // decaying_sinusoid_part.cpp
}  // namespace tapstudy::core
