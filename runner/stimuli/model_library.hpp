#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "core/model/model_cache.hpp"
#include "core/model/plate_model.hpp"
#include "core/tick/tap_renderer.hpp"
#include "core/tick/vibrating_plate.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// What a stimulus's plate is to the model.
core::PlateSpec plate_spec(const protocols::Protocol& protocol,
                           const protocols::Stimulus& stimulus);

// The body that all vibrating stimuli of one plate and Poisson's ratio are scaled from: solved up
// to the highest band that any of them needs.
core::BodySpec body_spec(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus);

// What a finger meets where nothing vibrates.
core::TouchedShape touched_shape(const core::Shape& shape);

// Ready to be touched: a box on its upper face, any other shape all over.
core::VibratingPlate vibrating_plate(const core::Shape& shape, core::ModalModel model);

// Models of this program's version: in $TAPSTUDY_CACHE, else $XDG_CACHE_HOME/tapstudy, else
// ~/.cache/tapstudy; without any, nowhere.
core::ModelCache models_of_this_user();

// Models of plates: each body solved once however many materials share it, and only when a
// technique that vibrates asks for it. May be used by several threads.
class ModelLibrary {
 public:
  using Plate = std::shared_ptr<const core::VibratingPlate>;
  using Body = std::shared_ptr<const core::BodyModes>;
  explicit ModelLibrary(core::ModelCache cache = models_of_this_user())
      : cache_{std::move(cache)} {}

  // Throws InvalidInput or ModelError, naming the stimulus.
  Plate plate_of(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus);
  Body body_of(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus);
  // All that the protocol needs, so that what cannot be built is refused before anything else.
  void build_all(const protocols::Protocol& protocol);

  int bodies_solved() const { return solved_; }  // not found in memory or on disk
  int bodies_used() const { return static_cast<int>(bodies_.size()); }

 private:
  Body body(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus);

  std::mutex mutex_;
  core::ModelCache cache_;
  std::map<std::string, Body> bodies_;  // by content key
  std::map<std::string, Plate> plates_;
  int solved_{0};
};
}  // namespace tapstudy::runner
