#include "runner/accuracy/felt_force.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"
#include "core/model/stopwatch.hpp"
#include "core/techniques/make_renderer.hpp"
#include "runner/stimuli/model_library.hpp"
namespace tapstudy::runner {
namespace {
constexpr double above_m = 1e-3;
constexpr double below_m = 1e-6;
constexpr double circle_m = 1e-3;
constexpr std::size_t batches = 15;
constexpr int ticks_a_batch = 1000;

// Measures the plate's vibration, regardless of the stimulus's technique.
// In contact from its second tick on.
core::TapRenderer renderer_of(const core::VibratingPlate& plate, const core::Shape& shape,
                              const core::RenderSettings& settings, const Strike& strike) {
  core::TapRenderer renderer =
      core::make_renderer(plate_alone(), settings, touched_shape(shape), &plate);
  renderer.tick(
      {strike.at_m + core::Vec3{0.0, 0.0, above_m}, core::Vec3{0.0, 0.0, -strike.speed_m_s}});
  return renderer;
}

core::HandState touching(const Strike& strike) {
  return {strike.at_m - core::Vec3{0.0, 0.0, below_m}, {0.0, 0.0, -strike.speed_m_s}};
}
}  // namespace

const core::Technique& plate_alone() {
  static const core::Technique technique{"plate alone", {&core::plate_vibration}};
  return technique;
}

Eigen::ArrayXd felt_force_n(const core::VibratingPlate& plate, const core::Shape& shape,
                            const core::RenderSettings& settings, const Strike& strike,
                            Eigen::Index ticks) {
  core::TapRenderer renderer = renderer_of(plate, shape, settings, strike);
  Eigen::ArrayXd force_n{ticks};
  for (double& value : force_n) {
    const core::RenderedTick tick = renderer.tick(touching(strike));
    if (!tick.contact.touching) {
      throw core::ModelError{"a finger descending on the tapping point misses the body"};
    }
    value = tick.parts.vibration_n;
  }
  return force_n;
}

double tick_ns(const core::VibratingPlate& plate, const core::Shape& shape,
               const core::RenderSettings& settings, const Strike& strike) {
  core::TapRenderer renderer = renderer_of(plate, shape, settings, strike);
  std::array<double, batches> seconds{};
  double angle = 0.0;
  for (double& batch_s : seconds) {
    core::Stopwatch watch;
    for (int tick = 0; tick < ticks_a_batch; ++tick) {
      core::HandState tip = touching(strike);
      tip.position_m.x() += circle_m * std::cos(angle);
      tip.position_m.y() += circle_m * std::sin(angle);
      angle += 1e-2;
      renderer.tick(tip);
    }
    batch_s = watch.lap_s();
  }
  std::ranges::nth_element(seconds, seconds.begin() + batches / 2);
  return 1e9 * seconds.at(batches / 2) / ticks_a_batch;
}
}  // namespace tapstudy::runner
