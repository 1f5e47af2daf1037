#include <algorithm>
#include <cstring>
#include <limits>

#include "core/random/rng.hpp"
#include "results/store_error.hpp"
#include "results/traces/trace_codec.hpp"
#include "results/traces/trace_collector.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using core::TraceSample;

namespace {
std::vector<TraceSample> wild_samples(std::size_t count) {
  core::Rng rng{11};
  std::vector<TraceSample> samples;
  for (std::size_t i = 0; i < count; ++i) {
    TraceSample s{};
    s.t_ns = static_cast<std::int64_t>(i) * 1'000'003 - 5;
    s.position_m = {rng.normal(), -0.0, 1e-320};
    s.velocity_m_s = {rng.normal() * 1e300, 0.0, rng.uniform()};
    s.penetration_m = rng.uniform();
    s.penalty_n = std::numeric_limits<double>::infinity();
    s.vibration_n = std::numeric_limits<double>::quiet_NaN();
    s.sinusoid_n = -rng.uniform();
    s.force_n = {0.0, rng.normal(), 0.0};
    s.achieved_n = {rng.normal(), 1.0, -0.0};
    s.pose_residual_m = rng.uniform();
    s.closure_margin = -rng.uniform();
    s.motor_voltage_v = rng.uniform();
    s.missed_replies = static_cast<std::uint8_t>(rng.below(4));
    s.late = rng.below(2) == 1;
    s.alternative = static_cast<std::uint8_t>(rng.below(256));
    s.touching = rng.below(2) == 1;
    s.impact = rng.below(2) == 1;
    s.saturated = rng.below(2) == 1;
    s.fault = core::TickFault::device_gone;
    samples.push_back(s);
  }
  return samples;
}
bool same_bits(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}
}  // namespace

TEST_CASE("a trace comes back to the last bit, NaN and denormals included", "[results][codec]") {
  const std::size_t count = GENERATE(0U, 1U, 7U, 8U, 9U, 4096U, 5003U);
  const auto samples = wild_samples(count);
  const auto decoded = results::decode_trace(results::encode_trace(samples), count, "a trace");
  REQUIRE(decoded.size() == count);
  for (std::size_t i = 0; i < count; ++i) {
    CHECK(decoded[i].t_ns == samples[i].t_ns);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      CHECK(same_bits(decoded[i].position_m.at(axis), samples[i].position_m.at(axis)));
      CHECK(same_bits(decoded[i].velocity_m_s.at(axis), samples[i].velocity_m_s.at(axis)));
      CHECK(same_bits(decoded[i].force_n.at(axis), samples[i].force_n.at(axis)));
      CHECK(same_bits(decoded[i].achieved_n.at(axis), samples[i].achieved_n.at(axis)));
    }
    CHECK(same_bits(decoded[i].penetration_m, samples[i].penetration_m));
    CHECK(same_bits(decoded[i].penalty_n, samples[i].penalty_n));
    CHECK(same_bits(decoded[i].vibration_n, samples[i].vibration_n));
    CHECK(same_bits(decoded[i].sinusoid_n, samples[i].sinusoid_n));
    CHECK(same_bits(decoded[i].pose_residual_m, samples[i].pose_residual_m));
    CHECK(same_bits(decoded[i].closure_margin, samples[i].closure_margin));
    CHECK(decoded[i].alternative == samples[i].alternative);
    CHECK(decoded[i].touching == samples[i].touching);
    CHECK(decoded[i].impact == samples[i].impact);
    CHECK(decoded[i].saturated == samples[i].saturated);
    CHECK(same_bits(decoded[i].motor_voltage_v, samples[i].motor_voltage_v));
    CHECK(decoded[i].missed_replies == samples[i].missed_replies);
    CHECK(decoded[i].late == samples[i].late);
    CHECK(decoded[i].fault == samples[i].fault);
  }
}

TEST_CASE("bytes that are no trace are refused", "[results][codec]") {
  auto bytes = results::encode_trace(wild_samples(100));
  CHECK_THROWS_AS(results::decode_trace(bytes, 99, "a trace"), results::StoreError);
  CHECK_THROWS_AS(results::decode_trace(bytes, 101, "a trace"), results::StoreError);
  CHECK_THROWS_AS(results::decode_trace(bytes, 1'000'000'000'000, "a trace"), results::StoreError);
  bytes.resize(bytes.size() / 2);
  CHECK_THROWS_AS(results::decode_trace(bytes, 100, "a trace"), results::StoreError);
}

TEST_CASE("the collector keeps every sample and notes what happened", "[results][collector]") {
  core::SpscRing<TraceSample> ring{1U << 14U};
  results::TraceCollector collector{ring};
  for (int tick = 0; tick < 10'000; ++tick) {
    TraceSample sample{};
    sample.t_ns = tick * 1'000'000LL;
    sample.touching = tick >= 100 && tick < 200;
    sample.impact = tick == 100;
    sample.velocity_m_s[1] = -0.25;
    sample.alternative = tick < 5000 ? 0 : 2;
    ring.try_push(sample);
  }
  const auto collected = collector.finish();
  CHECK(collected.ticks == 10'000);
  std::int64_t kept = 0;
  for (const results::TraceChunk& chunk : collected.chunks) {
    CHECK(chunk.first_tick == kept);
    kept += chunk.ticks;
  }
  CHECK(kept == 10'000);
  std::vector<std::tuple<double, std::string, double>> events;
  for (const results::EventRow& event : collected.events) {
    events.emplace_back(event.t_s, event.kind, event.value);
  }
  using Event = std::tuple<double, std::string, double>;
  CHECK(events == std::vector<Event>{{0.0, "switch", 0.0},
                                     {0.1, "contact", 0.0},
                                     {0.1, "impact", 0.25},
                                     {0.2, "release", 0.0},
                                     {5.0, "switch", 2.0}});
}

TEST_CASE("a tick with a fault tells no release of a finger that was in contact",
          "[results][collector]") {
  core::SpscRing<TraceSample> ring{16};
  results::TraceCollector collector{ring};
  for (int tick = 0; tick < 5; ++tick) {
    TraceSample sample{};
    sample.t_ns = tick * 1'000'000LL;
    sample.touching = tick < 4;
    sample.fault = tick < 4 ? core::TickFault::none : core::TickFault::no_reply;
    ring.try_push(sample);
  }
  const auto collected = collector.finish();
  std::vector<std::string> kinds;
  for (const results::EventRow& event : collected.events) {
    kinds.push_back(event.kind);
  }
  CHECK(kinds == std::vector<std::string>{"switch", "contact"});
  CHECK(collected.duration_s == Approx(0.004));
}

TEST_CASE("a single bit that flips in a stored trace is seen", "[results][codec]") {
  const auto bytes = results::encode_trace(wild_samples(600));
  core::Rng rng{5};
  for (int i = 0; i < 500; ++i) {
    auto damaged = bytes;
    damaged[rng.below(static_cast<std::uint32_t>(bytes.size()))] ^=
        static_cast<std::byte>(1U << rng.below(8));
    CHECK_THROWS_AS(results::decode_trace(damaged, 600, "a trace"), results::StoreError);
  }
}

TEST_CASE("an impact up to 5 ms after a late tick is noted as one, and no other is",
          "[results][trace]") {
  const int ticks_after = GENERATE(0, 1, 5, 6, 50);
  core::SpscRing<core::TraceSample> ring{256};
  for (int i = 0; i < 100; ++i) {
    core::TraceSample sample{};
    sample.t_ns = 1'000'000 * i;
    sample.late = i == 40;
    sample.impact = i == 40 + ticks_after || i == 30;
    sample.velocity_m_s = {0.0, -0.3, 0.0};
    REQUIRE(ring.try_push(sample));
  }
  const auto events = results::TraceCollector{ring}.finish().events;
  CHECK(std::ranges::count(events, "impact", &results::EventRow::kind) == 2);
  const auto late = std::ranges::find(events, "late_impact", &results::EventRow::kind);
  REQUIRE((late != events.end()) == (ticks_after <= 5));
  if (ticks_after <= 5) {
    CHECK(late->value == Approx(0.3));
    CHECK(late->t_s == Approx(0.04 + 0.001 * ticks_after));
  }
}

namespace {
results::ActuatorTrace wild_periods(std::size_t count) {
  core::Rng rng{3};
  results::ActuatorTrace trace;
  for (std::size_t i = 0; i < count; ++i) {
    const auto samples = static_cast<std::uint16_t>(rng.below(200));
    trace.periods.push_back({static_cast<std::int64_t>(i) * 1'000'017 - 3'000'000,
                             1e9 / 48'000.0 * (1.0 + 1e-6 * rng.normal()),
                             static_cast<std::int64_t>(rng.below(1U << 30U)), rng.below(1U << 31U),
                             samples, rng.below(2) == 1, rng.below(2) == 1});
    for (int j = 0; j < samples; ++j) {
      trace.samples.push_back(static_cast<float>(rng.normal()));
    }
  }
  return trace;
}
bool same(const core::ActuatorPeriod& a, const core::ActuatorPeriod& b) {
  return a.heard_at_ns == b.heard_at_ns && same_bits(a.frame_ns, b.frame_ns) &&
         a.filled_at_ns == b.filled_at_ns && a.ticks == b.ticks && a.samples == b.samples &&
         a.follows_gap == b.follows_gap && a.is_heard == b.is_heard;
}
}  // namespace

TEST_CASE("what an actuator was given comes back to the last bit", "[results][codec][actuator]") {
  const std::size_t count = GENERATE(0U, 1U, 9U, 700U);
  const results::ActuatorTrace trace = wild_periods(count);
  const auto bytes = results::encode_actuator(trace);
  const auto decoded = results::decode_actuator(bytes, count, trace.samples.size(), "it");
  CHECK(std::ranges::equal(decoded.periods, trace.periods, same));
  CHECK(decoded.samples == trace.samples);
  CHECK_THROWS_AS(results::decode_actuator(bytes, count + 1, trace.samples.size(), "it"),
                  results::StoreError);
  if (trace.samples.size() > 8) {  // bytes enough for a period more, of samples too few
    CHECK_THROWS_WITH(results::decode_actuator(bytes, count + 1, trace.samples.size() - 8, "it"),
                      Contains("its periods have"));
  }
}

TEST_CASE("an actuator's periods are kept from the first on, at times from the first tick",
          "[results][collector][actuator]") {
  const bool has_ticks = GENERATE(true, false);
  core::ActuatorTape tape{8, 100};
  core::SpscRing<TraceSample> ring{16};
  results::TraceCollector collector{ring};
  std::optional<std::int64_t> began_at_ns;
  collector.add(tape, [&] { return began_at_ns; });
  const std::vector<float> samples{0.5F, -0.5F};
  tape.push({.heard_at_ns = 5'000'000}, samples);
  collector.drain();  // the loop has not begun
  began_at_ns = 7'000'000;
  tape.push({.heard_at_ns = 6'000'000, .ticks = 1, .is_heard = true}, samples);
  if (has_ticks) {
    ring.try_push(TraceSample{});
  }
  const auto collected = collector.finish();
  REQUIRE(collected.actuator.size() == (has_ticks ? 1 : 0));
  if (has_ticks) {
    const results::ActuatorChunk& chunk = collected.actuator.front();
    CHECK(chunk.periods == 2);
    const auto trace = results::decode_actuator(chunk.bytes, 2, 4, "it");
    CHECK(trace.periods[0].heard_at_ns == -2'000'000);
    CHECK(trace.periods[1].heard_at_ns == -1'000'000);
    CHECK(trace.samples == std::vector<float>{0.5F, -0.5F, 0.5F, -0.5F});
  }
}

TEST_CASE("a tape that was full drops what comes after, and counts it", "[core][actuator]") {
  core::ActuatorTape tape{4, 8};
  const std::vector<float> samples(3, 1.0F);
  for (int i = 0; i < 5; ++i) {
    tape.push({}, samples);  // the third does not fit
  }
  CHECK(tape.dropped() == 3);
  core::ActuatorPeriod period;
  std::vector<float> popped;
  while (tape.pop(period, popped)) {
  }
  CHECK(popped.size() == 6);
  tape.push({}, samples);  // there is room, but a gap before it
  CHECK_FALSE(tape.pop(period, popped));
  tape.begin();
  tape.push({}, samples);
  CHECK(tape.pop(period, popped));
  CHECK(tape.dropped() == 0);
}
