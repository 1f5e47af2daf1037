#pragma once
#include "core/techniques/technique.hpp"
#include "core/tick/tap_renderer.hpp"
namespace tapstudy::core {
// Creates the renderer of a shape for a technique. plate may be nullptr if the technique needs no
// model; it must outlive the renderer. A vibrating body is touched on its own model's triangles.
TapRenderer make_renderer(const Technique& technique, const RenderSettings& settings,
                          TouchedShape shape, const VibratingPlate* plate);
}  // namespace tapstudy::core
