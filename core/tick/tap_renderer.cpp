#include "core/tick/tap_renderer.hpp"
namespace tapstudy::core {
namespace {
using AnyContact = std::variant<PlateContact, SurfaceContact>;

AnyContact contact_with(const TouchedShape& shape, double release_height_m) {
  if (const auto* face = std::get_if<PlateFace>(&shape)) {
    return PlateContact{*face, release_height_m};
  }
  return SurfaceContact{*std::get<1>(shape), release_height_m};
}

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

TapRenderer::TapRenderer(const Technique& technique, const RenderSettings& settings,
                         TouchedShape shape, const VibratingPlate* plate)
    : settings_{settings},
      shape_{plate != nullptr && plate->triangles ? TouchedShape{plate->triangles}
                                                  : std::move(shape)},
      contact_{contact_with(shape_, settings.release_height_m)},
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
  rendered.contact = std::visit(
      [&](auto& contact) noexcept -> const Contact& { return contact.tick(tip); }, contact_);
  if (rendered.contact.touching) {
    excite(rendered.contact);
    rendered.parts = parts(rendered.contact);
    rendered.force_n = rendered.parts.total_n() * rendered.contact.normal;
  }
  return rendered;
}

void TapRenderer::excite(const Contact& contact) noexcept {
  if (vibration_) {
    vibration_->touch(place_of(contact), contact.normal);
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

SurfacePoint TapRenderer::place_of(const Contact& contact) const noexcept {
  if (plate_->locator) {
    return plate_->locator->locate(contact.god_object_m.x(), contact.god_object_m.y());
  }
  return surface_point(plate_->model.touch_surface, contact.triangle, contact.barycentric);
}

// std::visit throws only for a variant without a value, which these never are.
// NOLINTBEGIN(bugprone-exception-escape)
bool TapRenderer::is_touching() const noexcept {
  return std::visit([](const auto& contact) { return contact.now().touching; }, contact_);
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
  const Approach approach =
      std::visit([](const auto& contact) { return contact.approach(); }, other.contact_);
  std::visit([&](auto& contact) { contact.continue_from(approach); }, contact_);
  if (vibration_) {
    vibration_->reset();
  }
  if (sinusoid_) {
    sinusoid_->reset();
  }
}
// NOLINTEND(bugprone-exception-escape)
}  // namespace tapstudy::core
