#include "runner/recordings/rate_error.hpp"

namespace tapstudy::runner {
namespace {
void widen(double factor, analysis::Interval& interval) {
  interval.low *= interval.low > 0.0 ? 1.0 / factor : factor;
  interval.high *= interval.high > 0.0 ? factor : 1.0 / factor;
}

void widen(double factor, analysis::Estimate& estimate) {
  widen(factor, estimate.interval);
  if (estimate.bootstrap) {
    widen(factor, *estimate.bootstrap);
  }
}
}  // namespace

void include_rate_error(double share, TapIdentification& identified) {
  const double factor = 1.0 + share;
  for (analysis::RepeatedMode& mode : identified.modes) {
    widen(factor, mode.frequency_hz);
  }
  if (identified.rayleigh) {
    widen(factor, identified.rayleigh->alpha_per_s);
    widen(factor, identified.rayleigh->beta_s);
  }
  if (identified.sinusoid) {
    widen(factor, identified.sinusoid->decay_per_s);
    widen(factor, identified.sinusoid->frequency_hz);
  }
  if (identified.model && identified.model->update) {
    widen(factor * factor, identified.model->update->youngs_modulus_pa);
  }
  if (identified.model && identified.model->springs) {
    widen(factor * factor, identified.model->springs->factor);
  }
}
}  // namespace tapstudy::runner
