#include "analysis/modal/recording/array_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "analysis/modal/recording/sampling.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
std::string own_name(const ArrayFile& file, const NamedArray& array) {
  return array.name.substr(array.name.rfind(file.separator) + 1);
}

// The structure that the array is in, with the separator; empty at the top.
std::string structure_of(const ArrayFile& file, const NamedArray& array) {
  return array.name.substr(0, array.name.rfind(file.separator) + 1);
}

std::vector<double> channel_of(const std::vector<double>& values, const NamedArray& array,
                               std::size_t channel) {
  const bool are_columns = array.rows >= array.columns;
  std::vector<double> samples;
  for (std::size_t i = 0; i < std::max(array.rows, array.columns); ++i) {
    samples.push_back(are_columns ? values[channel * array.rows + i]
                                  : values[i * array.rows + channel]);
  }
  return samples;
}

struct Channel {
  std::string name;  // "acc", "acc:2"
  const NamedArray* array{};
  std::size_t channel{};
};

// Of 0 seconds: it holds no times.
TimeUnit time_unit(const ArrayFile& file, const NamedArray& array) {
  return array.is_vector() ? time_unit_of(own_name(file, array)) : TimeUnit{};
}

std::vector<Channel> channels_of(const ArrayFile& file) {
  std::vector<Channel> channels;
  for (const NamedArray& array : file.arrays) {
    if (array.size() / array.channels() < min_samples || time_unit(file, array).seconds > 0.0) {
      continue;
    }
    for (std::size_t i = 0; i < array.channels(); ++i) {
      channels.push_back(
          {array.channels() == 1 ? array.name : fmt::format("{}:{}", array.name, i + 1), &array,
           i});
    }
  }
  return channels;
}

const Channel& chosen_of(const std::vector<Channel>& channels, const std::string& column,
                         const std::string& file) {
  const auto named = std::ranges::find(channels, column, &Channel::name);
  if (named != channels.end()) {
    return *named;
  }
  const auto number = core::number_in<std::size_t>(column);
  if (number && *number >= 1 && *number <= channels.size()) {
    return channels[*number - 1];
  }
  if (column.empty() && channels.size() == 1) {
    return channels.front();
  }
  std::vector<std::string> names;
  std::ranges::transform(channels, std::back_inserter(names), &Channel::name);
  constexpr std::size_t most_named = 12;
  const bool are_many = names.size() > most_named;
  names.resize(std::min(names.size(), most_named));
  throw core::InvalidInput{
      fmt::format("{}: {} (choose one by --column: {}{})", file,
                  column.empty() ? fmt::format("has {} channels", channels.size())
                                 : fmt::format("--column '{}' is none of its channels", column),
                  fmt::join(names, ", "), are_many ? " ..." : "")};
}

struct RateName {
  const char* name;  // lower case, without blanks, marks and "hz"
  bool is_interval;  // in seconds
};
constexpr std::array rate_names{
    RateName{"fs", false},
    RateName{"rate", false},
    RateName{"samplerate", false},
    RateName{"samplingrate", false},
    RateName{"samplefrequency", false},
    RateName{"samplingfrequency", false},
    RateName{"dt", true},
    RateName{"deltat", true},
    RateName{"sampleinterval", true},
    RateName{"samplinginterval", true},
    RateName{"sampleperiod", true},
    RateName{"samplingperiod", true},
};

const RateName* rate_name_of(const std::string& own_name) {
  std::string name;
  for (const char letter : core::lower_case(own_name)) {
    name += letter >= 'a' && letter <= 'z' ? std::string{letter} : std::string{};
  }
  if (name.ends_with("hz")) {
    name.resize(name.size() - 2);
  }
  const auto found = std::ranges::find(rate_names, name, &RateName::name);
  return found == rate_names.end() ? nullptr : &*found;
}

struct StatedRate {
  std::string name;
  std::string structure;
  double hz{};
};

// By a scalar in the structures around the array, the nearest first, or by the only one elsewhere.
std::optional<StatedRate> stated_rate(const ArrayFile& file, const NamedArray& chosen) {
  std::optional<StatedRate> around;
  std::vector<StatedRate> elsewhere;
  for (const NamedArray& array : file.arrays) {
    const RateName* const name = array.size() == 1 ? rate_name_of(own_name(file, array)) : nullptr;
    if (name == nullptr) {
      continue;
    }
    const double value = file.read(array).front();
    const StatedRate stated{array.name, structure_of(file, array),
                            name->is_interval ? 1.0 / value : value};
    if (!(chosen.name + file.separator).starts_with(stated.structure)) {
      elsewhere.push_back(stated);
    } else if (!around || stated.structure.size() > around->structure.size()) {
      around = stated;
    }
  }
  if (around || elsewhere.empty()) {
    return around;
  }
  const bool is_one = std::ranges::all_of(
      elsewhere, [&](const StatedRate& other) { return other.hz == elsewhere.front().hz; });
  return is_one ? std::optional{elsewhere.front()} : std::nullopt;
}

// Times and a scalar beside them that say different rates.
void check_agree(double of_times_hz, const std::string& times, const StatedRate& scalar,
                 const std::string& file, const ReadingOptions& options) {
  const bool is_decided = options.rate_hz > 0.0 && options.trusts_rate;
  const bool agree = std::abs(scalar.hz / of_times_hz - 1.0) <= max_rate_difference;
  if (!agree && !is_decided) {
    throw core::InvalidInput{
        fmt::format("{}: its times {} say {:.6g} samples a second, its scalar {} {:.6g} (the right "
                    "one: --rate HZ --trust-rate)",
                    file, times, of_times_hz, scalar.name, scalar.hz)};
  }
}

std::optional<double> rate_of(const ArrayFile& file, const NamedArray& chosen,
                              const ReadingOptions& options, Recording& recording) {
  const auto scalar = stated_rate(file, chosen);
  std::vector<NamedArray> arrays = file.arrays;
  std::stable_partition(arrays.begin(), arrays.end(), [&](const NamedArray& array) {
    return structure_of(file, array) == structure_of(file, chosen);
  });
  for (const NamedArray& array : arrays) {
    const TimeUnit unit = time_unit(file, array);
    if (unit.seconds > 0.0 && array.size() == recording.samples.size()) {
      const auto rate_hz = rate_of_times(
          file.read(array), unit, options, [&](std::size_t) { return file.path; },
          recording.remarks);
      if (rate_hz && scalar && scalar->structure == structure_of(file, array)) {
        check_agree(*rate_hz, array.name, *scalar, file.path, options);
      }
      return rate_hz;
    }
  }
  return scalar ? std::optional{scalar->hz} : std::nullopt;
}
}  // namespace

Recording recording_in(const ArrayFile& file, const ReadingOptions& options) {
  const std::vector<Channel> channels = channels_of(file);
  if (channels.empty()) {
    throw core::InvalidInput{
        fmt::format("{}: holds no real numeric array of at least {} samples ({})", file.path,
                    min_samples, file.not_searched)};
  }
  const Channel& chosen = chosen_of(channels, options.column, file.path);
  Recording recording{file.path,
                      chosen.name,
                      0.0,
                      channel_of(file.read(*chosen.array), *chosen.array, chosen.channel),
                      {}};
  check_samples(recording);
  const auto rate_hz = rate_of(file, *chosen.array, options, recording);
  if (!rate_hz && !(options.rate_hz > 0.0)) {
    throw core::InvalidInput{file.path +
                             ": states no rate, by times t or a scalar fs (give --rate HZ)"};
  }
  recording.rate_hz = agreed_rate(rate_hz, options, file.path, "says", recording.remarks);
  return recording;
}
}  // namespace tapstudy::analysis
