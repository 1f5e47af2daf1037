#pragma once
#include <memory>
#include <variant>
#include <vector>

#include "core/haptics/haptic_state.hpp"
#include "core/settings/render_settings.hpp"
#include "core/tick/added_force.hpp"
#include "core/tick/god_object.hpp"
namespace tapstudy::core {
// The collision geometry: the upper face of a plate, or a whole triangulated surface.
using TouchedShape = std::variant<PlateFace, std::shared_ptr<const TriangleTree>>;

struct RenderedTick {
  Contact contact;
  ForceParts parts;
  Vec3 force_n{Vec3::Zero()};  // on the finger, plate frame
};

// Renders one stimulus: maps the finger's state to the force on it, the penalty force (paper eq. 1)
// plus the technique's components (eq. 18), along the contact normal. Zero out of contact.
class TapRenderer {
 public:
  TapRenderer(const RenderSettings& settings, TouchedShape shape,
              std::vector<std::unique_ptr<AddedForce>> added);
  // The tip is in the placement's plate frame; the contact is in the plate's own, which has its own
  // lateral scale. A vibration advances by this many periods: it keeps its pitch if some are
  // missed.
  RenderedTick tick(HandState tip, int periods = 1) noexcept;
  bool is_touching() const noexcept;  // NOLINT(bugprone-exception-escape)
  // Kinetic plus elastic energy of the vibrating body.
  double energy_j() const noexcept;
  // Starts at rest with the contact history of another renderer, finger off the plate.
  void take_over_from(const TapRenderer& other) noexcept;  // NOLINT(bugprone-exception-escape)

 private:
  ForceParts parts_of(const Contact& contact) noexcept;

  double penalty_stiffness_n_per_m_;
  Vec3 own_scale_;
  TouchedShape shape_;
  std::variant<PlateContact, SurfaceContact> contact_;
  std::vector<std::unique_ptr<AddedForce>> added_;
};
}  // namespace tapstudy::core
