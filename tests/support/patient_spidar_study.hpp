#pragma once
#include <string>
#include <utility>
#include <vector>

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
                                             {"max_late_ticks_in_a_row: 20",
                                              "max_late_ticks_in_a_row: 1000000, max_stall_s: 0.1"},
                                             {"max_reply_s: 0.003}", "max_reply_s: 0.05}"}}));
}
}  // namespace tapstudy::testing
