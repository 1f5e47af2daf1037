#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "analysis/modal/recording/sampling.hpp"
#include "analysis/statistics/csv_rows.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
constexpr int time_response = 1;
constexpr std::size_t header_records = 11;
constexpr const char* end_of_set = "-1";

std::vector<std::string> fields_of(const std::string& record) {
  std::istringstream stream{record};
  std::vector<std::string> fields;
  for (std::string field; stream >> field;) {
    std::ranges::replace(field, 'D', 'E');  // Fortran's double precision
    fields.push_back(field);
  }
  return fields;
}

struct BinaryLayout {
  bool is_big_endian{};
  std::size_t bytes{};
};

struct DataSet58 {
  int function_type{};
  std::string response;  // "12+Z"
  int value_type{};      // 2 and 4: real, single and double; 5 and 6: complex
  std::size_t values{};
  bool is_even{};
  double increment_s{};
  std::vector<double> samples;
};

template <class Float, class Bits>
double float_at(const char* bytes, bool is_big_endian) {
  static_assert(sizeof(Float) == sizeof(Bits));
  std::array<char, sizeof(Float)> ordered{};
  std::memcpy(ordered.data(), bytes, sizeof(Float));
  if (is_big_endian != (std::endian::native == std::endian::big)) {
    std::ranges::reverse(ordered);
  }
  return static_cast<double>(std::bit_cast<Float>(ordered));
}

class UniversalReader {
 public:
  explicit UniversalReader(const std::string& file) : file_{file} {
    std::ifstream stream{file, std::ios::binary};
    if (!stream) {
      throw core::InvalidInput{file + ": cannot be read"};
    }
    text_ = table_text(stream, file);
  }

  std::vector<DataSet58> data_sets() {
    std::vector<DataSet58> sets;
    while (const auto line = next_line()) {
      if (core::trimmed(*line) != end_of_set) {
        continue;
      }
      const std::string kind = next_line().value_or("");
      if (core::trimmed(kind) == "58") {
        sets.push_back(data_set(std::nullopt));
      } else if (core::trimmed(kind).starts_with("58b")) {
        sets.push_back(data_set(layout_of(kind)));
      }
      skip_to_end();
    }
    return sets;
  }

 private:
  [[noreturn]] void refuse_record(const std::string& what) const {
    throw core::InvalidInput{fmt::format("{}:{}: {}", file_, line_, what)};
  }

  std::optional<std::string> next_line() {
    if (at_ >= text_.size()) {
      return std::nullopt;
    }
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string line = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    return line;
  }

  void skip_to_end() {
    for (auto line = next_line(); line && core::trimmed(*line) != end_of_set;) {
      line = next_line();
    }
  }

  BinaryLayout layout_of(const std::string& kind) const {
    const std::vector<std::string> fields = fields_of(kind);
    const auto field = [&](std::size_t i) {
      return i < fields.size() ? core::number_in<int>(fields[i]).value_or(0) : 0;
    };
    if (field(1) < 1 || field(1) > 2 || field(2) != 2 || field(4) <= 0) {
      refuse_record(
          "a data set 58b must state its byte order (1 or 2), floating-point numbers of "
          "IEEE 754 (2) and its bytes");
    }
    return {field(1) == 2, static_cast<std::size_t>(field(4))};
  }

  template <class Number>
  Number field(const std::vector<std::string>& fields, std::size_t i, const char* what) const {
    const auto number = i < fields.size() ? core::number_in<Number>(fields[i]) : std::nullopt;
    if (!number) {
      refuse_record(
          fmt::format("has no {} in field {} of this record of a data set 58", what, i + 1));
    }
    return *number;
  }

  std::vector<std::string> record() {
    const auto line = next_line();
    if (!line) {
      refuse_record("the file is cut off within the records of a data set 58");
    }
    return fields_of(*line);
  }

  DataSet58 data_set(const std::optional<BinaryLayout>& layout) {
    constexpr std::size_t identifications = 5;
    for (std::size_t i = 0; i < identifications; ++i) {
      record();
    }
    DataSet58 set;
    const std::vector<std::string> function = record();
    set.function_type = field<int>(function, 0, "function type");
    set.response = response_of(function);
    const std::vector<std::string> form = record();
    set.value_type = field<int>(form, 0, "type of values");
    set.values = field<std::size_t>(form, 1, "number of values");
    set.is_even = field<int>(form, 2, "spacing") == 1;
    set.increment_s = field<double>(form, 4, "increment");
    for (std::size_t i = identifications + 2; i < header_records; ++i) {
      record();
    }
    if (set.function_type == time_response && set.is_even &&
        (set.value_type == 2 || set.value_type == 4)) {
      set.samples = layout ? binary_values(set, *layout) : values_in_text(set);
    } else if (layout) {
      at_ = std::min(text_.size(), at_ + layout->bytes);
    }
    return set;
  }

  static std::string response_of(const std::vector<std::string>& function) {
    constexpr std::size_t node = 5;
    constexpr std::size_t all_fields = 10;
    if (function.size() != all_fields) {
      return {};
    }
    const int direction = core::number_in<int>(function[node + 1]).value_or(0);
    const std::map<int, const char*> axes{{1, "+X"},  {2, "+Y"},  {3, "+Z"},
                                          {-1, "-X"}, {-2, "-Y"}, {-3, "-Z"}};
    const auto axis = axes.find(direction);
    return function[node] + (axis == axes.end() ? "" : axis->second);
  }

  std::vector<double> binary_values(const DataSet58& set, const BinaryLayout& layout) {
    const std::size_t size = set.value_type == 2 ? sizeof(float) : sizeof(double);
    const std::size_t left = text_.size() - std::min(at_, text_.size());
    if (set.values > layout.bytes / size || layout.bytes > left) {
      refuse_record(
          fmt::format("the file is cut off: {} values of {} bytes are stated", set.values, size));
    }
    std::vector<double> values;
    for (std::size_t i = 0; i < set.values; ++i) {
      const char* const bytes = text_.data() + at_ + i * size;
      values.push_back(set.value_type == 2
                           ? float_at<float, std::uint32_t>(bytes, layout.is_big_endian)
                           : float_at<double, std::uint64_t>(bytes, layout.is_big_endian));
    }
    at_ += layout.bytes;
    return values;
  }

  std::vector<double> values_in_text(const DataSet58& set) {
    std::vector<double> values;
    while (values.size() < set.values) {
      const auto line = next_line();
      if (!line || core::trimmed(*line) == end_of_set) {
        refuse_record(
            fmt::format("the data are cut off: {} of {} values", values.size(), set.values));
      }
      for (const std::string& value : fields_of(*line)) {
        const auto number =
            core::number_in<double>(std::string_view{value}.substr(value.starts_with('+') ? 1 : 0));
        if (!number) {
          refuse_record(fmt::format("'{}' is not a number", value));
        }
        values.push_back(*number);
      }
    }
    return values;
  }

  std::string file_;
  std::string text_;
  std::size_t at_{0};
  int line_{0};
};

std::string refusal_without_times(const std::string& file, const std::vector<DataSet58>& sets) {
  if (sets.empty()) {
    return file + ": holds no data set 58 (a universal file of time records)";
  }
  const DataSet58& first = sets.front();
  if (first.function_type == time_response) {
    return file +
           ": its time records are complex or unevenly spaced: real ones at even times are "
           "read";
  }
  return fmt::format(
      "{}: holds no time record (function type 1), but functions of type {}{}: identify takes the "
      "recordings themselves",
      file, first.function_type, first.function_type == 4 ? ", frequency responses" : "");
}

std::size_t chosen_record(const std::vector<DataSet58>& records, const std::string& column,
                          const std::string& file) {
  const auto named = std::ranges::find(records, column, &DataSet58::response);
  if (!column.empty() && named != records.end()) {
    return static_cast<std::size_t>(named - records.begin());
  }
  const auto number = core::number_in<std::size_t>(column);
  if (number && *number >= 1 && *number <= records.size()) {
    return *number - 1;
  }
  if (column.empty() && records.size() == 1) {
    return 0;
  }
  std::vector<std::string> names;
  std::ranges::transform(records, std::back_inserter(names), &DataSet58::response);
  throw core::InvalidInput{
      fmt::format("{}: has {} time records (choose one by --column 1 ... {}, "
                  "or by node and direction: {})",
                  file, records.size(), records.size(), fmt::join(names, ", "))};
}
}  // namespace

Recording read_universal_file(const std::string& file, const ReadingOptions& options) {
  std::vector<DataSet58> sets = UniversalReader{file}.data_sets();
  std::vector<DataSet58> records;
  std::ranges::copy_if(sets, std::back_inserter(records),
                       [](const DataSet58& set) { return !set.samples.empty(); });
  if (records.empty()) {
    throw core::InvalidInput{refusal_without_times(file, sets)};
  }
  const std::size_t chosen = chosen_record(records, options.column, file);
  const DataSet58& record = records[chosen];
  if (record.samples.size() < min_samples) {
    throw core::InvalidInput{
        fmt::format("{}: has {} samples (at least {})", file, record.samples.size(), min_samples)};
  }
  if (!std::ranges::all_of(record.samples, [](double sample) { return std::isfinite(sample); })) {
    throw core::InvalidInput{file + ": has values that are not finite"};
  }
  Recording recording{
      file,
      record.response.empty() ? fmt::format("record {}", chosen + 1) : record.response,
      0.0,
      record.samples,
      {}};
  const double rate_hz = record.increment_s > 0.0 ? 1.0 / record.increment_s : 0.0;
  recording.rate_hz = agreed_rate(rate_hz, options, file, "says", recording.remarks);
  return recording;
}
}  // namespace tapstudy::analysis
