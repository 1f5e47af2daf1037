#include "runner/recordings/modes_over_all.hpp"

#include <fmt/format.h>

#include <utility>

#include "analysis/modal_identification/close_modes.hpp"
#include "core/error.hpp"
namespace tapstudy::runner {
namespace {
std::vector<analysis::TapModes> modes_of(const std::vector<IdentifiedTap>& taps) {
  std::vector<analysis::TapModes> modes;
  for (const IdentifiedTap& tap : taps) {
    modes.push_back(tap.modes);
  }
  return modes;
}

void identify_beside_lines(const analysis::ModeFinding& finding, IdentifiedTap& tap,
                           std::vector<std::string>& remarks) {
  try {
    tap.modes = analysis::identify_modes(tap.decay, finding);
  } catch (const core::InvalidInput& error) {
    remarks.push_back(
        fmt::format("{}: the tap at {:.3f} s rings too short for the {} steady tones that other "
                    "taps show: they may falsify its damping ({})",
                    tap.file, tap.time_s, finding.lines_hz.size(), error.what()));
  }
}

void share_lines(const analysis::Band& band, std::vector<IdentifiedTap>& taps,
                 std::vector<std::string>& remarks) {
  const std::vector<analysis::TapModes> alone = modes_of(taps);
  for (IdentifiedTap& tap : taps) {
    analysis::ModeFinding finding{band};
    finding.lines_hz = analysis::lines_missed(tap.modes, alone);
    if (!finding.lines_hz.empty()) {
      identify_beside_lines(finding, tap, remarks);
    }
  }
}
}  // namespace

std::vector<analysis::RepeatedMode> modes_over_all(const analysis::Band& band,
                                                   std::vector<IdentifiedTap>& taps,
                                                   std::vector<std::string>& remarks) {
  share_lines(band, taps, remarks);
  std::vector<analysis::FreeDecay> decays;
  std::vector<int> impacts;
  for (const IdentifiedTap& tap : taps) {
    decays.push_back(tap.decay);
    impacts.push_back(tap.impact);
  }
  const std::vector<analysis::TapModes> alone = modes_of(taps);
  analysis::ModesOfTaps found = analysis::tell_close_modes_apart(
      decays, impacts, band, {alone, analysis::modes_over_taps(alone, impacts)});
  for (std::size_t i = 0; i < taps.size(); ++i) {
    taps[i].modes = std::move(found.taps[i]);
  }
  return std::move(found.modes);
}
}  // namespace tapstudy::runner
