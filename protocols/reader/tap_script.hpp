#pragma once
#include <optional>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
namespace tapstudy::protocols {
// What a scripted finger does next. Plate frame.
struct TapStep {
  enum class Action { strike, press, slide, release };
  Action action{};
  std::optional<double> start_s;  // of a strike, when it hits; unset: as soon as it can
  Eigen::Vector2d place_m{Eigen::Vector2d::Zero()};  // of a strike and the end of a slide
  double speed_m_s{};                                // of all but a press
  double force_n{};       // at rest, of a strike and a press: see aim_below_m (runner)
  double duration_s{};    // of a press, until the force is reached
  std::string stated_at;  // "file:line:column: key.path", for errors found later
};

struct TapScript {
  std::vector<TapStep> steps;  // at least one
  double rest_s{};             // how long the last one is held
};

// Parses the steps of a finger from YAML; `file` is its name in messages. Tapping points are those
// of the plate. Throws InvalidInput listing every problem of the file, one per line: unknown or
// missing keys, values out of range, steps in an order that no finger can do.
TapScript parse_tap_script(const std::string& text, const std::string& file, const Plate& plate);
}  // namespace tapstudy::protocols
