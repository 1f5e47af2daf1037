#include "runner/experiments/cached_model.hpp"

#include "core/model/plate_model.hpp"
#include "protocols/axes/presented_stimulus.hpp"
#include "runner/stimuli/model_library.hpp"
namespace tapstudy::runner {
std::optional<CachedModel> cached_model(const protocols::Protocol& protocol,
                                        const protocols::Stimulus& stimulus,
                                        const core::ModelCache& cache) {
  const protocols::PresentedStimulus presented = protocols::stimulus_with(protocol, stimulus);
  const auto body = cache.find(core::content_key(body_spec(protocol, presented)));
  if (!body) {
    return std::nullopt;
  }
  return CachedModel{core::model_of(*body, plate_spec(protocol, presented)), body->report};
}
}  // namespace tapstudy::runner
