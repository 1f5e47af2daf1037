#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/plate.hpp"
#include "core/settings/render_settings.hpp"
#include "core/tick/added_force.hpp"
#include "core/tick/tap_renderer.hpp"
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
};

// force_parts.cpp
extern const ForcePart plate_vibration;
extern const ForcePart coupled_vibration;
extern const ForcePart decaying_sinusoid;
extern const ForcePart recorded_transient;

// A rendering technique: the components added to the penalty force of the contact spring. The
// components of a technique are distinct, and are added in order.
struct Technique {
  std::string_view name;  // in protocols, stores and reports
  std::vector<const ForcePart*> parts;
  Theory theory{Theory::solid};  // of the model

  bool needs_model() const;
  bool needs_beam() const { return needs_model() && theory == Theory::beam; }
  bool has(const ForcePart& part) const;
  // The missing setting: see ForcePart.
  std::string_view missing(const RenderSettings& settings) const;
};

// All techniques; a new one is a row in this table, plus a ForcePart if it adds a new force. A
// force that is neither of the two in ForceParts is stored as a column of its own: ForceParts,
// TraceSample and its codec.
const std::vector<Technique>& techniques();
// nullptr if there is none of that name.
const Technique* find_technique(std::string_view name);
std::vector<std::string> technique_names();
// The one that vibrates as the body does, with nothing added.
const Technique& natural_vibration();

// Creates the renderer of a shape for a technique. plate may be nullptr if the technique needs no
// model; it must outlive the renderer. A vibrating body is touched on its own model's triangles.
TapRenderer make_renderer(const Technique& technique, const RenderSettings& settings,
                          TouchedShape shape, const VibratingPlate* plate);
}  // namespace tapstudy::core
