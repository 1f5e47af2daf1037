#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "core/model/plate_model.hpp"
#include "core/tick/tap_renderer.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// What a stimulus's plate is to the model.
core::PlateSpec plate_spec(const protocols::Protocol& protocol,
                           const protocols::Stimulus& stimulus);

// Models of plates, each built once however many stimuli share it, and only when a technique that
// vibrates asks for it. May be used by several threads.
class ModelLibrary {
 public:
  using Plate = std::shared_ptr<const core::VibratingPlate>;
  // Throws InvalidInput or ModelError, naming the stimulus.
  Plate plate_of(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus);
  // All that the protocol needs, so that what cannot be built is refused before anything else.
  void build_all(const protocols::Protocol& protocol);

 private:
  std::mutex mutex_;
  std::map<std::string, Plate> plates_;
};
}  // namespace tapstudy::runner
