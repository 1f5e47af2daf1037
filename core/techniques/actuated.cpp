#include "core/techniques/actuated.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "core/techniques/compensated.hpp"
namespace tapstudy::core {
std::complex<double> inverse_at(double frequency_hz, const ActuatorResponse& response) {
  const double gain =
      std::min(response.magnitude.max_boost, 1.0 / gain_at(frequency_hz, response.magnitude));
  const std::vector<DeviceResponse::Point>& points = response.magnitude.points;
  const auto above =
      std::ranges::lower_bound(points, frequency_hz, {}, &DeviceResponse::Point::frequency_hz);
  if (above == points.begin()) {
    return std::polar(gain, -response.phase_rad.front());
  }
  if (above == points.end()) {
    return std::polar(gain, -response.phase_rad.back());
  }
  const auto next = static_cast<std::size_t>(std::distance(points.begin(), above));
  const double from_hz = points[next - 1].frequency_hz;
  const double share = std::log(frequency_hz / from_hz) / std::log(above->frequency_hz / from_hz);
  return std::polar(gain,
                    -std::lerp(response.phase_rad[next - 1], response.phase_rad[next], share));
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
  return {plate, inverse, settings, std::move(sinusoid), sample_s};
}
}  // namespace tapstudy::core
