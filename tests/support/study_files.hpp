#pragma once
#include <string>
#include <utility>
#include <vector>

#include "protocols/reader/read_protocol.hpp"
#include "support/texts.hpp"
namespace tapstudy::testing {
inline std::string changed_file(const std::string& name,
                                const std::vector<std::pair<std::string, std::string>>& changes) {
  std::string text = contents(shipped(name));
  for (const auto& [from, to] : changes) {
    text = replaced(text, from, to);
  }
  return text;
}

// study.yaml, slow enough for the mocked kernel, and a rig.yaml that is patient with it.
inline void write_patient_spidar_study(const TempDirectory& directory) {
  write(directory / "study.yaml",
        changed_file("paper/discrimination.yaml",
                     {{"rate_hz: 1000", "rate_hz: 500"},
                      {"band_limit_hz: 300", "band_limit_hz: 200"},
                      {"penalty_stiffness_n_per_m: 3000", "penalty_stiffness_n_per_m: 1000"},
                      {"repetitions: 2", "repetitions: 1"}}));
  write(directory / "spidar_calibration.yaml",
        contents(source("tests/data/spidar_calibration.yaml")));
  write(directory / "rig.yaml",
        changed_file("rigs/spidar_g6.yaml", {{"force_rise_s: 0.5", "force_rise_s: 0.1"},
                                             {"fifo_priority: 80", "fifo_priority: 0"},
                                             {"max_late_s: 0.02",
                                              "max_late_s: 1000, max_stall_s: 0.1, "
                                              "max_missed_share: 1"},
                                             {"max_reply_s: 0.003}", "max_reply_s: 0.05}"}}));
}

// A study of one stimulus, 'a', an acrylic plate on two screws.
inline const std::string varied_study_text = R"(format: tapstudy/1
title: One stimulus
finger: {mass_kg: 0.058, stiffness_n_per_m: 300, damping_n_s_per_m: 3}
rendering:
  rate_hz: 1000
  band_limit_hz: 300
  penalty_stiffness_n_per_m: 2000
  sinusoid: {amplitude_n_s_per_m: 3, decay_per_s: 600, frequency_hz: 250}
placement: {origin_m: [0, 0, 0], lateral_scale: 0.1}
materials:
  acrylic:
    youngs_modulus_pa: 3.2e9
    density_kg_per_m3: 1180
    poissons_ratio: 0.35
    damping: {alpha_per_s: 60, beta_s: 8.0e-5}
plates:
  screwed:
    size_m: [0.6, 0.4, 0.02]
    mesh: {order: 1}
    fixations:
      - {region: disc, at_m: [-0.25, -0.15], radius_m: 0.02, face: both}
      - {region: box, low_m: [0.2, -0.2, -0.02], high_m: [0.3, -0.1, 0]}
tapping_points_m: {P: [0.1, 0.15], Q: [-0.24, 0.15]}
stimuli:
  a:
    plate: screwed
    material: acrylic
    technique: fem+sinusoid
)";

// The same, where 'a' varies: the lines under `vary`, each such as "density_kg_per_m3: {…}".
inline std::string varied_study_text_with(const std::vector<std::string>& axes) {
  std::string text = varied_study_text + "    vary:\n";
  for (const std::string& axis : axes) {
    text += "      " + axis + "\n";
  }
  return text;
}
inline protocols::Protocol varied_study(const std::vector<std::string>& axes) {
  return protocols::parse_protocol(varied_study_text_with(axes), "study.yaml");
}
}  // namespace tapstudy::testing
