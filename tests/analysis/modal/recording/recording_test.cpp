// Recordings of taps, read from tables and sound files, and the taps in them.
#include "analysis/modal/recording/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "analysis/modal/recording/taps.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/reference_programs.hpp"
#include "support/synthetic_taps.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
constexpr int rows = 80;
double value_at(int i) {
  return std::round(1000.0 * std::sin(0.3 * i)) / 1000.0;
}

// Times every half millisecond in this unit, values, a second channel.
std::string table(const std::string& header, char separator, double units_per_s,
                  bool has_decimal_comma) {
  std::string text = header + "\n";
  for (int i = 0; i < rows; ++i) {
    std::string row = fmt::format("{:.6g}{}{:.6g}{}{}", 0.0005 * i * units_per_s, separator,
                                  value_at(i), separator, i);
    if (has_decimal_comma) {
      std::ranges::replace(row, '.', ',');
    }
    text += row + "\n";
  }
  return text;
}

Recording read(const std::string& text, const ReadingOptions& options) {
  std::istringstream stream{text};
  return read_csv_recording(stream, "taps.csv", options);
}

std::string column_of_values(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    text += fmt::format("{}\n", value_at(i));
  }
  return text;
}

const std::vector<testing::PlantedMode> plate{{{80.0, 0.04}, 1.0}, {{210.0, 0.03}, 0.7}};
}  // namespace

TEST_CASE("a table is the same recording whatever its separator, header and unit of time",
          "[analysis][recordings]") {
  const Recording recording =
      GENERATE(read(table("time,acc,other", ',', 1.0, false), {0.0, "acc"}),
               read(table("Time (ms);acc;other", ';', 1e3, true), {0.0, "acc"}),
               read(table("t_us\tacc\tother", '\t', 1e6, false), {2000.0, "acc"}),
               read(table("Time (\u00b5s),acc,other", ',', 1e6, false), {2000.0, "acc"}),
               read(table("time [\u03bcs],acc,other", ',', 1e6, false), {2000.0, "acc"}),
               read(table("# a comment\n# another", ',', 1.0, false), {0.0, "2"}),
               read(table("index,acc,other", ',', 1.0, false), {2000.0, "acc"}),
               read(table("time,acc,timestamp_us", ',', 1.0, false), {}));
  CHECK(recording.rate_hz == Approx(2000.0));
  REQUIRE(recording.samples.size() == rows);
  for (int i = 0; i < rows; ++i) {
    CHECK(recording.samples[static_cast<std::size_t>(i)] == Approx(value_at(i)));
  }
}

TEST_CASE("a table that cannot be a recording is refused where it cannot",
          "[analysis][recordings]") {
  const std::string good = table("time,acc,other", ',', 1.0, false);
  const ReadingOptions acc{0.0, "acc"};
  using Case = std::tuple<std::string, ReadingOptions, std::string>;
  const auto [text, options, words] = GENERATE_COPY(values<Case>({
      {good, {}, "taps.csv:1: has 2 channels (choose one by --column: acc, other)"},
      {table("time,acc,Time (ms)", ',', 1.0, false), {0.0, "force"}, "none of its columns (acc)"},
      {table("# none", ',', 1.0, false), {}, "has 2 channels (choose one by --column: 2 to 3)"},
      {good, {0.0, "force"}, "none of its columns (acc, other)"},
      {good, {0.0, "time"}, "is the time"},
      {good, {1000.0, "acc"}, "its times say 2000 samples a second, --rate 1000"},
      {column_of_values(rows), {}, "no time column (give the rate by --rate HZ)"},
      {column_of_values(40), {1000.0, ""}, "taps.csv:40: has 40 samples (at least 64)"},
      {testing::replaced(good, "0.003,", "0.00312,"), acc, "taps.csv:8: times are up to 0.2"},
      {"acc\n1\nnan\n" + column_of_values(rows), {1000.0, ""}, "taps.csv:3: 'nan'"},
      {testing::replaced(good, "\n0.003,", "\n0.003,1\n0.003,"), acc, "taps.csv:8: has 2 cells"},
      {"", {1000.0, ""}, "taps.csv:1: holds no values"},
  }));
  INFO(words);
  CHECK_THROWS_WITH(read(text, options), Contains(words));
  CHECK_THROWS_AS(read(text, options), core::InvalidInput);
}

TEST_CASE("a sample that is missing shows in the times, at its line", "[analysis][recordings]") {
  std::string text = table("time,acc,other", ',', 1.0, false);
  const std::size_t begin = text.find("\n0.02,") + 1;
  text.erase(begin, text.find('\n', begin) + 1 - begin);
  CHECK_THROWS_WITH(read(text, {0.0, "acc"}), Contains("taps.csv:42:") && Contains("missing"));
}

TEST_CASE("a channel of a sound file is what SciPy wrote into it", "[analysis][recordings]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.wav";
  const auto written = testing::python_numbers(
      "from scipy.io import wavfile\nrng = np.random.default_rng(1)\n"
      "x = rng.integers(-32768, 32767, (500, 2)).astype(np.int16)\nwavfile.write('" +
      file + "', 12345, x)\nout(x[:, 1] / 32768)\n");
  const Recording recording = read_recording(file, {0.0, "2"});
  CHECK(recording.rate_hz == 12345.0);
  CHECK(recording.channel == "channel 2");
  CHECK(recording.samples == written);
  CHECK(recording.remarks.empty());
  CHECK_THROWS_WITH(read_recording(file, {}), Contains("has 2 channels"));
  CHECK_THROWS_WITH(read_recording(file, {0.0, "3"}), Contains("--column 1 ... 2"));
  CHECK_THROWS_WITH(read_recording(file, {8000.0, "1"}), Contains("12345 samples a second"));
  testing::write(directory / "no.wav", "this is no sound");
  CHECK_THROWS_WITH(read_recording(directory / "no.wav", {}), Contains("cannot be read as sound"));
  CHECK_THROWS_WITH(read_recording(directory / "none.csv", {}), Contains("cannot be read"));
}

TEST_CASE("a sound file that is cut off is read as far as it goes, and that is said",
          "[analysis][recordings]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.wav";
  const auto half = testing::python_numbers(
      "from scipy.io import wavfile\nx = np.arange(500).astype(np.int16)\nwavfile.write('" + file +
      "', 8000, x)\nwith open('" + file +
      "', 'r+b') as f: f.truncate(44 + 500)\nout(x[:250] / "
      "32768)\n");
  const Recording recording = read_recording(file, {});
  CHECK(recording.samples == half);
  REQUIRE(recording.remarks.size() == 1);
  CHECK_THAT(recording.remarks.front(), Contains("cut off: 544 of 1044 bytes"));
}

TEST_CASE("every impact is found within a millisecond, and nothing else",
          "[analysis][recordings]") {
  const std::vector<double> times_s{0.3, 0.9, 1.02, 2.0};  // two of them close together
  const Recording recording =
      testing::planted_recording(plate, times_s, 4000.0, 3.0, GENERATE(0.001, 0.05), 3);
  const FoundTaps found = find_taps(recording, {});
  REQUIRE(found.taps.size() == times_s.size());
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    CHECK(static_cast<double>(found.taps[i].onset) / 4000.0 == Approx(times_s[i]).margin(1e-3));
    CHECK(found.taps[i].begin > found.taps[i].onset);
  }
  // the first of the two close ones ends before the second begins
  CHECK(found.taps[1].end < found.taps[2].onset);
}

TEST_CASE("a tap in the ring of another is cut off from it, and that is said",
          "[analysis][recordings]") {
  const Recording recording =
      testing::planted_recording({{{80.0, 0.01}, 1.0}}, {0.3, 0.45}, 4000.0, 2.0, 0.001, 3);
  const FoundTaps found = find_taps(recording, {});
  REQUIRE(found.taps.size() == 2);
  REQUIRE(found.remarks.size() == 1);
  CHECK_THAT(sentence(found.remarks.front()), Contains("0.300 s: cut at the next one"));
}

TEST_CASE("a second blow is found while the first still rings", "[analysis][recordings]") {
  const double gap_s = GENERATE(0.045, 0.07);
  const Recording recording = testing::planted_recording(
      plate, {0.3, 0.3 + gap_s, 1.1, 1.1 + gap_s}, 8192.0, 2.5, 0.001, 3);
  CAPTURE(gap_s);
  CHECK(find_taps(recording, {}).impacts == 4);
}

TEST_CASE("a decay that is cut while it rings is told, and one that is not is not",
          "[analysis][recordings]") {
  const Recording recording =
      testing::planted_recording({{{50.0, 0.002}}}, {0.3}, 2000.0, 8.0, 1e-4, 3);
  const FoundTaps cut = find_taps(recording, {});
  REQUIRE(cut.remarks.size() == 1);
  CHECK_THAT(cut.remarks.front().kind, Contains("cut after 2 s, while it rings (--longest)"));
  CHECK(find_taps(recording, {.max_s = 20.0}).remarks.empty());
}

TEST_CASE("what strikes twice within 30 ms is one impact, whose decay begins after the last blow",
          "[analysis][recordings]") {
  const double rate_hz = 8192.0;
  const double second_s = GENERATE(0.012, 0.025, 0.04);
  const std::vector<double> blows_s{0.3, 0.3 + second_s, 1.1};
  Recording force = testing::planted_recording({}, {}, rate_hz, 2.5, 0.01, 5);
  for (const double blow_s : blows_s) {
    for (double t_s = 0.0; t_s < 0.001; t_s += 1.0 / rate_hz) {
      force.samples[static_cast<std::size_t>(std::lround((blow_s + t_s) * rate_hz))] +=
          10.0 * std::sin(std::numbers::pi * t_s / 0.001);
    }
  }
  const std::vector<Impact> impacts = force_impacts(force);
  CAPTURE(second_s);
  REQUIRE(impacts.size() == (second_s < 0.03 ? 2U : 3U));
  CHECK(static_cast<double>(impacts.front().onset) / rate_hz == Approx(0.3).margin(5e-4));
  if (second_s < 0.03) {
    CHECK(static_cast<double>(impacts.front().last_blow) / rate_hz ==
          Approx(0.3 + second_s).margin(5e-4));
    const FoundTaps found =
        taps_at(impacts, testing::planted_recording(plate, blows_s, rate_hz, 2.5, 0.001, 6), {});
    CHECK(found.taps.front().begin > impacts.front().last_blow);
    CHECK_THAT(found.remarks.front().kind, Contains("struck again"));
  }
}

TEST_CASE("modes that beat, and slow ones, ring on after their impacts and are no new ones",
          "[analysis][recordings]") {
  using Modes = std::vector<testing::PlantedMode>;
  const auto modes = GENERATE(values<Modes>({{{{62.0, 0.01}, 1.0}, {{72.0, 0.01}, 1.0}},
                                             {{{40.0, 0.01}, 1.0}, {{46.0, 0.01}, 0.9}},
                                             {{{100.0, 0.005}, 1.0}, {{110.0, 0.005}, 1.0}},
                                             {{{7.0, 0.02}, 1.0}, {{180.0, 0.02}, 0.5}},
                                             {{{80.0, 0.002}, 1.0}}}));
  const double rate_hz = GENERATE(2000.0, 8000.0);
  const double noise = GENERATE(0.001, 0.03);
  const Recording recording =
      testing::planted_recording(modes, {1.3, 2.5, 3.7}, rate_hz, 5.0, noise, 3);
  CAPTURE(modes.front().pole.frequency_hz, rate_hz, noise);
  CHECK(find_taps(recording, {}).impacts == 3);
}

TEST_CASE("noise and hum hold no tap, in words", "[analysis][recordings]") {
  Recording recording = testing::planted_recording(plate, {}, 4000.0, 3.0, 1.0, 6);
  CHECK_THROWS_WITH(find_taps(recording, {}), Contains("planted.csv: holds no tap"));
  for (std::size_t n = 0; n < recording.samples.size(); ++n) {
    recording.samples[n] +=
        10.0 * std::sin(2.0 * std::numbers::pi * 50.0 * static_cast<double>(n) / recording.rate_hz);
  }
  CHECK_THROWS_WITH(find_taps(recording, {}), Contains("holds no tap"));
  recording.samples.assign(1000, 0.0);
  CHECK_THROWS_WITH(find_taps(recording, {}), Contains("holds no tap"));
}

TEST_CASE("a floor that rocks slowly makes no taps beside a real one", "[analysis][recordings]") {
  constexpr double rate_hz = 8000.0;
  constexpr double rocks_below_hz = 20.0;
  constexpr double struck_s = 2.9;
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 7));
  Recording recording =
      testing::planted_recording({{{513.0, 0.008}, 1.0}}, {struck_s}, rate_hz, 4.0, 0.003, seed);
  core::Rng rng{seed + 100};
  const double passes = 2.0 * std::numbers::pi * rocks_below_hz / rate_hz;
  double once = 0.0;
  double twice = 0.0;
  for (double& sample : recording.samples) {
    once += passes * (rng.normal() - once);
    twice += passes * (once - twice);
    sample += 0.5 * twice;  // ten times the sensor's noise
  }
  const FoundTaps found = find_taps(recording, {});
  CHECK(found.impacts == 1);
  CHECK(static_cast<double>(found.taps.front().onset) / rate_hz == Approx(struck_s).margin(1e-3));
}

TEST_CASE("what is far weaker than most taps is a click, and left out in words",
          "[analysis][recordings]") {
  const std::vector<double> times_s{0.3, 1.0, 1.7, 2.4};
  Recording recording = testing::planted_recording(plate, times_s, 4000.0, 4.0, 0.0001, 3);
  constexpr std::size_t click = 12800;
  const double share = GENERATE(0.02, 0.1);
  for (std::size_t n = click; n < recording.samples.size(); ++n) {
    recording.samples[n] +=
        share * testing::ringing(plate, static_cast<double>(n - click) / 4000.0);
  }
  const FoundTaps found = find_taps(recording, {});
  REQUIRE(found.impacts == 5);
  CHECK(found.taps.size() == (share < 0.05 ? 4 : 5));
  const bool is_told = std::ranges::any_of(found.remarks, [](const TapRemark& remark) {
    return remark.at_s == Approx(3.2).margin(1e-3) &&
           remark.kind.find("far weaker") != std::string::npos;
  });
  CHECK(is_told == (share < 0.05));
}

TEST_CASE("samples that are all the same before and after the taps change nothing of them",
          "[analysis][recordings]") {
  const Recording recording =
      testing::planted_recording(plate, {0.5, 1.5, 2.5}, 4000.0, 3.5, 0.001, 4);
  const FoundTaps alone = find_taps(recording, {});
  constexpr std::size_t silent = 40000;
  Recording padded = recording;
  padded.samples.insert(padded.samples.begin(), silent, 0.0);
  padded.samples.insert(padded.samples.end(), 5 * silent, 0.0);
  const FoundTaps found = find_taps(padded, {});
  REQUIRE(found.taps.size() == alone.taps.size());
  CHECK(found.impacts == alone.impacts);
  CHECK(found.remarks.size() == alone.remarks.size());
  for (std::size_t i = 0; i < found.taps.size(); ++i) {
    CHECK(found.taps[i].onset == alone.taps[i].onset + silent);
    CHECK(found.taps[i].begin == alone.taps[i].begin + silent);
  }
}

TEST_CASE("a blow between samples that are exactly 0 is one, as a force window leaves it",
          "[analysis][recordings]") {
  const double rate_hz = 8192.0;
  const double noise = GENERATE(0.0, 0.05);  // within the window
  const double blow_s = GENERATE(0.0015, 0.3);
  core::Rng rng{7};
  Recording force{"force.csv", "force", rate_hz, std::vector<double>(8192, 0.0), {}};
  const auto first = static_cast<std::size_t>(std::lround(blow_s * rate_hz));
  constexpr std::size_t pulse = 8;
  constexpr std::size_t window = 300;
  for (std::size_t i = 0; i < window; ++i) {
    force.samples[first + i] = noise * rng.normal();
  }
  for (std::size_t i = 0; i < pulse; ++i) {
    force.samples[first + i] +=
        250.0 * std::sin(std::numbers::pi * (static_cast<double>(i) + 0.5) / pulse);
  }
  CAPTURE(noise, blow_s);
  const std::vector<Impact> impacts = force_impacts(force);
  REQUIRE(impacts.size() == 1);
  CHECK(static_cast<double>(impacts.front().onset) / rate_hz == Approx(blow_s).margin(5e-4));
}

TEST_CASE("a decay begins after the last sample at the sensor's limit", "[analysis][recordings]") {
  Recording recording = testing::planted_recording(plate, {0.5}, 4000.0, 2.0, 0.001, 4);
  CHECK(rail_samples(recording.samples, 0.0).empty());
  for (double& sample : recording.samples) {
    sample = std::clamp(sample, -0.5, 0.5);
  }
  const auto rails = rail_samples(recording.samples, 0.0);
  REQUIRE_FALSE(rails.empty());
  const FoundTaps found = find_taps(recording, {});
  REQUIRE(found.taps.size() == 1);
  CHECK(found.taps.front().begin > rails.back());
  REQUIRE(found.remarks.size() == 1);
  CHECK_THAT(found.remarks.front().kind, Contains("clipped"));
}

TEST_CASE("a vibration that goes on after dropped samples was not struck there",
          "[analysis][recordings]") {
  Recording recording = testing::planted_recording(plate, {0.5, 1.5}, 4000.0, 2.5, 0.001, 4);
  for (const double at_s : {0.53, 0.58, 1.55}) {
    const auto begin = recording.samples.begin() + std::lround(at_s * recording.rate_hz);
    std::fill(begin, begin + 8, 0.0);
  }
  const FoundTaps found = find_taps(recording, {});
  REQUIRE(found.taps.size() == 2);
  CHECK(static_cast<double>(found.taps[0].onset) / 4000.0 == Approx(0.5).margin(0.002));
  CHECK(static_cast<double>(found.taps[1].onset) / 4000.0 == Approx(1.5).margin(0.002));
}

TEST_CASE("an amplifier's limit is found through the noise of the converter after it",
          "[analysis][recordings]") {
  Recording recording = testing::planted_recording(plate, {0.5}, 8000.0, 2.0, 0.0, 4);
  core::Rng rng{8};
  const double noise = 1e-4;
  CHECK(rail_samples(recording.samples, noise).empty());
  for (double& sample : recording.samples) {
    sample = std::clamp(sample, -0.5, 0.5) + noise * rng.normal();
  }
  CHECK_FALSE(rail_samples(recording.samples, noise).empty());
  CHECK(rail_samples(recording.samples, 0.0).empty());  // not two samples are equal
}

TEST_CASE("a recording of less than ten frames is too short, at any rate",
          "[analysis][recordings]") {
  for (const double rate_hz : {48'000.0, 1e6}) {
    for (const std::size_t samples : {64U, 95U, 900U}) {
      const Recording recording{"short.csv", "", rate_hz, std::vector<double>(samples, 1.0), {}};
      CHECK_THROWS_WITH(find_taps(recording, {}), Contains("short.csv: has"));
    }
  }
}

TEST_CASE("a smooth crest that the converter's steps flatten is not clipped",
          "[analysis][recordings]") {
  std::vector<double> samples;
  for (int n = 0; n < 4000; ++n) {
    samples.push_back(std::round(500.0 * std::exp(-0.001 * n) * std::sin(0.01 * n)));
  }
  const double crest = *std::ranges::max_element(samples);
  CHECK(std::ranges::count(samples, crest) > 3);
  CHECK(rail_samples(samples, 0.0).empty());
}

TEST_CASE("zeros between which a vibration jumps are dropped samples, a slow passage is none",
          "[analysis][recordings]") {
  const Recording recording = testing::planted_recording(plate, {0.5}, 4000.0, 2.0, 0.0, 4);
  std::vector<double> samples;
  for (const double sample : recording.samples) {
    samples.push_back(std::round(200.0 * sample));  // of a coarse converter: rests at 0
  }
  CHECK(std::ranges::count(samples, 0.0) > 1000);
  CHECK(dropped_samples(samples, 0.0).empty());
  std::fill(samples.begin() + 2100, samples.begin() + 2112, 0.0);
  const std::vector<std::size_t> dropped = dropped_samples(samples, 0.0);
  REQUIRE(dropped.size() >= 12);
  CHECK(dropped.front() >= 2099);
  CHECK(dropped.back() <= 2112);
}

namespace {
constexpr double sound_rate_hz = 16'000.0;

// The sum of the harmonics of a voice or an instrument, from begin_s on, in noise.
struct Sounded {
  double begin_s{};
  double duration_s{};
  double first_hz{};
  double last_hz{};
  double attack_s{};
  double brightest_hz{};  // harmonics near it are the loudest
};

Recording sounded(const std::vector<Sounded>& sounds, double duration_s) {
  Recording recording{"sound.wav", "channel 1", sound_rate_hz, {}, {}};
  core::Rng rng{9};
  recording.samples.resize(static_cast<std::size_t>(duration_s * sound_rate_hz));
  std::ranges::generate(recording.samples, [&] { return 1e-4 * rng.normal(); });
  for (const Sounded& sound : sounds) {
    double phase_rad = 0.0;
    const auto begin = static_cast<std::size_t>(sound.begin_s * sound_rate_hz);
    for (double t_s = 0.0; t_s < sound.duration_s; t_s += 1.0 / sound_rate_hz) {
      const double pitch_hz =
          sound.first_hz + (sound.last_hz - sound.first_hz) * t_s / sound.duration_s;
      phase_rad += 2.0 * std::numbers::pi * pitch_hz / sound_rate_hz;
      const double envelope = std::min(
          {1.0, t_s / sound.attack_s, (sound.duration_s - t_s) / (0.3 * sound.duration_s)});
      for (int k = 1; k * pitch_hz < 4000.0; ++k) {
        const double off = (k * pitch_hz - sound.brightest_hz) / (0.4 * sound.brightest_hz);
        recording.samples[begin + static_cast<std::size_t>(t_s * sound_rate_hz)] +=
            0.2 * envelope / (1.0 + off * off) * std::sin(k * phase_rad);
      }
    }
  }
  return recording;
}

// Syllables of a voice whose pitch and vowel change.
Recording speech() {
  core::Rng rng{17};
  std::vector<Sounded> syllables;
  for (double at_s = 0.4; at_s < 3.6; at_s += 0.25 + 0.1 * rng.uniform()) {
    const double pitch_hz = 100.0 + 60.0 * rng.uniform();
    syllables.push_back({at_s, 0.2, pitch_hz, pitch_hz * (0.8 + 0.4 * rng.uniform()), 0.09,
                         300.0 + 900.0 * rng.uniform()});
  }
  return sounded(syllables, 4.0);
}

// A melody of an instrument that is blown or bowed.
Recording music() {
  std::vector<Sounded> notes;
  for (const int semitones : {0, 4, 7, 12, 9, 5, 2, 11, 7, 0}) {
    const double pitch_hz = 220.0 * std::pow(2.0, semitones / 12.0);
    notes.push_back(
        {0.4 + 0.35 * static_cast<double>(notes.size()), 0.3, pitch_hz, pitch_hz, 0.1, pitch_hz});
  }
  return sounded(notes, 4.4);
}
}  // namespace

TEST_CASE("speech and music are refused in one sentence", "[analysis][recordings]") {
  CHECK_THROWS_WITH(find_taps(speech(), {}), Contains("sound.wav: holds no taps but speech"));
  CHECK_THROWS_WITH(find_taps(music(), {}), Contains("sound.wav: holds no taps but speech"));
}

TEST_CASE("what rings for seconds, beats, or has a hundred modes is a tap",
          "[analysis][recordings]") {
  using Modes = std::vector<testing::PlantedMode>;
  core::Rng rng{21};
  Modes cymbal;
  for (int i = 0; i < 100; ++i) {
    cymbal.push_back(
        {{300.0 * std::pow(20.0, rng.uniform()), 3e-4 + 1e-3 * rng.uniform()}, 0.2 * rng.normal()});
  }
  const Modes glass{{{640.0, 2e-4}, 1.0}, {{646.0, 2e-4}, -0.9}, {{1500.0, 3e-4}, 0.3}};
  const Modes bell{{{210.0, 1e-4}, 0.6},  {{424.0, 2e-4}, 0.8}, {{508.0, 3e-4}, 0.7},
                   {{640.0, 4e-4}, 0.5},  {{845.0, 3e-4}, 1.0}, {{1260.0, 5e-4}, 0.6},
                   {{1700.0, 6e-4}, 0.4}, {{2250.0, 8e-4}, 0.3}};
  const Modes foam{{{90.0, 0.25}, 1.0}, {{180.0, 0.3}, 0.5}};
  for (const Modes& modes : {cymbal, glass, bell, foam}) {
    CAPTURE(modes.size());
    Recording recording = testing::planted_recording(modes, {1.0}, sound_rate_hz, 2.5, 1e-3, 3);
    const std::vector<double> one = recording.samples;  // then a hand stops it, twice
    recording.samples.insert(recording.samples.end(), one.begin(), one.end());
    recording.samples.insert(recording.samples.end(), one.begin(), one.end());
    CHECK(find_taps(recording, {}).impacts >= 3);  // a sudden stop may look like one
  }
}

TEST_CASE("a body that rings for nearly all of a recording is found by the silence before its blow",
          "[analysis][recordings]") {
  const double duration_s = GENERATE(4.5, 6.5, 24.5);
  const Recording recording = testing::planted_recording(
      {{{441.7, 1e-4}, 1.0}, {{2756.0, 2e-4}, 0.3}}, {0.5}, 8000.0, duration_s, 1e-3, 5);
  const FoundTaps found = find_taps(recording, {.max_s = 30.0});
  REQUIRE(found.taps.size() == 1);
  CHECK(static_cast<double>(found.taps[0].onset) / 8000.0 == Approx(0.5).margin(0.002));
  CHECK(found.noise_rms < 0.005);  // not the ringing
}
