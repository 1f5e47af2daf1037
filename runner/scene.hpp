#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/tick/tap_renderer.hpp"
#include "protocols/protocol.hpp"
#include "runner/model_library.hpp"
namespace tapstudy::runner {
// A trial's alternatives, ready to be rendered, with the models they need.
struct Scene {
  std::vector<ModelLibrary::Plate> plates;
  std::vector<core::TapRenderer> alternatives;
};

Scene build_scene(const protocols::Protocol& protocol, const std::vector<std::string>& stimuli,
                  ModelLibrary& models);
}  // namespace tapstudy::runner
