#include "runner/scene.hpp"
namespace tapstudy::runner {
Scene build_scene(const protocols::Protocol& protocol, const std::vector<std::string>& stimuli,
                  ModelLibrary& models) {
  Scene scene;
  for (const std::string& name : stimuli) {
    const protocols::Stimulus& stimulus = protocol.stimulus(name);
    const ModelLibrary::Plate plate =
        stimulus.technique->vibration ? models.plate_of(protocol, stimulus) : nullptr;
    scene.plates.push_back(plate);
    scene.alternatives.emplace_back(*stimulus.technique, protocol.rendering,
                                    touched_shape(protocol.plates.at(stimulus.plate).shape),
                                    plate.get());
  }
  return scene;
}
}  // namespace tapstudy::runner
