// What ALSA was given to play, measured.
#include <atomic>
#include <map>
#include <unsupported/Eigen/FFT>

#include "device/audio/alsa_sink.hpp"
#include "device/audio/audio_player.hpp"
#include "device/audio/noise.hpp"
#include "support/alsa_file.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using core::NoiseKind;

namespace {
constexpr double rate_hz = 48'000.0;

core::MaskingNoise noise_of(NoiseKind kind, double level_db_fs) {
  return {.kind = kind, .level_db_fs = level_db_fs, .low_hz = 200.0, .high_hz = 2000.0};
}

std::vector<double> played(const core::MaskingNoise& settings, double seconds) {
  const testing::TempDirectory directory;
  const std::string file = directory / "played.raw";
  {
    const auto card = device::open_alsa({.card = testing::file_card(file)});
    device::Noise noise{settings, card->rate_hz(), 7};
    std::vector<float> period(card->period_frames());
    card->begin();
    for (double t_s = 0.0; t_s < seconds;
         t_s += static_cast<double>(period.size()) / card->rate_hz()) {
      noise.fill(period);
      REQUIRE(card->write(period) == device::PcmOutcome::played);
    }
    card->end();
  }
  const auto left = testing::channel_of(file, 0);
  CHECK(left == testing::channel_of(file, 1));
  CHECK(static_cast<double>(left.size()) >= seconds * rate_hz);
  return left;
}

// Power per hertz by Welch's method with a Hann window: [dB], averaged from low to high.
class Spectrum {
 public:
  explicit Spectrum(const std::vector<double>& samples) : power_(half) {
    Eigen::FFT<double> fft;
    for (std::size_t begin = 0; begin + size <= samples.size(); begin += half) {
      std::vector<double> windowed(size);
      for (std::size_t i = 0; i < size; ++i) {
        windowed[i] =
            samples[begin + i] * 0.5 * (1.0 - std::cos(2.0 * M_PI * static_cast<double>(i) / size));
      }
      std::vector<std::complex<double>> lines;
      fft.fwd(lines, windowed);
      for (std::size_t i = 0; i < half; ++i) {
        power_[i] += std::norm(lines[i]);
      }
    }
  }
  double density_db(double low_hz, double high_hz) const {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < half; ++i) {
      const double hz = static_cast<double>(i) * rate_hz / size;
      if (hz >= low_hz && hz < high_hz) {
        sum += power_[i];
        count += 1.0;
      }
    }
    return 10.0 * std::log10(sum / count);
  }
  double near_db(double hz) const { return density_db(hz / 1.03, hz * 1.03); }

 private:
  static constexpr std::size_t size = 16'384;
  static constexpr std::size_t half = size / 2;
  std::vector<double> power_;
};
constexpr double seconds = 40.0;
}  // namespace

TEST_CASE("noise is played at the level that was asked for", "[device][audio]") {
  const auto kind = GENERATE(NoiseKind::white, NoiseKind::pink, NoiseKind::band);
  const double level_db_fs = GENERATE(-15.0, -40.0);
  CHECK(testing::rms_db(played(noise_of(kind, level_db_fs), seconds)) ==
        Approx(level_db_fs).margin(0.3));
}

TEST_CASE("white noise has the same power in every hertz", "[device][audio]") {
  const Spectrum spectrum{played(noise_of(NoiseKind::white, -20.0), seconds)};
  const double whole_db = spectrum.density_db(20.0, 23'900.0);
  for (double hz = 40.0; hz < 20'000.0; hz *= 2.0) {
    INFO(hz << " Hz");
    CHECK(spectrum.density_db(hz / std::sqrt(2.0), hz * std::sqrt(2.0)) ==
          Approx(whole_db).margin(0.5));
  }
}

TEST_CASE("pink noise loses 3 dB per octave", "[device][audio]") {
  const Spectrum spectrum{played(noise_of(NoiseKind::pink, -20.0), seconds)};
  const double at_1_khz_db = spectrum.near_db(1000.0);
  for (const double hz : {62.5, 125.0, 250.0, 500.0, 2000.0, 4000.0, 8000.0}) {
    INFO(hz << " Hz");
    CHECK(spectrum.near_db(hz) - at_1_khz_db ==
          Approx(-10.0 * std::log10(hz / 1000.0)).margin(0.7));
  }
}

TEST_CASE("band noise has lost 3 dB at its edges, and 24 dB an octave beyond", "[device][audio]") {
  const Spectrum spectrum{played(noise_of(NoiseKind::band, -20.0), seconds)};
  const double inside_db = spectrum.density_db(400.0, 1000.0);
  const std::map<double, double> expected_db{
      {100.0, -24.1}, {200.0, -3.0}, {2000.0, -3.0}, {600.0, 0.0}, {50.0, -48.2}};
  for (const auto& [hz, db] : expected_db) {
    INFO(hz << " Hz");
    CHECK(spectrum.near_db(hz) - inside_db == Approx(db).margin(0.8));
  }
  CHECK(spectrum.near_db(4000.0) - inside_db < -23.0);
  CHECK(spectrum.near_db(12'000.0) - inside_db < -60.0);
}

TEST_CASE("the same seed gives the same noise, another one another", "[device][audio]") {
  const auto settings = noise_of(NoiseKind::pink, -20.0);
  const auto first_of = [&](std::uint64_t seed) {
    std::vector<float> samples(100);
    device::Noise{settings, rate_hz, seed}.fill(samples);
    return samples;
  };
  CHECK(first_of(1) == first_of(1));
  CHECK(first_of(1) != first_of(2));
}

TEST_CASE("a card that is not there is refused by its name", "[device][audio]") {
  CHECK_THROWS_WITH(device::open_alsa({.card = "hw:31"}),
                    Contains("audio: card 'hw:31' cannot be opened"));
}

// The thread between a source and a card.
using device::PcmOutcome;
using std::chrono::steady_clock;

namespace {
const core::RealtimeRequest no_realtime{0, false, std::nullopt};
constexpr double ramp_s = 0.2;

// Full scale times `level`: what is played is then the ramp itself.
class SteadySource final : public device::SampleSource {
 public:
  explicit SteadySource(float level = 1.0F) : level_{level} {}
  void fill(std::span<float> samples) noexcept override { std::ranges::fill(samples, level_); }

 private:
  float level_;
};

// A card with a buffer of a second, so that a player need not keep step with it, and with the
// faults that it is told.
class ScriptedSink final : public device::PcmSink {
 public:
  struct Script {
    std::atomic<PcmOutcome> outcome{PcmOutcome::played};
    std::atomic<int> writes{0};
    std::atomic<int> begins{0};
    std::atomic<int> ends{0};
    std::atomic<bool> is_blocked{false};  // a write does not return
  };
  explicit ScriptedSink(Script& script) : script_{script} {}
  double rate_hz() const override { return 48'000.0; }
  std::size_t period_frames() const override { return 480; }
  std::size_t buffer_frames() const override { return 48'000; }
  void begin() noexcept override { ++script_.begins; }
  PcmOutcome write(std::span<const float> /*period*/) noexcept override {
    script_.is_blocked.wait(true);
    ++script_.writes;
    return script_.outcome;
  }
  void end() noexcept override { ++script_.ends; }
  std::string failure() const override { return "No such device"; }

 private:
  Script& script_;
};

double seconds_of(const std::function<void()>& task) {
  const auto begun = steady_clock::now();
  task();
  return std::chrono::duration<double>(steady_clock::now() - begun).count();
}

void wait_until(const std::function<bool()>& condition) {
  for (int i = 0; i < 1000 && !condition(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds{5});
  }
  REQUIRE(condition());
}

class Player {
 public:
  explicit Player(ScriptedSink::Script& script, float level = 0.5F, double ramp = ramp_s)
      : player{std::make_unique<ScriptedSink>(script), std::make_unique<SteadySource>(level), ramp,
               no_realtime} {}
  device::AudioPlayer player;
};
}  // namespace

TEST_CASE("what is played rises and falls along its ramps, without a step",
          "[device][audio][threads]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "played.raw";
  {
    device::AudioPlayer player{device::open_alsa({.card = testing::file_card(file)}),
                               std::make_unique<SteadySource>(), ramp_s, no_realtime};
    player.fade_in();
    std::this_thread::sleep_for(std::chrono::milliseconds{100});
  }
  const auto samples = testing::channel_of(file, 1);
  const auto full = std::ranges::max_element(samples);
  CHECK(*full == Approx(1.0));
  CHECK(samples.front() < 1e-6);
  CHECK(samples.back() == 0.0);
  CHECK(std::is_sorted(samples.begin(), full));
  CHECK(std::is_sorted(samples.rbegin(), std::make_reverse_iterator(full)));
  const double steepest = 0.5 * M_PI / (ramp_s * 48'000.0);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    REQUIRE(std::abs(samples[i] - samples[i - 1]) < 1.01 * steepest);
  }
  CHECK(full - samples.begin() == Approx(ramp_s * 48'000.0).margin(10.0));
}

TEST_CASE("a ramp that is turned round goes back from where it is", "[device][audio]") {
  device::Ramp ramp{0.01, 1000.0};
  std::vector<float> up(6, 1.0F);
  ramp.apply(up, device::Heard::yes);
  std::vector<float> down(6, 1.0F);
  ramp.apply(down, device::Heard::no);
  CHECK(down.front() == up[4]);
  CHECK(ramp.is_silent());
  CHECK(down.back() == 0.0F);
}

TEST_CASE("a card that runs empty again and again is counted and played on",
          "[device][audio][threads]") {
  ScriptedSink::Script script;
  script.outcome = PcmOutcome::underrun;
  Player playing{script};
  playing.player.fade_in();
  const int writes = script.writes;
  CHECK(writes > 5);
  CHECK(playing.player.played().underruns >= writes);
  CHECK_FALSE(playing.player.played().loss);
  script.outcome = PcmOutcome::played;
  wait_until([&] { return script.writes > writes + 5; });
  playing.player.fade_out();
  playing.player.fade_in();
  CHECK(playing.player.played().underruns <= 1);  // counted anew
}

TEST_CASE("nobody waits for a card that takes nothing, and it is lost after ten periods",
          "[device][audio][threads]") {
  ScriptedSink::Script script;
  script.outcome = PcmOutcome::lost;
  script.is_blocked = true;
  Player playing{script};
  playing.player.fade_in();  // returns, as the next two do
  CHECK(script.writes == 0);
  playing.player.fade_out();
  playing.player.fade_in();
  script.is_blocked = false;
  script.is_blocked.notify_all();
  wait_until([&] { return playing.player.played().loss.has_value(); });
  CHECK(playing.player.played().underruns == 10);
  CHECK(playing.player.played().loss->why == "the card takes no samples");
}

TEST_CASE("a card that vanishes is told with its cause, and not played on again",
          "[device][audio][threads]") {
  constexpr double an_hour_s = 3600.0;
  ScriptedSink::Script script;
  script.outcome = PcmOutcome::gone;
  Player playing{script, 0.5F, an_hour_s};
  playing.player.fade_in();  // returns, as the next one does
  REQUIRE(playing.player.played().loss);
  CHECK(playing.player.played().loss->why == "No such device");
  const int writes = script.writes;
  playing.player.fade_out();
  playing.player.fade_in();
  std::this_thread::sleep_for(std::chrono::milliseconds{100});
  CHECK(script.writes == writes);
  CHECK(playing.player.played().loss);
}

TEST_CASE("samples beyond full scale are cut and counted", "[device][audio][threads]") {
  ScriptedSink::Script script;
  Player loud{script, 2.0F};
  loud.player.fade_in();
  wait_until([&] { return loud.player.played().cut > 1000; });
  ScriptedSink::Script other;
  Player quiet{other, 1.0F};
  quiet.player.fade_in();
  CHECK(quiet.player.played().cut == 0);
}

TEST_CASE("silence costs nothing: between two trials the card gets no samples",
          "[device][audio][threads]") {
  ScriptedSink::Script script;
  Player playing{script};
  std::this_thread::sleep_for(std::chrono::milliseconds{50});
  CHECK(script.writes == 0);
  playing.player.fade_in();
  playing.player.fade_out();
  wait_until([&] { return script.ends == 1; });
  const int writes = script.writes;
  std::this_thread::sleep_for(std::chrono::milliseconds{50});
  CHECK(script.writes == writes);
  playing.player.fade_in();
  CHECK(script.begins == 2);
}

TEST_CASE("a card without a clock of its own is not fed without end", "[device][audio][threads]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "played.raw";
  double seconds = 0.0;
  {
    device::AudioPlayer player{device::open_alsa({.card = testing::file_card(file)}),
                               std::make_unique<SteadySource>(), ramp_s, no_realtime};
    seconds = seconds_of([&] {
      player.fade_in();
      std::this_thread::sleep_for(std::chrono::milliseconds{300});
    });
  }
  const double played_s = static_cast<double>(testing::channel_of(file, 0).size()) / 48'000.0;
  CHECK(played_s < 2.0 * seconds + ramp_s + 0.3);
}
