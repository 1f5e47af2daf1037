// What ALSA was given to play, measured.
#include "device/audio/noise.hpp"

#include <map>
#include <unsupported/Eigen/FFT>

#include "device/audio/alsa_sink.hpp"
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
