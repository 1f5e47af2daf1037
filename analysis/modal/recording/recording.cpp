#include "analysis/modal/recording/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <utility>

#include "analysis/statistics/csv_rows.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double largest_value = 1e100;        // squares and their sums are finite
constexpr double max_rate_difference = 0.001;  // more is a mistake, not rounded times

[[noreturn]] void refuse(const std::string& file, int line, const std::string& what) {
  throw core::InvalidInput{fmt::format("{}:{}: {}", file, line, what)};
}

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// The micro sign, and the Greek letter mu.
std::string with_ascii_micro(const std::string& text) {
  std::string ascii;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_micro = text.compare(i, 2, "\u00b5") == 0 || text.compare(i, 2, "\u03bc") == 0;
    ascii += is_micro ? 'u' : text[i];
    i += is_micro ? 1 : 0;
  }
  return ascii;
}

// Seconds per unit of a time column's header: "t", "time", "Time (ms)", "time_us", "t [s]" ...;
// 0: the header is not that of a time.
double seconds_per_unit(const std::string& header) {
  std::string letters;
  for (const char c : lower_case(with_ascii_micro(header))) {
    const auto byte = static_cast<unsigned char>(c);
    letters += byte >= 0x80 || std::isalpha(byte) != 0 ? c : ' ';
  }
  std::istringstream stream{letters};
  std::string word;
  std::string unit;
  std::string rest;
  stream >> word >> unit >> rest;
  if ((word != "t" && word != "time") || !rest.empty()) {
    return 0.0;
  }
  if (unit.empty() || unit == "s" || unit == "sec" || unit == "seconds") {
    return 1.0;
  }
  return unit == "ms" ? 1e-3 : (unit == "us" ? 1e-6 : 0.0);
}

// Rows of numbers below an optional header.
class Table {
 public:
  Table(CsvText text, std::string file) : text_{std::move(text)}, file_{std::move(file)} {
    if (text_.rows.empty()) {
      refuse(file_, 1, "holds no values");
    }
    const CsvRow& first = text_.rows.front();
    if (std::ranges::none_of(
            first.cells, [&](const std::string& cell) { return text_.number(cell).has_value(); })) {
      headers_ = first.cells;
      first_row_ = 1;
    }
    columns_ = first.cells.size();
  }

  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return text_.rows.size() - first_row_; }
  bool has_headers() const { return !headers_.empty(); }
  const std::vector<std::string>& headers() const { return headers_; }
  const std::string& file() const { return file_; }
  int line(std::size_t row) const { return text_.rows[first_row_ + row].line; }
  int last_line() const { return text_.rows.back().line; }
  std::string title(std::size_t column) const {
    return has_headers() ? headers_[column] : fmt::format("column {}", column + 1);
  }

  std::vector<double> values(std::size_t column) const {
    std::vector<double> all;
    all.reserve(rows());
    for (std::size_t i = first_row_; i < text_.rows.size(); ++i) {
      const CsvRow& row = text_.rows[i];
      if (row.cells.size() != columns_) {
        refuse(file_, row.line,
               fmt::format("has {} cells, the first row {}", row.cells.size(), columns_));
      }
      const std::optional<double> value = text_.number(row.cells[column]);
      if (!value || !(std::abs(*value) <= largest_value)) {
        refuse(file_, row.line,
               fmt::format("'{}' is not a number up to {:g}", row.cells[column], largest_value));
      }
      all.push_back(*value);
    }
    return all;
  }

 private:
  CsvText text_;
  std::string file_;
  std::vector<std::string> headers_;
  std::size_t first_row_{0};
  std::size_t columns_{0};
};

struct TimeColumn {
  std::size_t index{};
  double seconds_per_unit{1.0};
};

std::optional<TimeColumn> time_column(const Table& table, const ReadingOptions& options) {
  for (std::size_t i = 0; i < table.headers().size(); ++i) {
    const double unit = seconds_per_unit(table.headers()[i]);
    if (unit > 0.0) {
      return TimeColumn{i, unit};
    }
  }
  if (table.has_headers() || options.rate_hz > 0.0 || table.columns() < 2) {
    return std::nullopt;
  }
  const std::vector<double> first = table.values(0);
  const bool ascends = std::ranges::adjacent_find(first, std::greater_equal{}) == first.end();
  return ascends ? std::optional{TimeColumn{0, 1.0}} : std::nullopt;
}

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

double rate_from_times(const Table& table, const TimeColumn& column) {
  const std::vector<double> times = table.values(column.index);
  const std::pair<double, double> grid = uniform_grid(times);
  const double start = grid.first;
  const double period = grid.second;
  if (!(period > 0.0)) {
    refuse(table.file(), table.last_line(), "times must ascend");
  }
  double furthest = 0.0;
  std::size_t worst_step = 1;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double expected = start + period * static_cast<double>(i);
    furthest = std::max(furthest, std::abs(times[i] - expected) / period);
    const auto misfit = [&](std::size_t k) { return std::abs(times[k] - times[k - 1] - period); };
    worst_step = misfit(i) > misfit(worst_step) ? i : worst_step;
  }
  if (furthest > max_jitter_periods) {
    refuse(table.file(), table.line(worst_step),
           fmt::format("times are up to {:.2g} periods from a uniform grid (at most {}); here the "
                       "step is {:.3g} periods: samples are missing or were not taken uniformly",
                       furthest, max_jitter_periods,
                       (times[worst_step] - times[worst_step - 1]) / period));
  }
  return 1.0 / (period * column.seconds_per_unit);
}

// The column with this header or, failing that, this number from 1.
std::size_t named_column(const Table& table, const std::string& column) {
  const auto found = std::ranges::find(table.headers(), column);
  if (found != table.headers().end()) {
    return static_cast<std::size_t>(found - table.headers().begin());
  }
  const auto number = core::number_in<std::size_t>(column);
  if (number && *number >= 1 && *number <= table.columns()) {
    return *number - 1;
  }
  refuse(table.file(), 1,
         fmt::format("--column '{}' is none of its columns ({})", column,
                     table.has_headers() ? fmt::format("{}", fmt::join(table.headers(), ", "))
                                         : fmt::format("1 to {}", table.columns())));
}

std::size_t data_column(const Table& table, const ReadingOptions& options,
                        const std::optional<TimeColumn>& time) {
  if (!options.column.empty()) {
    const std::size_t chosen = named_column(table, options.column);
    if (time && chosen == time->index) {
      refuse(table.file(), 1, fmt::format("--column '{}' is the time", options.column));
    }
    return chosen;
  }
  const std::size_t channels = table.columns() - (time ? 1 : 0);
  if (channels != 1) {
    refuse(table.file(), 1,
           fmt::format("has {} channels (choose one by --column: {})", channels,
                       table.has_headers() ? fmt::format("{}", fmt::join(table.headers(), ", "))
                                           : fmt::format("1 to {}", table.columns())));
  }
  return time && time->index == 0 ? 1 : 0;
}

double rate_of(const Table& table, const ReadingOptions& options,
               const std::optional<TimeColumn>& time) {
  if (!time && !(options.rate_hz > 0.0)) {
    refuse(table.file(), 1, "has no time column (give the rate by --rate HZ)");
  }
  if (!time) {
    return options.rate_hz;
  }
  const double rate_hz = rate_from_times(table, *time);
  if (options.rate_hz > 0.0 && std::abs(rate_hz / options.rate_hz - 1.0) > max_rate_difference) {
    refuse(table.file(), table.last_line(),
           fmt::format("its times say {:.6g} samples a second, --rate {:g}", rate_hz,
                       options.rate_hz));
  }
  return options.rate_hz > 0.0 ? options.rate_hz : rate_hz;
}
}  // namespace

Recording read_csv_recording(std::istream& text, const std::string& file,
                             const ReadingOptions& options) {
  const Table table{read_csv(text, file), file};
  if (table.rows() < min_samples) {
    refuse(file, table.last_line(),
           fmt::format("has {} samples (at least {})", table.rows(), min_samples));
  }
  const std::optional<TimeColumn> time = time_column(table, options);
  const std::size_t column = data_column(table, options, time);
  return {file, table.title(column), rate_of(table, options, time), table.values(column), {}};
}

namespace {
constexpr std::array<std::pair<const char*, Quantity>, 3> quantities{
    {{"acceleration", Quantity::acceleration},
     {"velocity", Quantity::velocity},
     {"displacement", Quantity::displacement}}};

std::string lower_case_ending(const std::string& file) {
  std::string ending = std::filesystem::path{file}.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}
}  // namespace

Quantity quantity_from(const std::string& word) {
  for (const auto& [text, quantity] : quantities) {
    if (word == text) {
      return quantity;
    }
  }
  throw core::InvalidInput{
      fmt::format("'{}' is not a quantity (acceleration, velocity or displacement)", word)};
}

const char* name(Quantity quantity) {
  return std::ranges::find(quantities, quantity, &std::pair<const char*, Quantity>::second)->first;
}

Recording read_recording(const std::string& file, const ReadingOptions& options) {
  const std::string ending = lower_case_ending(file);
  if (ending != ".csv" && ending != ".txt" && ending != ".tsv") {
    return read_sound_file(file, options);
  }
  std::ifstream text{file};
  if (!text) {
    throw core::InvalidInput{file + ": cannot be read"};
  }
  return read_csv_recording(text, file, options);
}
}  // namespace tapstudy::analysis
