#include "analysis/modal/recording/sampling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>
#include <sstream>
#include <utility>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
std::string with_ascii_micro(const std::string& text) {
  std::string ascii;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_micro = text.compare(i, 2, "\u00b5") == 0 || text.compare(i, 2, "\u03bc") == 0;
    ascii += is_micro ? 'u' : text[i];
    i += is_micro ? 1 : 0;
  }
  return ascii;
}

namespace {
constexpr double highest_rate_hz = 1e7;  // as of --rate

// In lower case; everything but letters becomes blanks.
std::string letters_of(const std::string& name) {
  std::string letters;
  for (const char c : with_ascii_micro(name)) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_letter = byte >= 0x80 || std::isalpha(byte) != 0;
    letters += is_letter ? static_cast<char>(std::tolower(byte)) : ' ';
  }
  return letters;
}

// What names a column of times, alone in seconds or in the unit that it is, and what may follow it
// as its unit.
struct TimeWord {
  const char* word;
  double seconds;
  bool is_name;
  bool is_unit;
};
constexpr std::array<TimeWord, 15> time_words{{{"t", 1.0, true, false},
                                               {"time", 1.0, true, false},
                                               {"timestamp", 1.0, true, false},
                                               {"zeit", 1.0, true, false},
                                               {"s", 1.0, false, true},
                                               {"sec", 1.0, false, true},
                                               {"second", 1.0, true, true},
                                               {"seconds", 1.0, true, true},
                                               {"ms", 1e-3, false, true},
                                               {"millis", 1e-3, true, true},
                                               {"milliseconds", 1e-3, true, true},
                                               {"us", 1e-6, false, true},
                                               {"micros", 1e-6, true, true},
                                               {"microseconds", 1e-6, true, true},
                                               {"ns", 1e-9, false, true}}};

// 0 of another word.
double seconds_of(const std::string& word, bool TimeWord::*use) {
  const auto* const known = std::ranges::find_if(
      time_words, [&](const TimeWord& one) { return one.word == word && one.*use; });
  return known == time_words.end() ? 0.0 : known->seconds;
}
}  // namespace

TimeUnit time_unit_of(const std::string& name) {
  std::istringstream stream{letters_of(name)};
  std::vector<std::string> words{std::istream_iterator<std::string>{stream}, {}};
  if (words == std::vector<std::string>{"x", "value"}) {  // LabVIEW
    return {1.0, true};
  }
  if (words.size() > 1 && words.front() == "elapsed") {
    words.erase(words.begin());
  }
  if (words.size() > 1 && words[0] == "time" && words[1] == "stamp") {
    words.erase(words.begin() + 1);
  }
  const double named_s = words.empty() ? 0.0 : seconds_of(words.front(), &TimeWord::is_name);
  if (named_s == 0.0 || words.size() > 2) {
    return {};
  }
  const double unit_s = seconds_of(words.back(), &TimeWord::is_unit);
  return words.size() == 1 ? TimeUnit{named_s, unit_s > 0.0} : TimeUnit{unit_s, true};
}

namespace {
// Start and period of the grid nearest to the times by least squares: each of them may be off.
std::pair<double, double> uniform_grid(const std::vector<double>& times) {
  const auto count = static_cast<double>(times.size());
  const double middle = 0.5 * (count - 1.0);
  double mean = 0.0;
  double slope = 0.0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    mean += (times[i] - times.front()) / count;
    slope += (static_cast<double>(i) - middle) * (times[i] - times.front());
  }
  const double period = slope / (count * (count * count - 1.0) / 12.0);
  return {times.front() + mean - middle * period, period};
}
}  // namespace

namespace {
// Times that are not uniform: thrown, or remarked on where another rate holds.
void refuse_times(const std::string& place, const std::string& fault, const std::string& advice,
                  const ReadingOptions& options, std::vector<std::string>& remarks) {
  if (!(options.trusts_rate && options.rate_hz > 0.0)) {
    throw core::InvalidInput{fmt::format("{}: {}{}", place, fault, advice)};
  }
  remarks.push_back(
      fmt::format("{}: {:g} samples a second were taken, by --trust-rate", fault, options.rate_hz));
}

// What numbers further apart may be instead: milliseconds, of samples at up to 200 kHz; or numbers
// of samples, whatever their name says.
constexpr double longest_without_unit_s = 0.005;
constexpr double longest_stated_s = 0.1;
}  // namespace

std::optional<double> rate_of_times(const std::vector<double>& times, const TimeUnit& unit,
                                    const ReadingOptions& options,
                                    const std::function<std::string(std::size_t)>& place,
                                    std::vector<std::string>& remarks) {
  const auto [start, period] = uniform_grid(times);
  if (!(period > 0.0)) {
    refuse_times(place(times.size() - 1), "times must ascend", "", options, remarks);
    return std::nullopt;
  }
  const double longest_period_s = unit.is_stated ? longest_stated_s : longest_without_unit_s;
  const double rate_hz = 1.0 / (period * unit.seconds);
  const bool is_confirmed =
      std::abs(rate_hz - options.rate_hz) <= max_rate_difference * options.rate_hz;
  if (!is_confirmed && period * unit.seconds >= longest_period_s * (1.0 - 1e-6)) {
    refuse_times(
        place(0), fmt::format("times are {:.4g} s apart", period * unit.seconds),
        " (name them time_s, or give their rate by --rate HZ; if they are no seconds, name "
        "them time_ms or time_us; if they are no times, give --rate HZ --trust-rate)",
        options, remarks);
    return std::nullopt;
  }
  double furthest = 0.0;
  std::size_t worst_step = 1;
  double worst_misfit = 0.0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double expected = start + period * static_cast<double>(i);
    furthest = std::max(furthest, std::abs(times[i] - expected) / period);
    const double misfit = std::abs(times[i] - times[i - 1] - period);
    worst_step = misfit > worst_misfit ? i : worst_step;
    worst_misfit = std::max(misfit, worst_misfit);
  }
  if (furthest > max_jitter_periods) {
    const std::string advice = fmt::format(
        " (at most {}); here the step is {:.3g} periods: samples are missing or were not taken "
        "uniformly (if they were, and the times alone are rounded, as whole milliseconds are: "
        "--rate HZ --trust-rate)",
        max_jitter_periods, (times[worst_step] - times[worst_step - 1]) / period);
    refuse_times(place(worst_step),
                 fmt::format("times are up to {:.2g} periods from a uniform grid", furthest),
                 advice, options, remarks);
    return std::nullopt;
  }
  return rate_hz;
}

double agreed_rate(std::optional<double> of_file_hz, const ReadingOptions& options,
                   const std::string& place, const std::string& stated,
                   std::vector<std::string>& remarks) {
  const bool is_given = options.rate_hz > 0.0;
  if (!of_file_hz && !is_given) {
    throw core::InvalidInput{place + ": has no time column (give the rate by --rate HZ)"};
  }
  const bool is_possible = of_file_hz && *of_file_hz > 0.0 && *of_file_hz <= highest_rate_hz;
  if (of_file_hz && !is_possible && !(is_given && options.trusts_rate)) {
    throw core::InvalidInput{
        fmt::format("{}: {} {:.6g} samples a second (the right one: --rate HZ --trust-rate)", place,
                    stated, *of_file_hz)};
  }
  if (!of_file_hz || !is_given) {
    return of_file_hz.value_or(options.rate_hz);
  }
  if (std::abs(*of_file_hz / options.rate_hz - 1.0) > max_rate_difference) {
    if (!options.trusts_rate) {
      throw core::InvalidInput{
          fmt::format("{}: {} {:.6g} samples a second, --rate {:g} (which --trust-rate takes)",
                      place, stated, *of_file_hz, options.rate_hz)};
    }
    remarks.push_back(fmt::format("{} {:.6g} samples a second: {:g} were taken, by --trust-rate",
                                  stated, *of_file_hz, options.rate_hz));
  }
  return options.rate_hz;
}

void check_samples(const Recording& recording) {
  const std::vector<double>& samples = recording.samples;
  if (samples.size() < min_samples) {
    throw core::InvalidInput{fmt::format("{}: has {} samples (at least {})", recording.file,
                                         samples.size(), min_samples)};
  }
  const auto impossible = std::ranges::find_if(
      samples, [](double sample) { return !(std::abs(sample) <= largest_sample); });
  if (impossible != samples.end()) {
    throw core::InvalidInput{fmt::format("{}: sample {} of {} is {:g}, which is no measured value",
                                         recording.file, impossible - samples.begin() + 1,
                                         recording.channel, *impossible)};
  }
}

std::string whole_lines(std::string text, std::vector<std::string>& remarks) {
  const std::size_t last = text.rfind('\n');
  if (last == std::string::npos || core::trimmed(text.substr(last + 1)).empty()) {
    return text;
  }
  text.resize(last + 1);
  remarks.push_back(
      fmt::format("line {} is left out: it has no line end, so that its last number may be cut off",
                  std::ranges::count(text, '\n') + 1));
  return text;
}
}  // namespace tapstudy::analysis
