#include "core/techniques/actuated.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/techniques/compensated.hpp"
#include "core/techniques/divided_recording.hpp"
namespace tapstudy::core {
std::complex<double> inverse_at(double frequency_hz, const ActuatorResponse& response) {
  const PlaceInResponse place = place_in(response.magnitude, frequency_hz);
  const double lead_rad =
      -std::lerp(response.phase_rad[place.from], response.phase_rad[place.to], place.share);
  return std::polar(boost_at(frequency_hz, response.magnitude), lead_rad);
}

ModalModel share_of(const ModalModel& model, const Crossover& crossover, RenderedBy by) {
  std::vector<Eigen::Index> rendered;
  std::vector<double> roots;
  for (Eigen::Index i = 0; i < model.frequency_hz.size(); ++i) {
    const double actuators = crossover.actuator_share(model.frequency_hz[i]);
    const double share = by == RenderedBy::actuator ? actuators : 1.0 - actuators;
    if (share > 0.0) {
      rendered.push_back(i);
      roots.push_back(std::sqrt(share));
    }
  }
  ModalModel part = model;
  part.frequency_hz = model.frequency_hz(rendered).eval();
  part.damping_ratio = model.damping_ratio(rendered).eval();
  part.shape = model.shape(Eigen::all, rendered).eval();
  for (Eigen::Index i = 0; i < part.shape.cols(); ++i) {
    part.shape.col(i) *= roots[static_cast<std::size_t>(i)];
  }
  return part;
}

ActuatorVoice make_voice(const Technique& technique, const RenderSettings& settings,
                         const VibratingPlate* actuated, const ActuatorResponse& response,
                         double sample_s) {
  const VibratingPlate* const plate = technique.has(plate_vibration) ? actuated : nullptr;
  std::vector<std::complex<double>> inverse;
  for (Eigen::Index i = 0; plate != nullptr && i < plate->model.frequency_hz.size(); ++i) {
    inverse.push_back(inverse_at(plate->model.frequency_hz[i], response));
  }
  std::optional<DecayingSinusoid> sinusoid;
  if (technique.has(decaying_sinusoid)) {
    SinusoidShape shape = settings.sinusoid;
    const std::complex<double> by = inverse_at(shape.frequency_hz, response);
    shape.amplitude_n_s_per_m *=
        settings.crossover->actuator_share(shape.frequency_hz) * std::abs(by);
    sinusoid.emplace(shape, sample_s, std::arg(by));
  }
  std::optional<RecordedTransient> recorded;
  if (technique.has(recorded_transient)) {
    recorded = recorded_by(RenderedBy::actuator, settings, &response.magnitude, 1.0 / sample_s);
  }
  return {plate, inverse, settings, {std::move(sinusoid), std::move(recorded)}, sample_s};
}
}  // namespace tapstudy::core
