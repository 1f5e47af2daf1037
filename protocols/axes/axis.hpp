#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/techniques/technique.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
struct PresentedStimulus;  // protocols/axes/presented_stimulus.hpp

// scaled   every value can be presented: settings, or a solved body scaled exactly to a material
//          (omega ~ sqrt(E / rho), M-orthonormal shapes ~ 1 / sqrt(rho))
// tabled   each value needs a body of its own, solved before the session: only listed values can be
//          presented
enum class AxisKind { scaled, tabled };

// A property along which a stimulus may vary: one row of axis_table.cpp. Nothing else knows an
// axis by its name.
struct Axis {
  std::string_view name;      // in protocols, on the command line and in data; ends in its unit
  std::string_view quantity;  // in reports
  std::string_view unit;      // SI; empty for a ratio
  AxisKind kind{};
  bool (*is_used_by)(const core::Technique& technique){};  // null: by all
  bool is_of_boxes{};                                      // other shapes cannot vary so
  bool is_without_springs{};                               // plates on springs do not scale so
  // What the stimulus allows: what the study's own key allows, or less.
  Range (*allowed)(const PresentedStimulus& stimulus){};
  double (*value)(const PresentedStimulus& stimulus){};
  // Plates and materials are shared: it exchanges them for changed copies.
  void (*set)(PresentedStimulus& stimulus, double value){};
  bool is_without_contacts{false};  // plates that touch other bodies do not scale so
  bool is_of_rendering{false};  // no property of plate or material: a stimulus may state its own
};

const std::vector<Axis>& axes();
// nullptr if there is none of that name.
const Axis* find_axis(std::string_view name);
std::vector<std::string> axis_names();

// Why this stimulus does not use the axis, in words; empty if it does.
std::string refusal(const Axis& axis, const PresentedStimulus& stimulus);
}  // namespace tapstudy::protocols
