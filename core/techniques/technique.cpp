#include "core/techniques/technique.hpp"

#include <algorithm>
#include <utility>
namespace tapstudy::core {
const std::vector<Technique>& techniques() {
  static const std::vector<Technique> table{
      {"none", {}},
      {"sinusoid", {&decaying_sinusoid}},
      {"fem", {&plate_vibration}},
      {"fem+sinusoid", {&plate_vibration, &decaying_sinusoid}},
      {"fem-coupled", {&coupled_vibration}},
      {"fem-coupled+sinusoid", {&coupled_vibration, &decaying_sinusoid}},
      {"beam", {&plate_vibration}, Theory::beam},
      {"beam+sinusoid", {&plate_vibration, &decaying_sinusoid}, Theory::beam},
      {"recorded", {&recorded_transient}},
      {"recorded+sinusoid", {&recorded_transient, &decaying_sinusoid}},
  };
  return table;
}

bool Technique::needs_model() const {
  return std::ranges::any_of(parts, &ForcePart::needs_model);
}

bool Technique::has(const ForcePart& part) const {
  return std::ranges::find(parts, &part) != parts.end();
}

std::string_view Technique::missing(const RenderSettings& settings) const {
  for (const ForcePart* const part : parts) {
    if (const std::string_view lacking = part->missing(settings); !lacking.empty()) {
      return lacking;
    }
  }
  return {};
}

const Technique* find_technique(std::string_view name) {
  const auto found = std::ranges::find(techniques(), name, &Technique::name);
  return found == techniques().end() ? nullptr : &*found;
}

std::vector<std::string> technique_names() {
  std::vector<std::string> names;
  for (const Technique& technique : techniques()) {
    names.emplace_back(technique.name);
  }
  return names;
}

const Technique& natural_vibration() {
  const std::vector<const ForcePart*> alone{&plate_vibration};
  return *std::ranges::find_if(techniques(), [&](const Technique& technique) {
    return technique.parts == alone && technique.theory == Theory::solid;
  });
}

TapRenderer make_renderer(const Technique& technique, const RenderSettings& settings,
                          TouchedShape shape, const VibratingPlate* plate) {
  std::vector<std::unique_ptr<AddedForce>> added;
  for (const ForcePart* const part : technique.parts) {
    added.push_back(part->make(settings, plate));
  }
  if (plate != nullptr && plate->triangles) {
    shape = plate->triangles;
  }
  return {settings, std::move(shape), std::move(added)};
}
}  // namespace tapstudy::core
