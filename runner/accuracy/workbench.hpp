#pragma once
#include <vector>

#include "core/model/plate_model.hpp"
#include "core/model/progress_hook.hpp"
#include "protocols/protocol.hpp"
#include "runner/accuracy/errors.hpp"
#include "runner/accuracy/felt_force.hpp"
namespace tapstudy::runner {
// One stimulus, to be built and struck with various settings.
class Workbench {
 public:
  // Throws InvalidInput if no tapping point is on the plate.
  Workbench(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus,
            core::ProgressHook progress);

  const core::PlateSpec& spec() const { return spec_; }
  core::BodyModes solve(const core::Meshing& mesh, double band_limit_hz) const;
  // Damping given as two ratios depends on the modes of each model; fixes its Rayleigh coefficients
  // to those of this body, in the protocol's band.
  void fix_damping(const core::BodyModes& body);
  core::ModalModel model_of(const core::BodyModes& body, double band_limit_hz) const;
  core::VibratingPlate plate_of(core::ModalModel model) const;
  // For 0.3 s after a strike on each tapping point, at the protocol's ticks whatever the rate,
  // which must be a whole multiple of the protocol's.
  Forces forces_n(const core::VibratingPlate& plate, core::Integrator integrator,
                  double rate_hz) const;
  double tick_ns(const core::VibratingPlate& plate) const;
  // Mode shapes on a grid over the body, seen from above; the same points for every mesh.
  SampledModes sampled(const core::VibratingPlate& plate) const;

 private:
  const protocols::Protocol& protocol_;
  core::RenderSettings rendering_;  // the stimulus's
  core::PlateSpec spec_;
  core::ProgressHook progress_;
  std::vector<Strike> strikes_;
};
}  // namespace tapstudy::runner
