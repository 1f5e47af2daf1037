// Noise for the participant's ears.
#include "protocols/read_sections.hpp"
namespace tapstudy::protocols {
namespace {
using core::NoiseKind;

void read_band(MapReader& reader, core::MaskingNoise& masking) {
  const bool is_band = masking.kind == NoiseKind::band;
  if (!is_band && !reader.has("band_hz")) {
    return;
  }
  const Eigen::VectorXd edges_hz = reader.numbers("band_hz", 2, {20.0, 20'000.0});
  masking.low_hz = edges_hz[0];
  masking.high_hz = edges_hz[1];
  if (!is_band) {
    reader.reject("band_hz", "is for kind: band only");
  } else if (reader.has("band_hz") && masking.low_hz >= masking.high_hz) {
    reader.reject("band_hz", "its edges are not in order (low, then high)");
  }
}
}  // namespace

void read_masking(MapReader& top, Protocol& protocol) {
  top.map("masking", MapReader::Presence::optional, [&](MapReader& reader) {
    core::MaskingNoise& masking = protocol.masking.emplace();
    masking.kind = reader.one_of<NoiseKind>(
        "kind",
        {{"white", NoiseKind::white}, {"pink", NoiseKind::pink}, {"band", NoiseKind::band}});
    masking.level_db_fs = reader.number("level_db_fs", {-90.0, core::max_noise_level_db_fs});
    read_band(reader, masking);
    masking.ramp_s = reader.number("ramp_s", {0.01, 5.0}, masking.ramp_s);
    masking.is_required = reader.yes_or_no("is_required", masking.is_required);
  });
}
}  // namespace tapstudy::protocols
