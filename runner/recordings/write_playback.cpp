#include <fmt/format.h>

#include "runner/recordings/writers.hpp"
namespace tapstudy::runner {
namespace {
std::string samples_of(const Eigen::VectorXd& samples, double newtons_per_unit) {
  std::string text;
  for (const double sample : samples) {
    text += fmt::format("{}{:.5g}", text.empty() ? "" : ", ", newtons_per_unit * sample);
  }
  return text;
}
}  // namespace

std::string playback_of(const TapIdentification& found, double finger_kg) {
  const double newtons_per_unit = finger_kg * found.question.si_per_unit;
  std::string text = fmt::format(
      "# tapstudy identify: {} taps as the forces that give the protocol's finger the recorded\n"
      "# accelerations, those of a fingertip or stylus; of a sensor on the plate they are too "
      "large.\n# To be pasted over the key of the same name.\n"
      "recordings:\n  {}:\n    rate_hz: {:.9g}\n    taps:\n",
      found.taps.size(), found.question.stimulus, found.taps.front().whole.rate_hz);
  for (const IdentifiedTap& tap : found.taps) {
    text += fmt::format(
        "      - at_m: [{:g}, {:g}]\n        speed_m_s: {:.6g}\n        force_n: [{}]\n",
        found.question.at_m->x(), found.question.at_m->y(), *tap.speed_m_s,
        samples_of(tap.whole.samples, newtons_per_unit));
  }
  return text;
}
}  // namespace tapstudy::runner
