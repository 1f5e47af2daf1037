#pragma once
#include "core/settings/render_settings.hpp"
#include "core/techniques/actuated.hpp"
#include "core/tick/impact_transients.hpp"
namespace tapstudy::core {
// The share of measured transients that one of the two renders, at their rate: each frequency by
// Crossover::actuator_share, without delay or phase. The filter's ringing before the impact is left
// out of both shares, where it adds up to zero, so that the shares add up to the recording at every
// sample.
RecordedTaps share_of(const RecordedTaps& recorded, const Crossover& crossover, RenderedBy by);

// The stimulus's recorded_taps, which must be set, as one of the two plays them at its rate: its
// share where vibration is divided, resampled, and compensated for its response, if that is known.
RecordedTransient recorded_by(RenderedBy by, const RenderSettings& settings,
                              const DeviceResponse* response, double rate_hz);
}  // namespace tapstudy::core
