#include "runner/accuracy/errors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
namespace tapstudy::runner {
using std::numbers::pi;

Eigen::ArrayXd numerical_frequency_hz(const Eigen::ArrayXd& frequency_hz,
                                      core::Integrator integrator, double rate_hz) {
  if (integrator == core::Integrator::exact) {
    return frequency_hz;
  }
  return (pi * frequency_hz / rate_hz).atan() * rate_hz / pi;
}

double frequency_error(const Eigen::ArrayXd& reference_hz, const Eigen::ArrayXd& found_hz,
                       double band_limit_hz) {
  double worst = 0.0;
  for (Eigen::Index i = 0; i < reference_hz.size(); ++i) {
    const bool is_found = i < found_hz.size();
    if (!is_found && reference_hz[i] >= band_limit_hz) {
      break;
    }
    const double found = is_found ? found_hz[i] : std::max(band_limit_hz, reference_hz[i]);
    worst = std::max(worst, std::abs(found / reference_hz[i] - 1.0));
  }
  return worst;
}

double force_error(const Forces& reference, const Forces& found) {
  return ((found - reference).matrix().colwise().norm().array() /
          reference.matrix().colwise().norm().array())
      .maxCoeff();
}

double level_error_db(const Forces& reference, const Forces& found) {
  return (20.0 *
          (found.matrix().colwise().norm().array() / reference.matrix().colwise().norm().array())
              .log10())
      .abs()
      .maxCoeff();
}

Eigen::ArrayXd held_gain(const Eigen::ArrayXd& frequency_hz, double rate_hz) {
  const Eigen::ArrayXd angle = pi * frequency_hz / rate_hz;
  return (angle.sin() / angle).abs();
}
}  // namespace tapstudy::runner
