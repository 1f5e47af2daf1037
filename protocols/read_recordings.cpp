// Measured transients, by name.
#include <fmt/format.h>

#include "protocols/read_sections.hpp"
namespace tapstudy::protocols {
namespace {
constexpr Range recorded_place_m{-10.0, 10.0};
constexpr Range force_n{-1e4, 1e4};  // devices limit what they push
constexpr std::size_t max_samples = 100'000;

core::RecordedTap read_tap(MapReader& reader) {
  core::RecordedTap tap;
  tap.at_m = reader.numbers("at_m", 2, recorded_place_m);
  tap.speed_m_s = reader.number("speed_m_s", Range::positive(100.0));
  tap.force_n = reader.number_list("force_n", force_n);
  if (tap.force_n.size() > max_samples) {
    reader.reject("force_n",
                  fmt::format("has {} samples (at most {})", tap.force_n.size(), max_samples));
  }
  return tap;
}
}  // namespace

void read_recordings(MapReader& top, Protocol& protocol) {
  top.each(
      "recordings", MapReader::Presence::optional, [&](const std::string& name, MapReader& reader) {
        core::RecordedTaps recorded;
        recorded.rate_hz = reader.number("rate_hz", {100.0, 200'000.0});
        reader.list("taps", MapReader::Presence::at_least_one,
                    [&](MapReader& tap) { recorded.taps.push_back(read_tap(tap)); });
        protocol.recordings[name] = std::make_shared<const core::RecordedTaps>(std::move(recorded));
      });
}
}  // namespace tapstudy::protocols
