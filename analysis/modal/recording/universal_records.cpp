#include "analysis/modal/recording/universal_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "analysis/statistics/csv_rows.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::size_t header_records = 11;
constexpr const char* end_of_set = "-1";
constexpr std::size_t max_universal_values = 100'000'000;

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
      const int begins = line_;
      if (core::trimmed(kind) == "58") {
        sets.push_back(data_set(std::nullopt));
      } else if (core::trimmed(kind).starts_with("58b")) {
        sets.push_back(data_set(layout_of(kind)));
      }
      skip_to_end(begins);
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

  void skip_to_end(int begins) {
    while (const auto line = next_line()) {
      if (core::trimmed(*line) == end_of_set) {
        return;
      }
    }
    refuse_record(
        fmt::format("the file is cut off: the data set that begins in line {} has no end "
                    "(-1)",
                    begins));
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
    DataSet58 set;
    set.line = line_;
    for (std::size_t i = 0; i < identifications; ++i) {
      record();
    }
    read_function(set);
    const std::vector<std::string> form = record();
    set.value_type = field<int>(form, 0, "type of values");
    set.values = field<std::size_t>(form, 1, "number of values");
    if (set.values > max_universal_values) {
      refuse_record(fmt::format("states {} values (at most {})", set.values, max_universal_values));
    }
    set.is_even = field<int>(form, 2, "spacing") == 1;
    set.first = field<double>(form, 3, "first abscissa");
    set.increment = field<double>(form, 4, "increment");
    record();  // the abscissa's type and unit
    const std::string ordinate = next_line().value_or("");
    set.numerator = quantity_of(fields_of(ordinate));
    set.unit = units_label(ordinate);
    set.denominator = quantity_of(record());
    for (std::size_t i = identifications + 5; i < header_records; ++i) {
      record();
    }
    read_values(set, layout);
    return set;
  }

  void read_values(DataSet58& set, const std::optional<BinaryLayout>& layout) {
    const bool is_complex = set.value_type == 5 || set.value_type == 6;
    const bool is_real = set.value_type == 2 || set.value_type == 4;
    const bool is_wanted = (set.function_type == time_response && is_real) ||
                           (set.function_type == frequency_response && is_complex);
    if (!set.is_even || !is_wanted) {
      at_ = layout ? std::min(text_.size(), at_ + layout->bytes) : at_;
      return;
    }
    const std::size_t count = is_complex ? 2 * set.values : set.values;
    std::vector<double> values =
        layout ? binary_values(set, count, *layout) : values_in_text(count);
    if (is_real) {
      set.samples = std::move(values);
      return;
    }
    for (std::size_t i = 0; i < set.values; ++i) {
      set.complex_samples.emplace_back(values[2 * i], values[2 * i + 1]);
    }
  }

  // Of an axis: the last of fields of fixed width or, as some programs write it, of six words.
  static std::string units_label(const std::string& axis) {
    constexpr std::size_t begins = 47;
    constexpr std::size_t width = 20;
    if (axis.size() > begins) {
      return core::trimmed(axis.substr(begins, width));
    }
    constexpr std::size_t all_words = 6;
    const std::vector<std::string> words = fields_of(axis);
    return words.size() == all_words ? words.back() : std::string{};
  }

  static int quantity_of(const std::vector<std::string>& fields) {
    return fields.empty() ? 0 : core::number_in<int>(fields.front()).value_or(0);
  }

  // The record of the function's type and places: fields of fixed width, some of which may be
  // blank, or, as some programs write it, ten words.
  void read_function(DataSet58& set) {
    const std::string text = next_line().value_or("");
    const std::vector<std::string> words = fields_of(text);
    set.function_type = field<int>(words, 0, "function type");
    constexpr std::size_t all_words = 10;
    if (words.size() == all_words) {
      set.response = place_of(words[5], words[6]);
      set.reference = place_of(words[8], words[9]);
      return;
    }
    const auto columns = [&](std::size_t from, std::size_t count) {
      return from < text.size() ? core::trimmed(text.substr(from, count)) : std::string{};
    };
    set.response = place_of(columns(41, 10), columns(51, 4));
    set.reference = place_of(columns(66, 10), columns(76, 4));
  }

  // Empty where no node is stated.
  static std::string place_of(const std::string& node, const std::string& direction) {
    const std::map<std::string, const char*> axes{{"1", "+X"},  {"2", "+Y"},  {"3", "+Z"},
                                                  {"-1", "-X"}, {"-2", "-Y"}, {"-3", "-Z"}};
    if (!core::number_in<int>(node)) {
      return {};
    }
    const auto axis = axes.find(direction);
    return node + (axis == axes.end() ? "" : axis->second);
  }

  std::vector<double> binary_values(const DataSet58& set, std::size_t count,
                                    const BinaryLayout& layout) {
    const bool is_single = set.value_type == 2 || set.value_type == 5;
    const std::size_t size = is_single ? sizeof(float) : sizeof(double);
    const std::size_t left = text_.size() - std::min(at_, text_.size());
    if (count > layout.bytes / size || layout.bytes > left) {
      refuse_record(
          fmt::format("the file is cut off: {} values of {} bytes are stated", count, size));
    }
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) {
      const char* const bytes = text_.data() + at_ + i * size;
      values.push_back(is_single ? float_at<float, std::uint32_t>(bytes, layout.is_big_endian)
                                 : float_at<double, std::uint64_t>(bytes, layout.is_big_endian));
    }
    at_ += layout.bytes;
    return values;
  }

  std::vector<double> values_in_text(std::size_t count) {
    std::vector<double> values;
    while (values.size() < count) {
      const auto line = next_line();
      if (!line || core::trimmed(*line) == end_of_set) {
        refuse_record(fmt::format("the data are cut off: {} of {} values", values.size(), count));
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

}  // namespace

std::vector<DataSet58> read_data_sets_58(const std::string& file) {
  return UniversalReader{file}.data_sets();
}
}  // namespace tapstudy::analysis
