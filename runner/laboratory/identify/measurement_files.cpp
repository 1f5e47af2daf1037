#include "runner/laboratory/identify/measurement_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <fstream>
#include <numeric>

#include "analysis/statistics/csv_rows.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::runner {
namespace {
constexpr double max_speed_m_s = 100.0;
constexpr double max_distance_m = 10.0;

class MeasurementTable {
 public:
  explicit MeasurementTable(const std::string& file) : file_{file} {
    std::ifstream text{file};
    if (!text) {
      throw core::InvalidInput{file + ": cannot be read"};
    }
    text_ = analysis::read_csv(text, file);
  }

  // of_number: whether a number can be one of this column's; what: how it is called.
  template <class OfNumber>
  std::vector<double> column(const std::string& name, OfNumber of_number,
                             const std::string& what) const {
    const std::size_t place = place_of(name);
    std::vector<double> values;
    for (std::size_t i = 1; i < text_.rows.size(); ++i) {
      const auto& cells = text_.rows[i].cells;
      const auto value = place < cells.size() ? text_.number(cells[place]) : std::nullopt;
      if (!value || !of_number(*value)) {
        throw core::InvalidInput{fmt::format("{}:{}: '{}' is not {}", file_, text_.rows[i].line,
                                             place < cells.size() ? cells[place] : "", what)};
      }
      values.push_back(*value);
    }
    return values;
  }

  std::vector<std::string> texts(const std::string& name) const {
    const std::size_t place = place_of(name);
    std::vector<std::string> texts;
    for (std::size_t i = 1; i < text_.rows.size(); ++i) {
      const auto& cells = text_.rows[i].cells;
      texts.push_back(place < cells.size() ? core::trimmed(cells[place]) : std::string{});
    }
    return texts;
  }

 private:
  std::size_t place_of(const std::string& name) const {
    if (!text_.rows.empty()) {
      const auto& header = text_.rows.front().cells;
      const auto found = std::ranges::find(header, name);
      if (found != header.end()) {
        return static_cast<std::size_t>(found - header.begin());
      }
    }
    throw core::InvalidInput{fmt::format("{}:1: has no column {}", file_, name)};
  }

  std::string file_;
  analysis::CsvText text_;
};
}  // namespace

std::vector<double> read_speeds(const std::string& file) {
  return MeasurementTable{file}.column(
      "speed_m_s", [](double value) { return value > 0.0 && value < max_speed_m_s; },
      fmt::format("a speed (above 0, below {} m/s)", max_speed_m_s));
}

namespace {
std::vector<Eigen::Vector2d> coordinates_of(const MeasurementTable& table) {
  const auto is_near = [](double value) { return std::abs(value) <= max_distance_m; };
  const std::string what = fmt::format("a coordinate (within {} m)", max_distance_m);
  const std::vector<double> x_m = table.column("x_m", is_near, what);
  const std::vector<double> y_m = table.column("y_m", is_near, what);
  std::vector<Eigen::Vector2d> places_m;
  for (std::size_t i = 0; i < x_m.size(); ++i) {
    places_m.emplace_back(x_m[i], y_m[i]);
  }
  return places_m;
}
}  // namespace

std::vector<Eigen::Vector2d> read_places(const std::string& file) {
  return coordinates_of(MeasurementTable{file});
}

std::vector<NamedPlace> read_named_places(const std::string& file) {
  const MeasurementTable table{file};
  const std::vector<std::string> names = table.texts("place");
  const std::vector<Eigen::Vector2d> places_m = coordinates_of(table);
  std::vector<NamedPlace> places;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::ranges::find(places, names[i], &NamedPlace::name) != places.end()) {
      throw core::InvalidInput{fmt::format("{}: the place '{}' is there twice", file, names[i])};
    }
    places.push_back({names[i], places_m[i]});
  }
  return places;
}

namespace {
analysis::Recording read_column(const std::string& file, const TapQuestion& question,
                                const std::string& column) {
  analysis::ReadingOptions options = question.reading;
  options.column = column;
  return analysis::read_recording(file, options);
}

double largest(const analysis::Recording& recording) {
  const auto [low, high] = std::ranges::minmax(recording.samples);
  return std::max(std::abs(low), std::abs(high));
}

// A column may be named by its header or by its number.
void check_named_once(const MeasuredFile& measured) {
  std::vector<std::string> names;
  std::ranges::transform(measured.channels, std::back_inserter(names),
                         &analysis::Recording::channel);
  if (measured.force) {
    names.push_back(measured.force->channel);
  }
  std::ranges::sort(names);
  if (const auto twice = std::ranges::adjacent_find(names); twice != names.end()) {
    throw core::InvalidInput{fmt::format("--column, --force-column: '{}' is named twice", *twice)};
  }
}
}  // namespace

MeasuredFile read_measured_file(const std::string& file, const TapQuestion& question) {
  MeasuredFile measured;
  for (const std::string& column :
       question.columns.empty() ? std::vector<std::string>{""} : question.columns) {
    measured.channels.push_back(read_column(file, question, column));
  }
  if (!question.force_column.empty()) {
    measured.force = read_column(file, question, question.force_column);
    measured.force_rails = analysis::rail_samples(measured.force->samples,
                                                  analysis::resting(*measured.force).noise_rms);
  }
  check_named_once(measured);
  return measured;
}

namespace {
std::vector<analysis::Impact> strikes_in(const analysis::Recording& force) {
  try {
    return analysis::force_impacts(force);
  } catch (const core::InvalidInput& error) {
    throw core::InvalidInput{fmt::format("{} (the force, {})", error.what(), force.channel)};
  }
}
}  // namespace

analysis::FoundTaps find_taps(const MeasuredFile& measured, const analysis::TapFinding& finding) {
  const auto struck = measured.force ? std::optional{strikes_in(*measured.force)} : std::nullopt;
  std::optional<analysis::FoundTaps> clearest;
  double most = 0.0;
  std::exception_ptr none;
  for (const analysis::Recording& channel : measured.channels) {
    try {
      analysis::FoundTaps found = struck ? analysis::taps_at(*struck, channel, finding)
                                         : analysis::find_taps(channel, finding);
      const double over_noise =
          found.noise_rms > 0.0 ? largest(channel) / found.noise_rms : 0.0;  // a dead sensor
      if (!clearest || over_noise > most) {
        most = over_noise;
        clearest = std::move(found);
      }
    } catch (const core::InvalidInput&) {
      none = std::current_exception();
    }
  }
  if (!clearest) {
    std::rethrow_exception(none);
  }
  return *clearest;
}

namespace {
// [first, last) of the samples in which the force is above a share of its largest, which lies
// within a window.
struct Pulse {
  std::size_t first{};
  std::size_t last{};
  double resting_n{};
};
Pulse pulse_in(const analysis::Recording& force, std::size_t begin, std::size_t end) {
  constexpr double least_share = 0.02;
  constexpr double resting_s = 0.02;
  const auto rest = begin - std::min(begin, static_cast<std::size_t>(resting_s * force.rate_hz));
  const auto at = [&](std::size_t place) {
    return force.samples.begin() + static_cast<std::ptrdiff_t>(place);
  };
  const double resting_n =
      begin == rest ? 0.0
                    : std::accumulate(at(rest), at(begin), 0.0) / static_cast<double>(begin - rest);
  const auto away_n = [&](std::size_t i) { return std::abs(force.samples[i] - resting_n); };
  std::size_t peak = begin;
  for (std::size_t i = begin; i < end; ++i) {
    peak = away_n(i) > away_n(peak) ? i : peak;
  }
  const double least_n = least_share * away_n(peak);
  Pulse pulse{peak, peak, resting_n};
  while (pulse.first > 0 && away_n(pulse.first) > least_n) {
    --pulse.first;
  }
  while (pulse.last < force.samples.size() && away_n(pulse.last) > least_n) {
    ++pulse.last;
  }
  return pulse;
}
}  // namespace

ImpactForce impact_force(const MeasuredFile& measured, const analysis::Tap& tap) {
  const analysis::Recording& force = *measured.force;
  constexpr double near_s = 0.01;
  const auto reach = static_cast<std::size_t>(near_s * force.rate_hz);
  const Pulse pulse = pulse_in(force, tap.onset - std::min(tap.onset, reach),
                               std::min(force.samples.size(), tap.begin + reach));
  double sum_n = 0.0;
  double moment = 0.0;
  for (std::size_t i = pulse.first; i < pulse.last; ++i) {
    const double above_n = force.samples[i] - pulse.resting_n;
    sum_n += above_n;
    moment += above_n * static_cast<double>(i);
  }
  if (!(std::abs(sum_n) > 0.0)) {
    throw core::InvalidInput{fmt::format("{}, {}: shows no force at the tap at {:.3f} s",
                                         force.file, force.channel,
                                         static_cast<double>(tap.onset) / force.rate_hz)};
  }
  return {std::abs(sum_n) / force.rate_hz, moment / sum_n / force.rate_hz,
          std::ranges::any_of(measured.force_rails,
                              [&](std::size_t i) { return pulse.first <= i && i < pulse.last; })};
}
}  // namespace tapstudy::runner
