#pragma once
#include <fmt/format.h>

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/model/modal_model.hpp"
#include "core/model/model_cache.hpp"
#include "core/model/plate_model.hpp"
#include "core/settings/actuator_settings.hpp"
#include "core/techniques/actuated.hpp"
#include "core/tick/actuator_voice.hpp"
#include "core/tick/tap_renderer.hpp"
#include "core/tick/vibrating_plate.hpp"
#include "protocols/axes/presented_stimulus.hpp"
#include "protocols/protocol.hpp"
#include "runner/session/stimuli/felt_modes.hpp"
#include "runner/session/stimuli/mesh_accuracy.hpp"
namespace tapstudy::runner {
// Builds something of a stimulus's model. A ModelError names the protocol's line at fault, the
// stimulus and the values at which it is presented.
template <class Build>
auto at_its_line(const protocols::PresentedStimulus& stimulus, const Build& build) {
  const auto told = [&](const std::string& stated_at, const core::ModelError& error) {
    return core::ModelError{fmt::format("{}: {}: {}", stated_at, stimulus.title(), error.what())};
  };
  try {
    return build();
  } catch (const core::DampingError& error) {
    throw told(stimulus.material->damping_stated_at, error);
  } catch (const core::ModelError& error) {
    // what can be built as stated, and not at these values, is the fault of the values
    throw told(stimulus.changed.empty() ? stimulus.plate->stated_at : stimulus.vary_stated_at,
               error);
  }
}

// The model specification of a stimulus's plate.
core::PlateSpec plate_spec(const protocols::Protocol& protocol,
                           const protocols::PresentedStimulus& stimulus);

// The unit-material body from which all vibrating stimuli with the same plate and Poisson's ratio,
// or orthotropy, are scaled, with all their members: solved up to the highest band limit that any
// of them needs.
core::BodySpec body_spec(const protocols::Protocol& protocol,
                         const protocols::PresentedStimulus& stimulus);

// A body without a mode in the band would be felt as one that does not vibrate at all. Throws
// ModelError with the first frequency above it.
void check_has_mode(Eigen::Index modes_in_band, const core::PlateSpec& spec);

// The collision geometry of a non-vibrating body.
core::TouchedShape touched_shape(const core::Shape& shape);

// Ready to be touched: a box on its upper face, any other shape all over.
core::VibratingPlate vibrating_plate(const core::Shape& shape, core::ModalModel model);

// Models of this program's version: in $TAPSTUDY_CACHE, else $XDG_CACHE_HOME/tapstudy, else
// ~/.cache/tapstudy; without any, nowhere.
core::ModelCache user_model_cache();

// Models of plates: each body is solved once for all materials that share it, and only if a
// vibrating technique needs it. Thread-safe.
class ModelLibrary {
 public:
  using Plate = std::shared_ptr<const core::VibratingPlate>;
  using Body = std::shared_ptr<const core::BodyModes>;
  // What is kept in a cache holds an estimate: without one only where the cache has no place.
  explicit ModelLibrary(core::ModelCache cache = user_model_cache(),
                        core::ErrorEstimation estimation = core::ErrorEstimation::wanted)
      : cache_{std::move(cache)}, estimation_{estimation} {}

  // Throws InvalidInput or ModelError, naming the stimulus and its values. After build_all neither
  // meshes nor solves. Only plates of stimuli at their own values are kept: of a family as many may
  // be presented as there are trials.
  Plate plate_of(const protocols::Protocol& protocol, const protocols::PresentedStimulus& stimulus);
  Body body_of(const protocols::Protocol& protocol, const protocols::PresentedStimulus& stimulus);
  // The bodies of all members of a vibrating stimulus, each for its values of the tabled axes.
  std::vector<Body> bodies_of(const protocols::Protocol& protocol,
                              const protocols::Stimulus& stimulus);
  // Builds all models that the protocol needs, and checks that every member of its families can be
  // built of them, so that errors are reported first.
  void build_all(const protocols::Protocol& protocol);

  // What `mesh: auto` asks for in this study: its bodies are solved to the usual accuracy for that.
  AutomaticMesh automatic_mesh(const protocols::Protocol& protocol);

  // What one of the two renders of a stimulus; null where its technique needs no model. Without a
  // crossover all is the device's.
  Plate rendered_by(core::RenderedBy by, const protocols::Protocol& protocol,
                    const protocols::PresentedStimulus& stimulus);

  int bodies_solved() const { return solved_; }  // not found in memory or on disk
  int bodies_used() const { return static_cast<int>(bodies_.size()); }

 private:
  Body body(const protocols::Protocol& protocol, const protocols::PresentedStimulus& stimulus);
  Body solved_once(const core::BodySpec& spec, const std::string& name);
  AutomaticMesh mesh_for(const protocols::Protocol& protocol);
  Plate make_plate(const protocols::Protocol& protocol,
                   const protocols::PresentedStimulus& stimulus);

  std::mutex mutex_;
  core::ModelCache cache_;
  core::ErrorEstimation estimation_;
  std::map<std::string, Body> bodies_;  // by content key
  std::map<std::string, Plate> plates_;
  std::map<std::pair<Plate, core::RenderedBy>, Plate> shares_;  // of those
  int solved_{0};
};

// A trial's alternatives, ready to be rendered, with the models they need.
struct TrialStimuli {
  std::vector<ModelLibrary::Plate> plates;
  std::vector<core::TapRenderer> alternatives;
  std::vector<core::ActuatorVoice> voices;  // of the alternatives, if an actuator renders them
};

// Of stimuli as they are presented; after ModelLibrary::build_all without meshing or solving.
// actuator: that which renders its share of them; nullptr: nobody does.
TrialStimuli build_trial_stimuli(const protocols::Protocol& protocol,
                                 const std::vector<protocols::PresentedStimulus>& stimuli,
                                 ModelLibrary& models,
                                 const core::ActuatorOutput* actuator = nullptr);
// Of these, at their own values.
TrialStimuli build_trial_stimuli(const protocols::Protocol& protocol,
                                 const std::vector<std::string>& stimuli, ModelLibrary& models);

struct CachedModel {
  core::ModalModel modal;  // the modes in the band that are rendered
  std::vector<UnfeltMode> dropped;
  core::ModelReport report;  // of the body that it is scaled from
  core::FrequencyErrors errors;
};
// Of a stimulus at its own values; nullopt: not in the cache. Nothing is computed but the scaling.
std::optional<CachedModel> cached_model(const protocols::Protocol& protocol,
                                        const protocols::Stimulus& stimulus,
                                        const core::ModelCache& cache);

// The key under which the protocol has a plate or material; empty: none.
template <class Named>
std::string name_in(const std::map<std::string, std::shared_ptr<const Named>>& all,
                    const std::shared_ptr<const Named>& wanted) {
  for (const auto& [name, one] : all) {
    if (one == wanted) {
      return name;
    }
  }
  return {};
}
}  // namespace tapstudy::runner
