#pragma once
#include <memory>
#include <optional>
#include <variant>

#include "core/haptic_state.hpp"
#include "core/technique.hpp"
#include "core/tick/decaying_sinusoid.hpp"
#include "core/tick/modal_state.hpp"
#include "core/tick/plate_contact.hpp"
#include "core/tick/surface_contact.hpp"
#include "core/tick/surface_locator.hpp"
namespace tapstudy::core {
// The finger as the paper sees it: the mass that strikes (eq. 14, grip included) and the spring and
// damper through which vibration is felt (eq. 17).
struct Finger {
  double mass_kg{0.058};
  double stiffness_n_per_m{300.0};
  double damping_n_s_per_m{3.0};
};

struct RenderSettings {
  double dt_s{1e-3};
  double penalty_stiffness_n_per_m{3000.0};
  double release_height_m{5e-4};
  Integrator integrator{Integrator::exact};
  Finger finger;
  SinusoidShape sinusoid;
};

// What the finger meets: the upper face of a plate, or every side of a surface of triangles.
using TouchedShape = std::variant<PlateFace, std::shared_ptr<const TriangleTree>>;

// The model of a plate together with what finds a place on it. Built once, shared by renderers.
struct VibratingPlate {
  // A plate, of which the upper face is touched.
  explicit VibratingPlate(ModalModel modal);
  // A body that is touched on the very triangles of its model.
  static VibratingPlate touched_all_over(ModalModel modal);

  ModalModel model;
  std::optional<SurfaceLocator> locator;          // of a plate
  std::shared_ptr<const TriangleTree> triangles;  // of any other body

 private:
  struct AllOver {};
  VibratingPlate(ModalModel modal, AllOver all_over);
};

struct RenderedTick {
  Contact contact;
  ForceParts parts;
  Vec3 force_n{Vec3::Zero()};  // on the finger, plate frame
};

// One stimulus: from the finger's state to the force on it, by one technique.
//
// Impact. The finger loses the momentum p = -m (n.v) n (eq. 14); by Newton's third law the plate
// receives the opposite, along the finger's motion, spread by the shape functions at the god-object
// (eq. 15). Vibration is felt while touching, through the finger's spring and damper (eq. 16, 17).
class TapRenderer {
 public:
  // plate may be nullptr where the technique has no vibration; it must outlive the renderer. A body
  // that vibrates is touched on its own model's triangles.
  TapRenderer(const Technique& technique, const RenderSettings& settings, TouchedShape shape,
              const VibratingPlate* plate);
  RenderedTick tick(const HandState& tip) noexcept;
  bool is_touching() const noexcept;  // NOLINT(bugprone-exception-escape)
  // Of the vibrating plate, kinetic plus elastic.
  double plate_energy_j() const noexcept { return vibration_ ? vibration_->energy_j() : 0.0; }
  // Goes on in silence where another renderer left the finger, off the plate.
  void take_over_from(const TapRenderer& other) noexcept;  // NOLINT(bugprone-exception-escape)

 private:
  void excite(const Contact& contact) noexcept;
  SurfacePoint place_of(const Contact& contact) const noexcept;
  ForceParts parts(const Contact& contact) const noexcept;

  RenderSettings settings_;
  TouchedShape shape_;
  std::variant<PlateContact, SurfaceContact> contact_;
  const VibratingPlate* plate_;
  std::optional<ModalState> vibration_;
  std::optional<DecayingSinusoid> sinusoid_;
};
}  // namespace tapstudy::core
