#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/techniques/technique.hpp"
#include "protocols/yaml/yaml_reader.hpp"
// The ranges of properties that are read from a study and that an axis of a stimulus may vary.
namespace tapstudy::protocols::allowed {
inline constexpr Range youngs_modulus_pa{1e3, 1e13};  // 1 kPa is softer than any foam
inline constexpr Range density_kg_per_m3{0.0, 1e5, false};
inline constexpr Range poissons_ratio{-1.0, 0.5, false, false};
inline constexpr Range poissons_ratios{-1e3, 1e3};  // sqrt(E_i / E_j) bounds them
inline constexpr Range alpha_per_s{0.0, 1e6};
inline constexpr Range beta_s{0.0, 1e3};
inline constexpr Range damping_ratio{0.0, 100.0};
inline constexpr Range spring_n_per_m{0.0, 1e12};
inline constexpr Range edge_m{1e-4, 10.0};
inline constexpr Range penalty_stiffness_n_per_m{0.0, 1e6, false};
inline constexpr Range sinusoid_amplitude_n_s_per_m{0.0, 1000.0};
inline constexpr Range sinusoid_decay_per_s{0.0, 1e6, false};
inline constexpr Range sinusoid_frequency_hz{0.0, 1e4, false};
}  // namespace tapstudy::protocols::allowed

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
  std::string_view meaning;   // in the reference of keys
  AxisKind kind{};
  bool (*is_used_by)(const core::Technique& technique){};  // null: by all
  bool is_of_boxes{};                                      // other shapes cannot vary so
  bool is_without_springs{};                               // plates on springs do not scale so
  // What the stimulus allows: what the study's own key allows, or less.
  Range (*allowed)(const PresentedStimulus& stimulus){};
  Range of_any_stimulus;
  double (*value)(const PresentedStimulus& stimulus){};
  // Plates and materials are shared: it exchanges them for changed copies.
  void (*set)(PresentedStimulus& stimulus, double value){};
  bool is_without_contacts{false};  // plates that touch other bodies do not scale so
  bool is_of_rendering{false};  // no property of plate or material: a stimulus may state its own
  bool is_of_isotropic{false};  // orthotropic materials have no such property
};

const std::vector<Axis>& axes();
// nullptr if there is none of that name.
const Axis* find_axis(std::string_view name);
std::vector<std::string> axis_names();

// Why this stimulus does not use the axis, in words; empty if it does.
std::string refusal(const Axis& axis, const PresentedStimulus& stimulus);
}  // namespace tapstudy::protocols
