#include "runner/commands/lost_modes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/techniques/compensated.hpp"
namespace tapstudy::runner {
namespace {
constexpr double usual_band_hz = 300.0;
constexpr double least_gain = 0.5;

struct Band {
  double highest_hz{};
  const core::DeviceResponse* response{};  // nullptr: not measured
  std::string words;
  bool holds(double frequency_hz) const {
    return frequency_hz <= highest_hz &&
           (response == nullptr || core::gain_at(frequency_hz, *response) >= least_gain);
  }
};

std::optional<Band> band_of(const protocols::Rig& rig) {
  const core::DeviceResponse* const response = rig.vibration_response.get();
  if (!rig.vibration_band_hz && response == nullptr && !rig.has_hardware) {
    return std::nullopt;
  }
  Band band{std::numeric_limits<double>::infinity(), response, {}};
  if (rig.vibration_band_hz || response == nullptr) {
    band.highest_hz = rig.vibration_band_hz.value_or(usual_band_hz);
    band.words = fmt::format("up to {} Hz{}", band.highest_hz,
                             rig.vibration_band_hz ? "" : ", as the rig states none");
  }
  if (response != nullptr) {
    band.words += fmt::format("{}where its response is at least {}", band.words.empty() ? "" : ", ",
                              least_gain);
  }
  return band;
}
}  // namespace

void print_lost_modes(const protocols::Protocol& protocol, ModelLibrary& models,
                      const protocols::Rig& rig) {
  const auto band = band_of(rig);
  if (!band) {
    return;
  }
  fmt::print("\nvibration band of the device: {}\n", band->words);
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (!stimulus.technique->needs_model()) {
      continue;
    }
    const auto plate = models.plate_of(protocol, stimulus_with(protocol, stimulus));
    const Eigen::ArrayXd frequencies_hz = plate->model.frequency_hz;
    std::vector<std::string> lost;
    for (const double frequency_hz : frequencies_hz) {
      if (!band->holds(frequency_hz)) {
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
