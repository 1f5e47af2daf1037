#include "core/tick/tap_renderer.hpp"
namespace tapstudy::core {
namespace {
const Vec3 outward{0.0, 0.0, 1.0};
}

TapRenderer::TapRenderer(const Technique& technique, const RenderSettings& settings,
                         double half_x_m, double half_y_m, const VibratingPlate* plate)
    : settings_{settings},
      contact_{half_x_m, half_y_m, settings.release_height_m},
      plate_{technique.vibration ? plate : nullptr} {
  if (plate_ != nullptr) {
    vibration_.emplace(plate_->model, settings.integrator, settings.dt_s);
  }
  if (technique.sinusoid) {
    sinusoid_.emplace(settings.sinusoid);
  }
}

RenderedTick TapRenderer::tick(const HandState& tip) noexcept {
  if (vibration_) {
    vibration_->tick();
  }
  if (sinusoid_) {
    sinusoid_->tick(settings_.dt_s);
  }
  RenderedTick rendered;
  rendered.contact = contact_.tick(tip);
  if (rendered.contact.touching) {
    excite(rendered.contact);
    rendered.parts = parts(rendered.contact);
    rendered.force_n = rendered.parts.total_n() * outward;
  }
  return rendered;
}

void TapRenderer::excite(const Contact& contact) noexcept {
  if (vibration_) {
    const Vec3& at = contact.god_object_m;
    vibration_->touch(plate_->locator.locate(at.x(), at.y()), outward);
  }
  if (!contact.struck) {
    return;
  }
  if (vibration_) {
    vibration_->strike(-settings_.finger.mass_kg * contact.impact_speed_m_s);
  }
  if (sinusoid_) {
    sinusoid_->strike(contact.impact_speed_m_s);
  }
}

ForceParts TapRenderer::parts(const Contact& contact) const noexcept {
  ForceParts parts;
  parts.penalty_n = settings_.penalty_stiffness_n_per_m * contact.penetration_m;
  if (vibration_) {
    parts.vibration_n = settings_.finger.stiffness_n_per_m * vibration_->displacement_m() +
                        settings_.finger.damping_n_s_per_m * vibration_->velocity_m_s();
  }
  if (sinusoid_) {
    parts.sinusoid_n = sinusoid_->force_n();
  }
  return parts;
}

void TapRenderer::take_over_from(const TapRenderer& other) noexcept {
  contact_.continue_from(other.contact_);
  if (vibration_) {
    vibration_->reset();
  }
  if (sinusoid_) {
    sinusoid_->reset();
  }
}
}  // namespace tapstudy::core
