#include <fmt/format.h>
#include <sndfile.h>

#include <cmath>
#include <memory>

#include "analysis/modal/recording/recording.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
constexpr sf_count_t max_frames = 100'000'000;
constexpr sf_count_t frames_at_once = 65'536;

struct Close {
  void operator()(SNDFILE* file) const { sf_close(file); }
};

// "2" or "channel 2" → 1, of so many.
int channel_from(const std::string& column, int channels, const std::string& file) {
  if (column.empty() && channels == 1) {
    return 0;
  }
  constexpr const char* prefix = "channel ";
  const std::string digits = column.starts_with(prefix) ? column.substr(8) : column;
  const auto number = core::number_in<int>(digits);
  if (!number || *number < 1 || *number > channels) {
    throw core::InvalidInput{fmt::format("{}: has {} channels (choose one by --column 1 ... {})",
                                         file, channels, channels)};
  }
  return *number - 1;
}

std::vector<double> samples_of(SNDFILE* sound, const SF_INFO& info, int channel) {
  const auto channels = static_cast<std::size_t>(info.channels);
  std::vector<double> buffer(static_cast<std::size_t>(frames_at_once) * channels);
  std::vector<double> samples;
  for (sf_count_t got = 0; (got = sf_readf_double(sound, buffer.data(), frames_at_once)) > 0;) {
    for (std::size_t frame = 0; frame < static_cast<std::size_t>(got); ++frame) {
      samples.push_back(buffer[frame * channels + static_cast<std::size_t>(channel)]);
    }
  }
  return samples;
}
}  // namespace

Recording read_sound_file(const std::string& file, const ReadingOptions& options) {
  SF_INFO info{};
  const std::unique_ptr<SNDFILE, Close> sound{sf_open(file.c_str(), SFM_READ, &info)};
  if (sound == nullptr) {
    throw core::InvalidInput{
        fmt::format("{}: cannot be read as sound: {} (tables end in .csv, .txt or .tsv)", file,
                    sf_strerror(nullptr))};
  }
  if (options.rate_hz > 0.0 && options.rate_hz != info.samplerate) {
    throw core::InvalidInput{fmt::format("{}: says {} samples a second, --rate {:g}", file,
                                         info.samplerate, options.rate_hz)};
  }
  if (info.frames > max_frames) {
    throw core::InvalidInput{
        fmt::format("{}: has {} samples (at most {})", file, info.frames, max_frames)};
  }
  const int channel = channel_from(options.column, info.channels, file);
  Recording recording{file,
                      fmt::format("channel {}", channel + 1),
                      static_cast<double>(info.samplerate),
                      samples_of(sound.get(), info, channel),
                      {}};
  for (std::size_t i = 0; i < recording.samples.size(); ++i) {
    if (!std::isfinite(recording.samples[i])) {
      throw core::InvalidInput{fmt::format("{}: sample {} is not finite", file, i + 1)};
    }
  }
  if (recording.samples.size() < min_samples) {
    throw core::InvalidInput{fmt::format("{}: has {} samples (at least {})", file,
                                         recording.samples.size(), min_samples)};
  }
  return recording;
}
}  // namespace tapstudy::analysis
