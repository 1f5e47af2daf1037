#include "core/tick/vibrating_plate.hpp"

#include <utility>
namespace tapstudy::core {
namespace {
TriangleSurface corners_of(const ModalModel& model) {
  return {model.touch_nodes_m, model.touch_surface.leftCols<3>()};
}
}  // namespace

VibratingPlate::VibratingPlate(ModalModel modal) : model{std::move(modal)}, locator{model} {}

VibratingPlate::VibratingPlate(ModalModel modal, AllOver /*all_over*/)
    : model{std::move(modal)}, triangles{std::make_shared<const TriangleTree>(corners_of(model))} {}

VibratingPlate VibratingPlate::touched_all_over(ModalModel modal) {
  return {std::move(modal), AllOver{}};
}

SurfacePoint VibratingPlate::place_of(const Contact& contact) const noexcept {
  if (locator) {
    return locator->locate(contact.god_object_m.x(), contact.god_object_m.y());
  }
  return surface_point(model.touch_surface, contact.triangle, contact.barycentric);
}
}  // namespace tapstudy::core
