#pragma once
#include "core/techniques/technique.hpp"
#include "core/tick/tap_renderer.hpp"
namespace tapstudy::core {
// The renderer of a shape by a technique. plate may be nullptr where the technique needs no model;
// it must outlive the renderer. A body that vibrates is touched on its own model's triangles.
TapRenderer make_renderer(const Technique& technique, const RenderSettings& settings,
                          TouchedShape shape, const VibratingPlate* plate);
}  // namespace tapstudy::core
