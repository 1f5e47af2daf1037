#pragma once
#include "protocols/yaml/yaml_reader.hpp"
// The ranges of properties that are read from a study and that an axis of a stimulus may vary.
namespace tapstudy::protocols::allowed {
inline constexpr Range youngs_modulus_pa{1e3, 1e13};  // 1 kPa is softer than any foam
inline constexpr Range density_kg_per_m3{0.0, 1e5, false};
inline constexpr Range poissons_ratio{-1.0, 0.5, false, false};
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
