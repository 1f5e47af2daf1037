// The actuator's samples: when they are heard, where they end, and on which channel.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>
#include <thread>

#include "core/techniques/actuated.hpp"
#include "core/techniques/technique.hpp"
#include "device/audio/actuator_player.hpp"
#include "device/audio/actuator_source.hpp"
#include "device/audio/alsa_sink.hpp"
#include "device/audio/sample_clock.hpp"
#include "device/device.hpp"
#include "support/alsa_file.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
#include "support/plates.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
constexpr double card_hz = 48'000.0;
constexpr std::size_t period_frames = 48;
constexpr std::int64_t tick_ns = 1'000'000;
constexpr double delay_s = 0.004;
constexpr double full_scale_n = 10.0;

const core::VibratingPlate& plate() {
  static const core::VibratingPlate shared = testing::uniform_plate(
      Eigen::ArrayXd::Constant(1, 700.0), 0.0, Eigen::ArrayXd::Constant(1, 1.0));
  return shared;
}

core::ActuatorVoice voice() {
  core::RenderSettings settings;
  settings.crossover = core::Crossover{200.0, 300.0};
  return core::make_voice(*core::find_technique("fem"), settings, &plate(),
                          core::ActuatorResponse::flat(), 1.0 / card_hz);
}

core::ActuatorTick touching(std::int64_t at_ns, bool impact, std::uint8_t alternative = 0) {
  core::Contact contact;
  contact.touching = true;
  contact.impact = impact;
  contact.impact_speed_m_s = 0.3;
  core::ActuatorTick tick = core::actuator_tick(contact);
  tick.at_ns = at_ns;
  tick.passed_share = 1.0;
  tick.alternative = alternative;
  return tick;
}

device::ActuatorSource source() {
  return device::ActuatorSource{{card_hz, full_scale_n, {}, 1e-9 * tick_ns, delay_s}};
}

// A loop and a card in step: in each millisecond a tick, then a period of samples, the first of
// which is heard two milliseconds later: a buffer of three periods has room for it.
class InStep {
 public:
  InStep() { source_.use(voices_); }
  void tick(bool impact = false, std::uint8_t alternative = 0) {
    source_.ticks().try_push(touching(now_ns_, impact, alternative));
  }
  void let_pass(int periods, bool with_ticks) {
    for (int i = 0; i < periods; ++i) {
      if (with_ticks) {
        tick(now_ns_ == impact_ns_, alternative_);
      }
      std::vector<float> period(period_frames);
      source_.fill(period, now_ns_ + buffered_ns, 1e9 / card_hz, now_ns_);
      samples_.insert(samples_.end(), period.begin(), period.end());
      now_ns_ += tick_ns;
    }
  }
  void feel(std::uint8_t alternative) { alternative_ = alternative; }
  void end() { source_.use({}); }
  void end_in_order() {
    core::ActuatorTick last = core::actuator_tick({});
    last.at_ns = now_ns_;
    last.is_last = true;
    source_.ticks().try_push(last);
  }
  bool is_done() { return source_.is_done(); }
  static constexpr std::int64_t buffered_ns = 2'000'000;
  static constexpr std::int64_t impact_ns_ = 10 * tick_ns;
  std::int64_t now_ns_{0};
  std::vector<float> samples_;

 private:
  std::vector<core::ActuatorVoice> voices_{voice(), voice()};
  device::ActuatorSource source_{source()};
  std::uint8_t alternative_{0};
};

double largest_step(const std::vector<float>& samples, std::size_t from) {
  double largest = 0.0;
  for (std::size_t i = std::max<std::size_t>(from, 1); i < samples.size(); ++i) {
    largest = std::max(largest, std::abs(static_cast<double>(samples[i] - samples[i - 1])));
  }
  return largest;
}
}  // namespace

TEST_CASE("an impact is heard a fixed delay after its tick, to the sample", "[device][actuator]") {
  const double rate_error = GENERATE(0.0, 200e-6);
  const double after_s = GENERATE(0.004, 0.1);  // a card that buffers for long
  const double frame_ns = 1e9 / (card_hz * (1.0 + rate_error));
  device::ActuatorSource source{{card_hz, full_scale_n, {}, 1e-9 * tick_ns, after_s}};
  std::vector<core::ActuatorVoice> voices{voice()};
  source.use(voices);
  const std::int64_t impact_at_ns = 50'300'000;  // between two samples
  std::vector<float> samples;
  std::int64_t next_tick_ns = 300'000;
  const double first_heard_ns = 3e6;
  while (samples.size() < 200 * period_frames) {
    const double heard_ns = first_heard_ns + frame_ns * static_cast<double>(samples.size());
    const auto now_ns = static_cast<std::int64_t>(heard_ns) - 3'000'000;
    for (; next_tick_ns <= now_ns; next_tick_ns += tick_ns) {
      source.ticks().try_push(touching(next_tick_ns, next_tick_ns == impact_at_ns));
    }
    std::vector<float> period(period_frames);
    source.fill(period, std::llround(heard_ns), frame_ns, now_ns);
    samples.insert(samples.end(), period.begin(), period.end());
  }
  const auto first = std::ranges::find_if(samples, [](float sample) { return sample != 0.0F; });
  REQUIRE(first != samples.end());
  const double heard_ns = first_heard_ns + frame_ns * static_cast<double>(first - samples.begin());
  const double late_ns = heard_ns - 1e9 * after_s - static_cast<double>(impact_at_ns);
  CHECK(late_ns >= 0.0);
  CHECK(late_ns <= frame_ns);
}

TEST_CASE("where the haptic loop stalls the actuator is silent within five milliseconds",
          "[device][actuator]") {
  InStep both;
  both.let_pass(40, true);
  CHECK(both.samples_.back() != 0.0F);
  const std::int64_t stalled_ns = both.now_ns_;  // the first tick that does not come
  both.let_pass(20, false);
  const auto last = std::find_if(both.samples_.rbegin(), both.samples_.rend(),
                                 [](float sample) { return sample != 0.0F; });
  const auto heard_ns = static_cast<double>(InStep::buffered_ns) +
                        static_cast<double>(both.samples_.rend() - last) * 1e9 / card_hz;
  CHECK(heard_ns - static_cast<double>(stalled_ns) <= 5e6 + 1e9 / card_hz);
  both.let_pass(5, true);  // it goes on
  CHECK(both.samples_.back() != 0.0F);
}

TEST_CASE(
    "what a loop that ends in order told before its end is heard as if it went on, then silence "
    "within five milliseconds of the first tick that does not come",
    "[device][actuator]") {
  const int ticks = GENERATE(11, 12, 13, 14, 15, 40);  // the impact is the tenth from zero
  InStep goes_on;
  goes_on.let_pass(ticks + 20, true);
  InStep ends;
  ends.let_pass(ticks, true);
  const auto heard_by_ns = [](std::int64_t ns) {
    return static_cast<std::size_t>((ns - InStep::buffered_ns) / tick_ns) * period_frames;
  };
  const std::size_t end = heard_by_ns(ends.now_ns_ + static_cast<std::int64_t>(1e9 * delay_s));
  ends.end_in_order();
  CHECK_FALSE(ends.is_done());
  ends.let_pass(20, false);
  CHECK(ends.is_done());
  CAPTURE(ticks);
  CHECK(std::equal(ends.samples_.begin(), ends.samples_.begin() + static_cast<long>(end),
                   goes_on.samples_.begin()));
  CHECK(std::ranges::any_of(std::span{ends.samples_}.first(end),
                            [](float sample) { return sample != 0.0F; }));
  CHECK(std::ranges::all_of(std::span{ends.samples_}.subspan(end + period_frames),
                            [](float sample) { return sample == 0.0F; }));
}

TEST_CASE("a waveform that is cut off by another one, or by nothing, makes no step",
          "[device][actuator]") {
  InStep both;
  both.let_pass(40, true);
  const auto largest = static_cast<double>(std::ranges::max(both.samples_));
  const double natural = largest_step(both.samples_, 20 * period_frames);
  const std::size_t from = both.samples_.size();
  SECTION("another alternative") {
    both.feel(1);
  }
  SECTION("the trial ends") {
    both.end();
  }
  both.let_pass(20, true);
  CHECK(both.samples_.back() == 0.0F);
  CHECK(largest_step(both.samples_, from) <= natural + 1.01 * largest / period_frames);
}

TEST_CASE("no sample is above the actuator's limit or its full scale", "[device][actuator]") {
  const double peak_n = GENERATE(0.02, 1000.0);
  device::ActuatorSource source{{card_hz, 0.04, {peak_n}, 1e-9 * tick_ns, 0.0}};
  std::vector<core::ActuatorVoice> voices{voice()};
  source.use(voices);
  source.ticks().try_push(touching(0, true));
  std::vector<float> samples(period_frames);
  source.fill(samples, 0, 1e9 / card_hz, 0);
  CHECK(std::ranges::max(samples) <= static_cast<float>(std::min(peak_n, 0.04) / 0.04));
  CHECK(-std::ranges::min(samples) == Approx(std::min(peak_n, 0.04) / 0.04));
  CHECK(source.limited() > 0);
}

TEST_CASE("rendering the actuator's samples allocates nothing", "[device][actuator]") {
  device::ActuatorSource source = ::source();
  std::vector<core::ActuatorVoice> voices{voice(), voice()};
  source.use(voices);
  std::vector<float> samples(period_frames);
  const testing::AllocationCount allocations;
  for (std::int64_t i = 0; i < 200; ++i) {
    source.ticks().try_push(touching(i * tick_ns, i % 20 == 0, i > 100 ? 1 : 0));
    source.fill(samples, (i + 3) * tick_ns, 1e9 / card_hz, i * tick_ns);
  }
  source.use({});
  CHECK(allocations.count() == 0);
}

TEST_CASE("the rate of a card is found in times that jitter, and its periods' begins smoothed",
          "[device][actuator]") {
  const double rate_error = GENERATE(-80e-6, 0.0, 80e-6);
  const double true_ns = 1e6 / (1.0 + rate_error);
  device::SampleClock clock{card_hz, period_frames};
  std::mt19937 random{5};
  std::normal_distribution<double> jitter_ns{0.0, 1e5};
  double worst_ns = 0.0;
  for (int i = 0; i < 40'000; ++i) {
    clock.measured(i * true_ns + jitter_ns(random));
    if (i > 20'000) {
      worst_ns = std::max(worst_ns, std::abs(clock.first_frame_ns() - i * true_ns));
    }
  }
  CHECK(worst_ns < 2e4);
  CHECK(clock.rate_error() == Approx(rate_error).margin(1e-5));
  CHECK(clock.jitter_s().value() == Approx(1e-4).epsilon(0.05));
  CHECK(clock.frame_ns() == Approx(1e9 / card_hz).epsilon(2e-4));
}

TEST_CASE("a card that tells its time in whole periods has a clock all the same",
          "[device][actuator]") {
  device::SampleClock clock{card_hz, period_frames};
  double worst_ns = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    clock.measured(i * 1e6 + (i % 3 == 0 ? 1e6 : 0.0));  // late by a third of a period on average
    if (i > 10'000) {
      worst_ns = std::max(worst_ns, std::abs(clock.first_frame_ns() - (i + 1.0 / 3.0) * 1e6));
    }
  }
  CHECK(worst_ns < 2e4);
  CHECK(clock.jitter_s().value() == Approx(1e-3 * std::sqrt(2.0) / 3.0).epsilon(0.05));
}

TEST_CASE("a gap that a card reports begins its time anew", "[device][actuator]") {
  device::SampleClock clock{card_hz, period_frames};
  for (int i = 0; i < 100; ++i) {
    clock.measured(i * 1e6);
  }
  CHECK_FALSE(clock.jitter_s());  // its first second is not counted
  clock.restart();
  clock.measured(100.7e6);
  CHECK(clock.first_frame_ns() == 100.7e6);
}

TEST_CASE("a gap in a card's time is followed at once", "[device][actuator]") {
  device::SampleClock clock{card_hz, period_frames};
  for (int i = 0; i < 100; ++i) {
    clock.measured(i * 1e6);
  }
  clock.measured(5e9);
  CHECK(clock.first_frame_ns() == 5e9);
  clock.measured(5e9 + 1e6);
  CHECK(clock.first_frame_ns() == 5e9 + 1e6);
}

TEST_CASE("one channel of a card plays, the others are silent", "[device][actuator][audio]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "played.raw";
  {
    const auto card = device::open_alsa({.card = testing::file_card(file), .only_channel = 1});
    const std::vector<float> period(card->period_frames(), 0.5F);
    card->begin();
    REQUIRE(card->write(period) == device::PcmOutcome::played);
    card->end();
  }
  CHECK(std::ranges::max(testing::channel_of(file, 0)) == 0.0);
  CHECK(std::ranges::min(testing::channel_of(file, 1)) == Approx(0.5));
  CHECK_THROWS_WITH(
      device::open_alsa({.card = testing::file_card(file), .channels = 2, .only_channel = 2}),
      Contains("2 channels, none of them number 3"));
}

namespace {
// Plays, and from the script's begin on has one of its outcomes a period, the latest on and on.
class FallibleCard final : public device::PcmSink {
 public:
  explicit FallibleCard(std::vector<device::PcmOutcome> outcomes)
      : outcomes_{std::move(outcomes)} {}
  double rate_hz() const override { return ::card_hz; }
  std::size_t period_frames() const override { return ::period_frames; }
  std::size_t buffer_frames() const override { return 3 * ::period_frames; }
  void begin() noexcept override {}
  device::PcmOutcome write(std::span<const float> period) noexcept override {
    has_sounded = has_sounded || std::ranges::any_of(period, [](float x) { return x != 0.0F; });
    return has_begun ? outcomes_.at(std::min(periods.fetch_add(1), outcomes_.size() - 1))
                     : device::PcmOutcome::played;
  }
  void end() noexcept override {}
  std::string failure() const override { return "it was pulled out"; }
  std::atomic<bool> has_begun{false};
  std::atomic<std::size_t> periods{0};  // since then
  std::atomic<bool> has_sounded{false};

 private:
  std::vector<device::PcmOutcome> outcomes_;
};

// A player of a card that behaves so.
struct PlayedVoices {
  PlayedVoices(std::vector<device::PcmOutcome> outcomes, int max_gaps) {
    auto owned = std::make_unique<FallibleCard>(std::move(outcomes));
    sink = owned.get();
    player.emplace(std::move(owned),
                   device::ActuatorPlayer::Settings{
                       full_scale_n, {}, 1e-9 * tick_ns, max_gaps, {0, false, std::nullopt}});
    player->begin(voices);
    sink->has_begun = true;
  }
  void wait_for_period(std::size_t number) const {
    while (sink->periods < number) {
      std::this_thread::yield();
    }
  }
  std::vector<core::ActuatorVoice> voices{voice()};
  FallibleCard* sink{};
  mutable std::optional<device::ActuatorPlayer> player;
};
}  // namespace

TEST_CASE("an actuator's card that is pulled out is lost for good, and says why",
          "[device][actuator][threads]") {
  using enum device::PcmOutcome;
  PlayedVoices card{{played, gone}, 3};
  CHECK(card.player->delay_s() == Approx(0.004));
  while (!card.player->loss()) {
    std::this_thread::yield();
  }
  CHECK(card.player->loss()->why == "it was pulled out");
  CHECK(card.player->link().fault->load() == core::TickFault::actuator_lost);
  card.player->begin(card.voices);
  CHECK(card.player->link().fault->load() == core::TickFault::actuator_lost);
  CHECK(card.player->end().loss);
}

TEST_CASE("a card with more gaps in a trial than are tolerated is a fault of that trial",
          "[device][actuator][threads]") {
  using enum device::PcmOutcome;
  const int max_gaps = GENERATE(0, 3, 4);
  PlayedVoices card{{underrun, lost, underrun, underrun, played}, max_gaps};
  card.wait_for_period(8);
  const core::TickFault fault = card.player->link().fault->load();
  CHECK(fault == (max_gaps < 4 ? core::TickFault::actuator_gaps : core::TickFault::none));
  CHECK(card.player->end().underruns == 4);
  card.player->begin(card.voices);  // the next trial
  CHECK(card.player->link().fault->load() == core::TickFault::none);
}

TEST_CASE("a trial's end waits until its last impact has been given to the card",
          "[device][actuator][threads]") {
  PlayedVoices card{{device::PcmOutcome::played}, 3};
  const std::int64_t now_ns =
      std::chrono::nanoseconds{std::chrono::steady_clock::now().time_since_epoch()}.count();
  core::SpscRing<core::ActuatorTick>& ticks = *card.player->link().ticks;
  ticks.try_push(touching(now_ns, true));
  core::ActuatorTick last = core::actuator_tick({});
  last.at_ns = now_ns + tick_ns;
  last.is_last = true;
  ticks.try_push(last);
  card.player->end();
  CHECK(card.sink->has_sounded);
}
