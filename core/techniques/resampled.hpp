#pragma once
#include <vector>
namespace tapstudy::core {
// The same signal at another rate, the first sample at the same time and unchanged, as a
// transient's onset must be: limited to the lower band of the two (libsamplerate, windowed sinc).
// Rates above 0 and within a factor of 256 of each other, at least one sample.
std::vector<double> resampled(const std::vector<double>& samples, double from_hz, double to_hz);
}  // namespace tapstudy::core
