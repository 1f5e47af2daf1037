#include "core/techniques/make_renderer.hpp"

#include <utility>
namespace tapstudy::core {
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
