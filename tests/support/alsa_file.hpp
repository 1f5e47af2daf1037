#pragma once
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "support/texts.hpp"
// A card of ALSA's own that writes what it is given to a file: its plug-in `file` over `null`.
namespace tapstudy::testing {
inline std::string file_card(const std::string& file) {
  return "file:FILE=" + file + ",FORMAT=raw";
}

// Of two channels of 32 bits the given one, full scale 1.
inline std::vector<double> channel_of(const std::string& file, std::size_t channel) {
  const std::string bytes = contents(file);
  std::vector<double> samples(bytes.size() / 8);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::int32_t sample = 0;
    std::memcpy(&sample, bytes.data() + 8 * i + 4 * channel, sizeof sample);
    samples[i] = sample / 2147483647.0;
  }
  return samples;
}

inline double rms_db(const std::vector<double>& samples) {
  double sum = 0.0;
  for (const double sample : samples) {
    sum += sample * sample;
  }
  return 10.0 * std::log10(sum / static_cast<double>(samples.size()));
}
}  // namespace tapstudy::testing
