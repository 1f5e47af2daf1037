// What the pages show, and noise for the participant's ears.
#include "protocols/reader/read_sections.hpp"
namespace tapstudy::protocols {
void read_display(MapReader& top, Protocol& protocol) {
  top.map(
      {"display", "what the pages of `run --console` show"}, Presence::optional,
      [&](MapReader& reader) {
        protocol.display.shows_plate =
            reader.yes_or_no({"plate",
                              "its shape, in neutral colour, with the pointer; not in blocks whose "
                              "plates look different"},
                             protocol.display.shows_plate);
        protocol.display.shows_tapping_points =
            reader.yes_or_no({"tapping_points", "as rings"}, protocol.display.shows_tapping_points);
        protocol.display.shows_fixations =
            reader.yes_or_no({"fixations", "where the plate is held: this shows which plate it is"},
                             protocol.display.shows_fixations);
        protocol.display.is_operator_blind = reader.yes_or_no(
            {"blind_operator", "the operator's page does not show what is presented and answered"},
            protocol.display.is_operator_blind);
      });
}

namespace {
using core::NoiseKind;

void read_band(MapReader& reader, core::MaskingNoise& masking) {
  const bool is_band = masking.kind == NoiseKind::band;
  if (!is_band) {
    reader.refuse("band_hz", "is for kind: band only");
    return;
  }
  const Eigen::VectorXd edges_hz = reader.numbers({"band_hz",
                                                   "edges of the band, low and high, where it has "
                                                   "lost 3 dB; beyond it falls by 24 dB an octave"},
                                                  2, {20.0, 20'000.0});
  masking.low_hz = edges_hz[0];
  masking.high_hz = edges_hz[1];
  if (reader.has("band_hz") && masking.low_hz >= masking.high_hz) {
    reader.reject("band_hz", "its edges are not in order (low, then high)");
  }
}
}  // namespace

void read_masking(MapReader& top, Protocol& protocol) {
  top.map(
      {"masking",
       "noise that is played to the participant in every trial, so that the device is not heard; "
       "not in simulations; unset: none"},
      MapReader::Presence::optional, [&](MapReader& reader) {
        core::MaskingNoise& masking = protocol.masking.emplace();
        masking.kind = reader.one_of<NoiseKind>(
            {"kind",
             "the same power in every hertz, in every octave above 10 Hz, or in every hertz "
             "between two edges"},
            {{"white", NoiseKind::white}, {"pink", NoiseKind::pink}, {"band", NoiseKind::band}});
        masking.level_db_fs =
            reader.number({"level_db_fs", "RMS of the samples; 0 is an RMS of full scale"},
                          {-90.0, core::max_noise_level_db_fs});
        read_band(reader, masking);
        masking.ramp_s = reader.number(
            {"ramp_s", "from silence to the full level before a trial, and back after it"},
            {0.01, 5.0}, masking.ramp_s);
        masking.is_required = reader.yes_or_no(
            {"is_required", "without a card that plays there is no session, instead of a warning"},
            masking.is_required);
      });
}
}  // namespace tapstudy::protocols
