#include "runner/session/devices/rigs.hpp"

#include "core/error.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "protocols/reader/read_rig.hpp"
#include "runner/session/devices/device_kind.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::replaced;

namespace {
std::string rig_text() {
  return testing::contents(testing::shipped("rigs/spidar_g6.yaml"));
}
std::string calibration_text() {
  return testing::contents(testing::source("tests/data/spidar_calibration.yaml"));
}
// What is said of a rig and a calibration that lie side by side.
std::string refusal(const std::string& rig, const std::string& calibration) {
  const testing::TempDirectory directory;
  testing::write(directory / "rig.yaml", rig);
  testing::write(directory / "spidar_calibration.yaml", calibration);
  try {
    runner::read_rig(directory / "rig.yaml");
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}
}  // namespace

TEST_CASE("a rig with hardware brings its limits and its device's calibration", "[runner][rig]") {
  const testing::TempDirectory directory;
  testing::write(directory / "rig.yaml", rig_text());
  testing::write(directory / "spidar_calibration.yaml", calibration_text());
  const protocols::Rig rig = runner::read_rig(directory / "rig.yaml");
  CHECK(rig.has_hardware);
  CHECK(rig.section);
  CHECK_THAT(rig.text, Contains(rig_text()) && Contains(calibration_text()));  // for the record
  CHECK(rig.gate.workspace_radius_m == 0.02);
  CHECK(rig.gate.force_rise_s == 0.5);
  CHECK(rig.gate.limits.max_force_n == 5.0);
  CHECK(rig.realtime.fifo_priority == 80);
  for (const double rate_hz : {500.0, 1000.0, 8000.0}) {
    protocols::Protocol protocol;
    protocol.rate_hz = rate_hz;
    CHECK(runner::loop_settings(protocol, rig).max_late_in_a_row == 0.02 * rate_hz);
  }
}

TEST_CASE("tapping points outside the frame of the strings are out of reach, whatever the rig says",
          "[runner][rig][safety]") {
  const testing::TempDirectory directory;
  testing::write(directory / "spidar_calibration.yaml", calibration_text());
  const protocols::Protocol protocol =
      protocols::read_protocol(testing::shipped("paper/discrimination.yaml"));
  const auto refusal_at = [&](const std::string& lateral_scale) -> std::string {
    std::string text = replaced(rig_text(), "workspace_radius_m: 0.02", "workspace_radius_m: 0.5");
    text = replaced(text, "lateral_scale: 0.05", "lateral_scale: " + lateral_scale);
    testing::write(directory / "rig.yaml", text);
    try {
      runner::check_fits(protocol, runner::read_rig(directory / "rig.yaml"));
    } catch (const core::InvalidInput& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK(refusal_at("0.05") == "accepted");  // 1.7 cm from the middle
  CHECK_THAT(refusal_at("1"), Contains("the device cannot hold its grip"));  // 34 cm; the frame: 12
}

TEST_CASE("a rig with hardware must have limits and a calibration", "[runner][rig]") {
  struct Case {
    const char* from;
    const char* to;
    const char* said;
  };
  const auto [from, to, said] = GENERATE(values<Case>({
      {"max_hand_speed_m_s: 1.5\n", "", "max_hand_speed_m_s: is missing"},
      {"workspace_radius_m: 0.02 ", "", "workspace_radius_m: is missing"},
      {"type: X3R", "type: X3F", "'X3F' is not a known type"},
      {"calibration: spidar_calibration.yaml", "calibration: none.yaml",
       "none.yaml: cannot be read"},
      {", calibration: spidar_calibration.yaml", "", "spidar.calibration: is missing"},
      {"device: spidar-g6", "device: spidar-g7", "did you mean 'spidar-g6'?"},
      {"force_rise_s: 0.5", "force_rise_s: 0", "force_rise_s: 0 is not allowed"},
      {"max_force_n: 5", "max_force_n: .nan", "max_force_n: nan is not allowed"},
      {"max_reply_s: 0.003", "max_reply_s: 0.05", "a single missing reply would be a stall"},
  }));
  INFO(from << " → " << to);
  CHECK_THAT(refusal(replaced(rig_text(), from, to), calibration_text()), Contains(said));
}

TEST_CASE("a limit that was counted in ticks is refused by the name of the time that it is now",
          "[runner][rig]") {
  CHECK_THAT(refusal(replaced(rig_text(), "max_late_s: 0.02", "max_late_ticks_in_a_row: 20"),
                     calibration_text()),
             Contains("loop.max_late_ticks_in_a_row: is a key of an earlier version: now it is "
                      "max_late_s, a time in seconds") &&
                 !Contains("is not a known key"));
  const std::string remote = testing::contents(testing::shipped("rigs/remote.yaml"));
  CHECK_THAT(refusal(replaced(remote, "max_reply_s: 0.003", "delay_ticks: 2"), ""),
             Contains("remote.delay_ticks: is a key of an earlier version: now it is "
                      "force_delay_s, a time in seconds"));
  const auto delay_s_of = [&](const std::string& key, double period_s) {
    const protocols::Rig rig =
        runner::parse_rig(replaced(remote, "max_reply_s: 0.003", key), "a test");
    return runner::kind_of(rig).force_delay_s(rig, period_s);
  };
  CHECK(delay_s_of("force_delay_s: 0.002", 2.5e-4) == 0.002);
  CHECK(delay_s_of("max_reply_s: 0.003", 2.5e-4) == 2.5e-4);
}

TEST_CASE("a calibration that is another device's, incomplete or nonsense is refused",
          "[runner][rig]") {
  struct Case {
    const char* from;
    const char* to;
    const char* said;
  };
  const auto [from, to, said] = GENERATE(values<Case>({
      {"type: X3R", "type: X3L", "'X3L' is not a known type of this rig"},
      {"  - {metres_per_count: -1.66555e-5, volts_per_newton: 0.3653, dac_counts_per_volt: 415}\n",
       "", "strings: must be eight"},
      {"metres_per_count: -1.66555e-5", "metres_per_count: 0", "metres_per_count: is zero"},
      {"volts_per_newton: 0.3653", "volts_per_newton: -0.3653", "volts_per_newton: -0.3653 is not"},
      {"max_tension_n: 10", "max_tension_n: 0.2", "is not above min_tension_n"},
      {"max_tension_n: 10", "max_tension_n: 50", "max_tension_n: 50 is not allowed"},
      {"format: tapstudy-calibration/1", "format: tapstudy-rig/1", "is not a known format"},
  }));
  INFO(from << " → " << to);
  CHECK_THAT(refusal(rig_text(), replaced(calibration_text(), from, to)), Contains(said));
}

TEST_CASE("a stored rig's placement is read wherever its document begins, before its calibration",
          "[runner][rig]") {
  const std::string rig = replaced(rig_text(), "lateral_scale: 0.05", "lateral_scale: 0.07");
  for (const char* const before : {"", "---\n", "# ours\n---\n"}) {
    CAPTURE(before);
    const auto placement =
        protocols::placement_in_stored_rig(before + rig + "\n---\n" + calibration_text());
    REQUIRE(placement);
    CHECK(placement->lateral_scale == 0.07);
  }
}

TEST_CASE("the simulated hand needs neither", "[runner][rig]") {
  const protocols::Rig rig = runner::simulated_rig();
  CHECK_FALSE(rig.has_hardware);
  CHECK(rig.gate.force_rise_s == 0.0);
}

TEST_CASE("a tapping point that the device cannot reach is refused with its distance",
          "[runner][rig]") {
  const protocols::Protocol protocol =
      protocols::read_protocol(testing::shipped("paper/discrimination.yaml").string());
  const auto rig_with_radius = [](const std::string& metres) {
    return runner::parse_rig(replaced(testing::contents(testing::shipped("rigs/remote.yaml")),
                                      "workspace_radius_m: 0.05", "workspace_radius_m: " + metres),
                             "rig.yaml");
  };
  // at a tenth of the plate's size P1, P3 and P4 are 0.024 sqrt 2 m from the middle, P5 0.024 m
  CHECK_NOTHROW(runner::check_fits(protocol, rig_with_radius("0.034")));
  CHECK_THROWS_WITH(runner::check_fits(protocol, rig_with_radius("0.03")),
                    Contains("P1 on plate 'two_fixations' is 33.9 mm") && Contains("P4") &&
                        !Contains("P5") && !Contains("P2"));
}

TEST_CASE("a limit in a rig that is not finite, zero, negative or absurd is refused with its range",
          "[runner][rig][safety]") {
  const std::string text = testing::contents(testing::shipped("rigs/remote.yaml"));
  for (const char* const limit : {"max_force_n: 5", "max_force_rate_n_per_s: 5000",
                                  "max_hand_speed_m_s: 2", "workspace_radius_m: 0.05",
                                  "force_rise_s: 0.5", "force_fall_s: 0.1", "max_reply_s: 0.003"}) {
    const std::string key{limit, std::string_view{limit}.find(':')};
    for (const char* const absurd : {".nan", ".inf", "-.inf", "0", "-1", "1e9"}) {
      CAPTURE(key, absurd);
      CHECK_THROWS_WITH(
          runner::parse_rig(replaced(text, limit, key + ": " + absurd), "rig.yaml"),
          Contains(key + ": ") && Contains("is not allowed (") && Contains("and at most "));
    }
  }
}
