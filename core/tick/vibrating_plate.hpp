#pragma once
#include <memory>
#include <optional>

#include "core/geometry/triangle_tree.hpp"
#include "core/model/modal_model.hpp"
#include "core/tick/contact.hpp"
#include "core/tick/surface_locator.hpp"
namespace tapstudy::core {
// The model of a plate with its point-location structure. Built once, shared by renderers.
struct VibratingPlate {
  // A plate, of which the upper face is touched.
  explicit VibratingPlate(ModalModel modal);
  // A body touched anywhere on its model's own surface triangles.
  static VibratingPlate touched_all_over(ModalModel modal);

  // The nodes and shape functions at the god-object (paper eq. 15, 16).
  SurfacePoint place_of(const Contact& contact) const noexcept;

  ModalModel model;
  std::optional<SurfaceLocator> locator;          // of a plate
  std::shared_ptr<const TriangleTree> triangles;  // of any other body

 private:
  struct AllOver {};
  VibratingPlate(ModalModel modal, AllOver all_over);
};
}  // namespace tapstudy::core
