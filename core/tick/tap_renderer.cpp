#include "core/tick/tap_renderer.hpp"

#include <utility>
namespace tapstudy::core {
namespace {
using AnyContact = std::variant<PlateContact, SurfaceContact>;

AnyContact contact_with(const TouchedShape& shape, double release_height_m) {
  if (const auto* face = std::get_if<PlateFace>(&shape)) {
    return PlateContact{*face, release_height_m};
  }
  return SurfaceContact{*std::get<1>(shape), release_height_m};
}
}  // namespace

TapRenderer::TapRenderer(const RenderSettings& settings, TouchedShape shape,
                         std::vector<std::unique_ptr<AddedForce>> added)
    : penalty_stiffness_n_per_m_{settings.penalty_stiffness_n_per_m},
      own_scale_{1.0 / settings.lateral_ratio, 1.0 / settings.lateral_ratio, 1.0},
      shape_{std::move(shape)},
      contact_{contact_with(shape_, settings.release_height_m)},
      added_{std::move(added)} {}

RenderedTick TapRenderer::tick(HandState tip, int periods) noexcept {
  tip.position_m = tip.position_m.cwiseProduct(own_scale_);
  tip.velocity_m_s = tip.velocity_m_s.cwiseProduct(own_scale_);
  for (const auto& added : added_) {
    added->advance(periods);
  }
  RenderedTick rendered;
  rendered.contact = std::visit(
      [&](auto& contact) noexcept -> const Contact& { return contact.tick(tip); }, contact_);
  if (rendered.contact.touching) {
    rendered.parts = parts_of(rendered.contact);
    rendered.force_n = rendered.parts.total_n() * rendered.contact.normal;  // eq. 18
  }
  return rendered;
}

ForceParts TapRenderer::parts_of(const Contact& contact) noexcept {
  ForceParts parts;
  parts.penalty_n = penalty_stiffness_n_per_m_ * contact.penetration_m;  // eq. 1
  for (const auto& added : added_) {
    added->touch(contact);
    if (contact.impact) {
      added->impact(contact.impact_speed_m_s);
    }
    added->add_to(parts);
  }
  return parts;
}

double TapRenderer::energy_j() const noexcept {
  double sum = 0.0;
  for (const auto& added : added_) {
    sum += added->energy_j();
  }
  return sum;
}

// std::visit throws only for a variant without a value, which these never are.
// NOLINTBEGIN(bugprone-exception-escape)
bool TapRenderer::is_touching() const noexcept {
  return std::visit([](const auto& contact) { return contact.now().touching; }, contact_);
}

void TapRenderer::take_over_from(const TapRenderer& other) noexcept {
  ContactHistory history =
      std::visit([](const auto& contact) { return contact.history(); }, other.contact_);
  // the other plate may have another lateral scale
  history.tip_m = history.tip_m.cwiseQuotient(other.own_scale_).cwiseProduct(own_scale_);
  std::visit([&](auto& contact) { contact.continue_from(history); }, contact_);
  for (const auto& added : added_) {
    added->reset();
  }
}
// NOLINTEND(bugprone-exception-escape)
}  // namespace tapstudy::core
