#include "runner/commands/lost_modes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>
namespace tapstudy::runner {
void print_lost_modes(const protocols::Protocol& protocol, ModelLibrary& models,
                      double vibration_band_hz) {
  fmt::print("\nvibration band of the device: up to {} Hz\n", vibration_band_hz);
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (!stimulus.technique->needs_model()) {
      continue;
    }
    const auto plate = models.plate_of(protocol, stimulus_with(protocol, stimulus));
    const Eigen::ArrayXd frequencies_hz = plate->model.frequency_hz;
    std::vector<std::string> lost;
    for (const double frequency_hz : frequencies_hz) {
      if (frequency_hz > vibration_band_hz) {
        lost.push_back(fmt::format("{:.0f}", frequency_hz));
      }
    }
    fmt::print("  {}: {}\n", stimulus.name,
               lost.empty() ? fmt::format("all {} modes", frequencies_hz.size())
                            : fmt::format("{} of {} modes are lost, at {} Hz", lost.size(),
                                          frequencies_hz.size(), fmt::join(lost, ", ")));
  }
}
}  // namespace tapstudy::runner
