// Noise around a trial.
#include <atomic>

#include "runner/session/trial_loop/live_trial_loop.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using device::PcmOutcome;
using namespace std::chrono_literals;

namespace {
struct Card {
  std::atomic<PcmOutcome> outcome{PcmOutcome::played};
  std::atomic<float> latest{0.0F};
};
// A card with a buffer of a second, so that a player need not keep step with it.
class FakeSink final : public device::PcmSink {
 public:
  explicit FakeSink(Card& card) : card_{card} {}
  double rate_hz() const override { return 48'000.0; }
  std::size_t period_frames() const override { return 480; }
  std::size_t buffer_frames() const override { return 48'000; }
  void begin() noexcept override {}
  PcmOutcome write(std::span<const float> period) noexcept override {
    card_.latest = period.back();
    return card_.outcome;
  }
  void end() noexcept override {}
  std::string failure() const override { return "No such device"; }

 private:
  Card& card_;
};
class SteadySource final : public device::SampleSource {
 public:
  void fill(std::span<float> samples) noexcept override { std::ranges::fill(samples, 1.0F); }
};

// A trial of a tenth of a second, with a contact.
class FakeLoop final : public runner::TrialLoop {
 public:
  explicit FakeLoop(std::function<void()> during) : during_{std::move(during)} {}
  runner::TrialResult run(const runner::Rendered& /*rendered*/,
                          const runner::Explore& /*explore*/) override {
    during_();
    std::this_thread::sleep_for(100ms);
    runner::TrialResult result;
    result.trace.events = {{0.05, "contact", 0.0}};
    return result;
  }
  bool is_force_off() const override { return false; }

 private:
  std::function<void()> during_;
};

class Masked {
 public:
  explicit Masked(std::function<void()> during, bool is_required = false)
      : inner_{std::move(during)},
        player_{std::make_unique<FakeSink>(card), std::make_unique<SteadySource>(), 0.1,
                core::RealtimeRequest{0, false, std::nullopt}},
        loop{inner_, player_, {-20.0, is_required}} {}
  std::vector<results::EventRow> events_of_a_trial() { return loop.run({}, {}).trace.events; }
  Card card;

 private:
  FakeLoop inner_;
  device::AudioPlayer player_;

 public:
  runner::MaskedTrialLoop loop;
};

std::vector<std::string> kinds_of(const std::vector<results::EventRow>& events) {
  std::vector<std::string> kinds;
  for (const results::EventRow& event : events) {
    kinds.push_back(event.kind);
  }
  return kinds;
}
using Kinds = std::vector<std::string>;
}  // namespace

TEST_CASE("noise is at its level when the trial begins, silent after it, and stored with it",
          "[runner][audio][threads]") {
  float at_begin = 0.0F;
  Card* card = nullptr;
  Masked masked{[&] { at_begin = card->latest; }};
  card = &masked.card;
  const auto events = masked.events_of_a_trial();
  CHECK(at_begin > 0.9F);
  CHECK(kinds_of(events) == Kinds{"masking", "contact"});
  CHECK(events[0].value == -20.0);
  CHECK_FALSE(masked.loop.is_force_off());  // as the inner loop says
  for (int i = 0; i < 400 && card->latest > 0.0F; ++i) {
    std::this_thread::sleep_for(5ms);
  }
  CHECK(card->latest == 0.0F);
}

TEST_CASE("gaps in the noise are stored with their number, in their trial only",
          "[runner][audio][threads]") {
  Card* card = nullptr;
  Masked masked{[&] { card->outcome = PcmOutcome::underrun; }};
  card = &masked.card;
  const auto events = masked.events_of_a_trial();
  REQUIRE(kinds_of(events) == Kinds{"masking", "contact", "masking_underrun"});
  CHECK(events[2].value > 3.0);
}

TEST_CASE("a card that vanishes in a trial is stored with it; later trials have no noise, and run",
          "[runner][audio][threads]") {
  Card* card = nullptr;
  Masked masked{[&] { card->outcome = PcmOutcome::gone; }};
  card = &masked.card;
  const auto events = masked.events_of_a_trial();
  REQUIRE(kinds_of(events) == Kinds{"masking", "contact", "masking_lost"});
  CHECK(events[2].t_s < 0.1);
  CHECK(kinds_of(masked.events_of_a_trial()) == Kinds{"contact"});
}

TEST_CASE("where noise is required, no trial begins once it is lost", "[runner][audio][threads]") {
  Card* card = nullptr;
  Masked masked{[&] { card->outcome = PcmOutcome::gone; }, true};
  card = &masked.card;
  CHECK(kinds_of(masked.events_of_a_trial()) == Kinds{"masking", "contact", "masking_lost"});
  CHECK_THROWS_AS(masked.events_of_a_trial(), device::DeviceError);
}
