#include <fmt/format.h>
#include <sndfile.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>

#include "analysis/modal/recording/sampling.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
constexpr sf_count_t max_frames = 100'000'000;
constexpr sf_count_t frames_at_once = 65'536;

struct Close {
  void operator()(SNDFILE* file) const { sf_close(file); }
};

std::string refusal_of_sound(const std::string& file, const std::string& why) {
  // libsndfile's own words for a header without a rate or a channel are of its source code.
  return why.find("SF_INFO") != std::string::npos
             ? file +
                   ": its header states a rate of 0, or no channel: mend it, or save the samples "
                   "as a table and give the rate by --rate HZ"
             : fmt::format(
                   "{}: cannot be read as sound: {} (tables end in .csv, .txt, .tsv, .dat "
                   "or .lvm)",
                   file, why);
}

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
// Others, of which libsndfile reads headerless ones and those of MATLAB, too, are refused.
void check_container(const std::string& file, int format) {
  constexpr int mpeg = 0x230000;  // SF_FORMAT_MPEG, since libsndfile 1.1
  constexpr std::array<int, 10> containers{
      SF_FORMAT_WAV, SF_FORMAT_WAVEX, SF_FORMAT_RF64, SF_FORMAT_W64, SF_FORMAT_AIFF,
      SF_FORMAT_AU,  SF_FORMAT_CAF,   SF_FORMAT_FLAC, SF_FORMAT_OGG, mpeg};
  if (std::ranges::find(containers, format & SF_FORMAT_TYPEMASK) == containers.end()) {
    throw core::InvalidInput{file +
                             ": is no sound file (WAV, FLAC, AIFF, AU, CAF, Ogg or MP3 are read; "
                             "tables end in .csv, .txt, .tsv, .dat or .lvm, MATLAB files in .mat, "
                             "universal files in .uff or .unv)"};
  }
}

// The bytes that a file of chunks (RIFF, WAV; FORM, AIFF) should have by its header; 0: not stated.
std::uintmax_t stated_bytes(const std::string& file) {
  std::ifstream stream{file, std::ios::binary};
  std::array<char, 8> header{};
  if (!stream.read(header.data(), header.size())) {
    return 0;
  }
  const std::string kind{header.data(), 4};
  const bool is_big_endian = kind == "FORM";
  if (kind != "RIFF" && !is_big_endian) {
    return 0;
  }
  std::uint32_t size = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    size = size << 8 | static_cast<unsigned char>(header.at(is_big_endian ? 4 + i : 7 - i));
  }
  constexpr std::uint32_t unknown = 0xFFFF'FF00;  // and above: of what was written as a stream
  return size < unknown ? std::uintmax_t{size} + header.size() : 0;
}

// "the file is cut off: ...", or empty.
std::string told_of_missing(const std::string& file, sf_count_t stated, std::size_t read) {
  if (static_cast<sf_count_t>(read) < stated) {
    return fmt::format("the file is cut off: {} of {} samples are there", read, stated);
  }
  const std::uintmax_t bytes = std::filesystem::file_size(file);
  const std::uintmax_t stated_size = stated_bytes(file);
  return bytes + 1 < stated_size  // a chunk of odd size may lack its last, empty byte
             ? fmt::format("the file is cut off: {} of {} bytes are there", bytes, stated_size)
             : std::string{};
}

bool is_lossy(int format) {
  switch (format & SF_FORMAT_SUBMASK) {
    case SF_FORMAT_PCM_S8:
    case SF_FORMAT_PCM_U8:
    case SF_FORMAT_PCM_16:
    case SF_FORMAT_PCM_24:
    case SF_FORMAT_PCM_32:
    case SF_FORMAT_FLOAT:
    case SF_FORMAT_DOUBLE:
    case SF_FORMAT_ALAC_16:
    case SF_FORMAT_ALAC_20:
    case SF_FORMAT_ALAC_24:
    case SF_FORMAT_ALAC_32:
      return false;
    default:
      return true;
  }
}
}  // namespace

Recording read_sound_file(const std::string& file, const ReadingOptions& options) {
  SF_INFO info{};
  const std::unique_ptr<SNDFILE, Close> sound{sf_open(file.c_str(), SFM_READ, &info)};
  if (sound == nullptr) {
    throw core::InvalidInput{refusal_of_sound(file, sf_strerror(nullptr))};
  }
  check_container(file, info.format);
  if (info.frames > max_frames) {
    throw core::InvalidInput{
        fmt::format("{}: has {} samples (at most {})", file, info.frames, max_frames)};
  }
  const int channel = channel_from(options.column, info.channels, file);
  Recording recording{file, fmt::format("channel {}", channel + 1),
                      0.0,  samples_of(sound.get(), info, channel),
                      {},   full_scale};
  recording.rate_hz =
      agreed_rate(static_cast<double>(info.samplerate), options, file, "says", recording.remarks);
  if (std::string missing = told_of_missing(file, info.frames, recording.samples.size());
      !missing.empty()) {
    recording.remarks.push_back(std::move(missing));
  }
  if (is_lossy(info.format)) {
    recording.remarks.emplace_back(
        "is sound of a lossy format: its coder adds and removes what nobody is to hear, so weak "
        "modes and damping ratios may be the coder's (record WAV or FLAC)");
  }
  check_samples(recording);
  return recording;
}
}  // namespace tapstudy::analysis
