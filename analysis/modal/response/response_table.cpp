#include "analysis/modal/response/response_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "analysis/modal/recording/sampling.hpp"
#include "analysis/statistics/csv_rows.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
constexpr const char* frequency_header = "frequency_hz";

enum class Part { real, imaginary, magnitude, phase };
struct PartName {
  const char* ending;
  Part part;
};
constexpr std::array<PartName, 4> part_names{{{"real", Part::real},
                                              {"imag", Part::imaginary},
                                              {"magnitude", Part::magnitude},
                                              {"phase_deg", Part::phase}}};

struct Column {
  std::string response;  // "12+Z/1+Z"
  Part part{};
  std::vector<double> values;
};

[[noreturn]] void refuse_table(const std::string& file, int line, const std::string& what) {
  throw core::InvalidInput{fmt::format("{}:{}: {}", file, line, what)};
}

// The name and the part that a header states: "12+Z real", "12+Z_real".
std::optional<Column> column_of(const std::string& header) {
  for (const PartName& name : part_names) {
    const std::string ending{name.ending};
    if (header.size() > ending.size() + 1 && header.ends_with(ending)) {
      const std::size_t at = header.size() - ending.size() - 1;
      if (header[at] == ' ' || header[at] == '_') {
        return Column{core::trimmed(header.substr(0, at)), name.part, {}};
      }
    }
  }
  return std::nullopt;
}

class ResponseTable {
 public:
  ResponseTable(const std::string& file, std::vector<std::string>& remarks) : file_{file} {
    std::ifstream stream{file};
    if (!stream) {
      throw core::InvalidInput{file + ": cannot be read"};
    }
    std::vector<std::string> of_text;
    std::istringstream whole{whole_lines(table_text(stream, file), of_text)};
    for (const std::string& remark : of_text) {
      remarks.push_back(file + ": " + remark);
    }
    text_ = read_csv(whole, file);
    if (text_.rows.size() < 2) {
      refuse_table(file_, 1, "holds no values");
    }
    for (const std::string& header : text_.rows.front().cells) {
      read_header(header);
    }
    read_cells();
  }

  std::vector<ReadResponse> responses() const {
    std::vector<ReadResponse> all;
    for (const Column& column : columns_) {
      if (column.part == Part::real || column.part == Part::magnitude) {
        all.push_back(response(column, partner(column)));
      } else {
        partner(column);
      }
    }
    if (all.empty()) {
      refuse_table(file_, 1, "has no response beside frequency_hz");
    }
    refuse_radians();
    return all;
  }

 private:
  void read_header(const std::string& header) {
    if (header == frequency_header) {
      columns_.push_back({frequency_header, Part::real, {}});
      frequency_ = columns_.size() - 1;
      return;
    }
    const auto column = column_of(header);
    if (!column) {
      refuse_table(file_, 1,
                   fmt::format("'{}' is no header of a response: a name, then real and imag, or "
                               "magnitude and phase_deg",
                               header));
    }
    for (const Column& other : columns_) {
      if (other.response == column->response && other.part == column->part) {
        refuse_table(file_, 1, fmt::format("'{}' is there twice", header));
      }
    }
    columns_.push_back(*column);
  }

  void read_cells() {
    for (std::size_t row = 1; row < text_.rows.size(); ++row) {
      const CsvRow& cells = text_.rows[row];
      if (cells.cells.size() != columns_.size()) {
        refuse_table(
            file_, cells.line,
            fmt::format("has {} cells, the header {}", cells.cells.size(), columns_.size()));
      }
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        const auto number = text_.number(cells.cells[i]);
        if (!number || !std::isfinite(*number)) {
          refuse_table(file_, cells.line, fmt::format("'{}' is not a number", cells.cells[i]));
        }
        if (columns_[i].part == Part::magnitude && *number < 0.0) {
          refuse_table(
              file_, cells.line,
              fmt::format("a magnitude is not below 0, as {} is (decibels are converted to "
                          "magnitudes first: 10^(dB/20))",
                          cells.cells[i]));
        }
        columns_[i].values.push_back(*number);
      }
    }
    frequencies_ = columns_[frequency_].values;
    columns_.erase(columns_.begin() + static_cast<std::ptrdiff_t>(frequency_));
  }

  // Across a resonance the phase turns by 180 degrees.
  void refuse_radians() const {
    constexpr double most = 3.15;  // a little above pi
    for (const Column& column : columns_) {
      const auto [least, greatest] = std::ranges::minmax(column.values);
      if (column.part == Part::phase && -most <= least && greatest <= most && least < greatest) {
        refuse_table(file_, 1,
                     fmt::format("all of '{} phase_deg' is within {} degrees, as radians would be",
                                 column.response, most));
      }
    }
  }

  static Part other_part(Part part) {
    switch (part) {
      case Part::real:
        return Part::imaginary;
      case Part::imaginary:
        return Part::real;
      case Part::magnitude:
        return Part::phase;
      case Part::phase:
        break;
    }
    return Part::magnitude;
  }

  const Column& partner(const Column& column) const {
    const auto found = std::ranges::find_if(columns_, [&](const Column& other) {
      return other.response == column.response && other.part == other_part(column.part);
    });
    if (found == columns_.end()) {
      const auto* const missing =
          std::ranges::find(part_names, other_part(column.part), &PartName::part);
      refuse_table(file_, 1,
                   fmt::format("has no column '{} {}'", column.response, missing->ending));
    }
    return *found;
  }

  ReadResponse response(const Column& first, const Column& second) const {
    ReadResponse read;
    read.place = file_;
    const std::size_t slash = first.response.find('/');
    read.pair.response = first.response.substr(0, slash);
    read.pair.reference = slash == std::string::npos ? "" : first.response.substr(slash + 1);
    const auto count = std::ssize(frequencies_);
    read.frequency_hz = Eigen::Map<const Eigen::ArrayXd>(frequencies_.data(), count);
    read.values.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      read.values[i] =
          first.part == Part::magnitude
              ? first.values[at] * std::exp(std::complex<double>{
                                       0.0, second.values[at] * std::numbers::pi / 180.0})
              : std::complex<double>{first.values[at], second.values[at]};
    }
    return read;
  }

  std::string file_;
  CsvText text_;
  std::vector<Column> columns_;
  std::size_t frequency_{0};
  std::vector<double> frequencies_;
};
}  // namespace

bool is_table_of_responses(const std::string& file) {
  std::ifstream stream{file};
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with('#') || core::trimmed(line).empty()) {
      continue;
    }
    const std::size_t at = line.find(frequency_header);
    return at != std::string::npos && at <= 4;  // after a byte order mark or a quote
  }
  return false;
}

std::vector<ReadResponse> responses_of_table(const std::string& file,
                                             std::vector<std::string>& remarks) {
  return ResponseTable{file, remarks}.responses();
}
}  // namespace tapstudy::analysis
