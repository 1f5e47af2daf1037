#include "analysis/modal/recording/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>

#include "analysis/modal/recording/instrument_table.hpp"
#include "analysis/modal/recording/sampling.hpp"
#include "analysis/statistics/csv_rows.hpp"
#include "analysis/statistics/text_encoding.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
[[noreturn]] void refuse(const std::string& file, int line, const std::string& what) {
  throw core::InvalidInput{fmt::format("{}:{}: {}", file, line, what)};
}

// What to do about a cell that is no number.
const char* advice_on(const std::string& cell) {
  const std::string digits = "0123456789";
  const auto is_date_at = [&](std::size_t at) {
    return at > 0 && at + 1 < cell.size() && digits.find(cell[at - 1]) != std::string::npos &&
           digits.find(cell[at + 1]) != std::string::npos;
  };
  if (is_date_at(cell.find(':')) || is_date_at(cell.find('-')) || is_date_at(cell.find('/'))) {
    return ": of dates and times of day nothing is read (give the rate by --rate HZ, and the "
           "values' column by --column)";
  }
  if (cell.empty() || cell == "nan" || cell == "NaN" || cell == "NAN" || cell == "-nan") {
    return ": a sample is missing there (keep the part of the recording that has them all)";
  }
  return ": is this a table of one row a sample? Of an oscilloscope's file keep the columns of "
         "time "
         "and value alone";
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

  // Dates are none.
  bool begins_with_number(std::size_t column) const {
    const auto& cells = text_.rows[first_row_].cells;
    return column < cells.size() && text_.number(cells[column]).has_value();
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
      if (!value || !(std::abs(*value) <= largest_sample)) {
        refuse(file_, row.line,
               fmt::format("'{}' is not a number up to {:g}{}", row.cells[column], largest_sample,
                           advice_on(row.cells[column])));
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
  TimeUnit unit{1.0, false};
};

std::optional<TimeColumn> time_column(const Table& table, const ReadingOptions& options) {
  for (std::size_t i = 0; i < table.headers().size(); ++i) {
    const TimeUnit unit = time_unit_of(table.headers()[i]);
    const bool is_replaced = options.rate_hz > 0.0 && !table.begins_with_number(i);
    if (unit.seconds > 0.0 && !is_replaced) {
      return TimeColumn{i, unit};
    }
  }
  if (table.has_headers() || options.rate_hz > 0.0 || table.columns() < 2) {
    return std::nullopt;
  }
  const std::vector<double> first = table.values(0);
  const bool ascends = std::ranges::adjacent_find(first, std::greater_equal{}) == first.end();
  return ascends ? std::optional{TimeColumn{0}} : std::nullopt;
}

std::optional<double> rate_from_times(const Table& table, const TimeColumn& column,
                                      const ReadingOptions& options,
                                      std::vector<std::string>& remarks) {
  const auto place = [&](std::size_t row) {
    return fmt::format("{}:{}", table.file(), table.line(row));
  };
  return rate_of_times(table.values(column.index), column.unit, options, place, remarks);
}

// Those that may hold measured values: times are left out, unless nothing else is there.
std::vector<std::size_t> columns_of_values(const Table& table,
                                           const std::optional<TimeColumn>& time) {
  std::vector<std::size_t> others;
  std::vector<std::size_t> values;
  for (std::size_t i = 0; i < table.columns(); ++i) {
    if (time && i == time->index) {
      continue;
    }
    others.push_back(i);
    if (!table.has_headers() || time_unit_of(table.headers()[i]).seconds == 0.0) {
      values.push_back(i);
    }
  }
  return values.empty() ? others : values;
}

// "acc, force"; without headers "2 to 4".
std::string names_of(const std::vector<std::size_t>& columns, const Table& table) {
  if (columns.empty()) {
    return "no column";
  }
  if (!table.has_headers()) {
    return fmt::format("{} to {}", columns.front() + 1, columns.back() + 1);
  }
  std::vector<std::string> names;
  std::ranges::transform(columns, std::back_inserter(names),
                         [&](std::size_t i) { return table.title(i); });
  return fmt::format("{}", fmt::join(names, ", "));
}

// The column with this header or, failing that, this number from 1.
std::size_t named_column(const Table& table, const std::string& column,
                         const std::optional<TimeColumn>& time) {
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
                     names_of(columns_of_values(table, time), table)));
}

std::size_t data_column(const Table& table, const ReadingOptions& options,
                        const std::optional<TimeColumn>& time) {
  if (!options.column.empty()) {
    const std::size_t chosen = named_column(table, options.column, time);
    if (time && chosen == time->index) {
      refuse(table.file(), 1, fmt::format("--column '{}' is the time", options.column));
    }
    return chosen;
  }
  const std::vector<std::size_t> channels = columns_of_values(table, time);
  if (channels.size() != 1) {
    refuse(table.file(), 1,
           fmt::format("has {} channels (choose one by --column: {})", channels.size(),
                       names_of(channels, table)));
  }
  return channels.front();
}

// Only names and units have letters beyond ASCII.
std::string utf8_text(std::istream& stream, const std::string& file,
                      std::vector<std::string>& remarks) {
  std::string bytes = table_text(stream, file);
  if (is_utf8(bytes)) {
    return bytes;
  }
  const std::string encoding = likely_encoding(bytes);
  const auto text = converted_to_utf8(bytes, encoding);
  if (!text) {
    throw core::InvalidInput{
        fmt::format("{}: is not text in UTF-8 nor {} (save it as UTF-8)", file, encoding)};
  }
  remarks.push_back(
      fmt::format("its text is not UTF-8: it was read as {}, which concerns names "
                  "and units alone",
                  encoding));
  return *text;
}

}  // namespace

Recording read_csv_recording(std::istream& text, const std::string& file,
                             const ReadingOptions& options) {
  std::vector<std::string> remarks;
  const PlainTable plain =
      plain_table(whole_lines(first_segment(utf8_text(text, file, remarks), remarks), remarks));
  std::istringstream rows{plain.text};
  const Table table{read_csv(rows, file), file};
  if (table.rows() < min_samples) {
    refuse(file, table.last_line(),
           fmt::format("has {} samples (at least {})", table.rows(), min_samples));
  }
  const std::optional<TimeColumn> time = time_column(table, options);
  const std::size_t column = data_column(table, options, time);
  const auto of_times_hz = time ? rate_from_times(table, *time, options, remarks) : std::nullopt;
  Recording recording{file, table.title(column), 0.0, table.values(column), std::move(remarks)};
  recording.unit = column < plain.units.size() ? plain.units[column] : "";
  recording.rate_hz =
      agreed_rate(of_times_hz, options, fmt::format("{}:{}", file, time ? table.last_line() : 1),
                  "its times say", recording.remarks);
  return recording;
}

namespace {
constexpr std::array<std::pair<const char*, Quantity>, 3> quantities{
    {{"acceleration", Quantity::acceleration},
     {"velocity", Quantity::velocity},
     {"displacement", Quantity::displacement}}};

std::string lower_case_ending(const std::string& file) {
  return core::lower_case(std::filesystem::path{file}.extension().string());
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

namespace {
// One sentence on what has to be converted first; empty: it may be sound.
std::string advice_on_format(const std::string& ending) {
  if (ending == ".tdms") {
    return "LabVIEW's TDMS is not read: save it as text (.lvm) or MATLAB file, or convert it, in "
           "Python by npTDMS, to CSV";
  }
  if (ending == ".npy" || ending == ".npz") {
    return "arrays of numpy are not read: save them as a table (numpy.savetxt) or MATLAB file "
           "(scipy.io.savemat)";
  }
  return {};
}
}  // namespace

Recording read_recording(const std::string& file, const ReadingOptions& options) {
  const std::string ending = lower_case_ending(file);
  if (ending == ".mat") {
    return read_matlab_file(file, options);
  }
  constexpr std::array hdf5{".h5", ".hdf5", ".hdf", ".he5", ".nc"};
  if (std::ranges::find(hdf5, ending) != hdf5.end()) {
    return read_hdf5_file(file, options);
  }
  if (ending == ".uff" || ending == ".unv" || ending == ".uf") {
    return read_universal_file(file, options);
  }
  if (const std::string advice = advice_on_format(ending); !advice.empty()) {
    throw core::InvalidInput{file + ": " + advice};
  }
  constexpr std::array tables{".csv", ".txt", ".tsv", ".dat", ".asc", ".lvm"};
  if (std::ranges::find(tables, ending) == tables.end()) {
    return read_sound_file(file, options);
  }
  std::ifstream text{file};
  if (!text) {
    throw core::InvalidInput{file + ": cannot be read"};
  }
  return read_csv_recording(text, file, options);
}
}  // namespace tapstudy::analysis
