#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
#include "protocols/surface/surface_soup.hpp"
#include "protocols/yaml/problems.hpp"
namespace tapstudy::protocols {
namespace {
enum class Encoding { ascii, little_endian, big_endian };

// The format's types, with both of their names.
struct Type {
  std::string_view name;
  std::string_view other_name;
  std::size_t bytes;
  double (*value)(const char* bytes);
};
template <class Number>
double value_of(const char* bytes) {
  Number number{};
  std::memcpy(&number, bytes, sizeof number);
  return static_cast<double>(number);
}
constexpr std::array<Type, 8> types{
    Type{"char", "int8", 1, value_of<std::int8_t>},
    Type{"uchar", "uint8", 1, value_of<std::uint8_t>},
    Type{"short", "int16", 2, value_of<std::int16_t>},
    Type{"ushort", "uint16", 2, value_of<std::uint16_t>},
    Type{"int", "int32", 4, value_of<std::int32_t>},
    Type{"uint", "uint32", 4, value_of<std::uint32_t>},
    Type{"float", "float32", 4, value_of<float>},
    Type{"double", "float64", 8, value_of<double>},
};

struct Property {
  std::string name;
  const Type* type{};
  const Type* count_type{};  // of a list; nullptr: a single number
};
struct Element {
  std::string name;
  std::size_t count{};
  std::vector<Property> properties;
};

// The numbers of a file's body one after another, as text or as bytes.
class Numbers {
 public:
  Numbers(const std::string& file, std::string_view body, Encoding encoding)
      : file_{file}, body_{body}, encoding_{encoding} {}

  double next(const Type& type, const std::string& place) {
    return encoding_ == Encoding::ascii ? next_word(place) : next_bytes(type, place);
  }
  std::size_t left() const { return body_.size(); }
  // But for blanks, with which some programs end a file.
  std::size_t left_at_end() const {
    const auto last = body_.find_last_not_of(std::string_view{" \t\r\n\v\f\0", 7});
    return last == std::string_view::npos ? 0 : last + 1;
  }

 private:
  [[noreturn]] void ends(const std::string& place) const {
    throw core::InvalidInput{fmt::format("{}: ends in {}", file_, place)};
  }
  double next_word(const std::string& place) {
    constexpr std::string_view blanks{" \t\r\n\v\f"};
    body_.remove_prefix(std::min(body_.find_first_not_of(blanks), body_.size()));
    if (body_.empty()) {
      ends(place);
    }
    const auto end = std::min(body_.find_first_of(blanks), body_.size());
    const std::string_view word = body_.substr(0, end);
    body_.remove_prefix(end);
    return coordinate_in(word, fmt::format("{}: {}", file_, place));
  }
  double next_bytes(const Type& type, const std::string& place) {
    if (body_.size() < type.bytes) {
      ends(place);
    }
    std::array<char, 8> bytes{};
    std::ranges::copy(body_.substr(0, type.bytes), bytes.begin());
    body_.remove_prefix(type.bytes);
    if (encoding_ == Encoding::big_endian) {
      std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(type.bytes));
    }
    const double value = type.value(bytes.data());
    if (!std::isfinite(value)) {
      throw core::InvalidInput{fmt::format("{}: {} has a number that is not finite", file_, place)};
    }
    return value;
  }

  const std::string& file_;
  std::string_view body_;
  Encoding encoding_;
};

class PlyReader {
 public:
  PlyReader(const std::string& file, std::string_view bytes) : file_{file}, bytes_{bytes} {}

  SurfaceSoup read() {
    read_header();
    Numbers numbers{file_, bytes_, encoding_};
    for (const Element& element : elements_) {
      read_element(element, numbers);
    }
    if (numbers.left_at_end() > 0) {
      refuse(fmt::format("{} bytes are left after all that its header counts ({} points, {} faces)",
                         numbers.left_at_end(), soup_.points.size(), faces_.size()));
    }
    check_corners();
    if (soup_.polygons.empty()) {
      refuse(fmt::format("it holds {} points and no face", soup_.points.size()));
    }
    return std::move(soup_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw core::InvalidInput{fmt::format("{}: is not a surface: {}", file_, what)};
  }
  [[noreturn]] void refuse_line(const std::vector<std::string_view>& words) const {
    throw core::InvalidInput{
        fmt::format("{}:{}: not a line of a PLY's header: it begins with '{}'", file_, line_,
                    words.empty() ? std::string{} : printable(std::string{words.front()}))};
  }

  void read_header() {
    if (take_line(bytes_) != "ply") {
      refuse("a PLY begins with a line 'ply'");
    }
    line_ = 1;
    bool is_done = false;
    while (!is_done) {
      if (bytes_.empty()) {
        refuse(fmt::format("its header does not end (end_header) in {} lines", line_));
      }
      ++line_;
      const auto words = words_of(take_line(bytes_));
      is_done = !words.empty() && words.front() == "end_header";
      if (!is_done) {
        read_header_line(words);
      }
    }
  }

  void read_header_line(const std::vector<std::string_view>& words) {
    if (words.empty() || words.front() == "comment" || words.front() == "obj_info") {
      return;
    }
    if (words.front() == "format" && words.size() == 3) {
      read_format(words[1]);
    } else if (words.front() == "element" && words.size() == 3) {
      const auto count = core::number_in<std::size_t>(words[2]);
      if (!count) {
        refuse_line(words);
      }
      elements_.push_back({std::string{words[1]}, *count, {}});
    } else if (words.front() == "property" && !elements_.empty()) {
      read_property(words);
    } else {
      refuse_line(words);
    }
  }
  void read_format(std::string_view name) {
    constexpr std::array<std::string_view, 3> names{"ascii", "binary_little_endian",
                                                    "binary_big_endian"};
    const auto* const found = std::ranges::find(names, name);
    if (found == names.end()) {
      refuse(
          fmt::format("its format is '{}' (one of: ascii, binary_little_endian, "
                      "binary_big_endian)",
                      printable(std::string{name})));
    }
    encoding_ = static_cast<Encoding>(found - names.begin());
  }
  void read_property(const std::vector<std::string_view>& words) {
    if (words.size() == 5 && words[1] == "list") {
      elements_.back().properties.push_back(
          {std::string{words[4]}, &type_named(words[3]), &type_named(words[2])});
    } else if (words.size() == 3) {
      elements_.back().properties.push_back(
          {std::string{words[2]}, &type_named(words[1]), nullptr});
    } else {
      refuse_line(words);
    }
  }
  const Type& type_named(std::string_view name) const {
    const auto* const found = std::ranges::find_if(
        types, [&](const Type& type) { return type.name == name || type.other_name == name; });
    if (found == types.end()) {
      throw core::InvalidInput{fmt::format(
          "{}:{}: the type '{}' (char, uchar, short, ushort, int, uint, float, double, or int8 to "
          "float64)",
          file_, line_, printable(std::string{name}))};
    }
    return *found;
  }

  void read_element(const Element& element, Numbers& numbers) {
    if (element.properties.empty()) {
      return;  // takes no bytes, however many there are
    }
    for (std::size_t i = 0; i < element.count; ++i) {
      const std::string place = fmt::format("{} {} of {}", element.name, i, element.count);
      core::Vec3 point = core::Vec3::Zero();
      for (const Property& property : element.properties) {
        if (property.count_type == nullptr) {
          const double value = numbers.next(*property.type, place);
          if (property.name.size() == 1 && std::string_view{"xyz"}.find(property.name) < 3) {
            point[property.name.front() - 'x'] = value;
          }
        } else {
          add_list(element, property, read_list(property, numbers, place), place);
        }
      }
      if (element.name == "vertex") {
        soup_.points.push_back(point);
      }
    }
  }
  std::vector<std::int64_t> read_list(const Property& property, Numbers& numbers,
                                      const std::string& place) const {
    const double count = numbers.next(*property.count_type, place);
    if (count < 0.0 || count != std::floor(count) || count > static_cast<double>(numbers.left())) {
      refuse(fmt::format("{} has a list of {} numbers, {} bytes before its end", place, count,
                         numbers.left()));
    }
    std::vector<std::int64_t> list;
    for (double i = 0.0; i < count; ++i) {
      // what is no whole number is no corner: out of every range
      const double value = numbers.next(*property.type, place);
      const bool is_whole = value == std::floor(value) && std::abs(value) < 1e15;
      list.push_back(is_whole ? static_cast<std::int64_t>(value) : -2);
    }
    return list;
  }
  void add_list(const Element& element, const Property& property,
                const std::vector<std::int64_t>& list, const std::string& place) {
    if (property.name != "vertex_indices" && property.name != "vertex_index") {
      return;
    }
    if (element.name == "face") {
      if (list.size() < 3) {
        refuse(fmt::format("{} has {} corners (at least 3)", place, list.size()));
      }
      faces_.push_back(list);
    } else if (element.name == "tristrips") {
      add_strips(list);
    }
  }
  // Strips one after another, -1 between them: each corner makes a triangle with the two before it,
  // of which every second is turned round; corners are repeated to turn a corner.
  void add_strips(const std::vector<std::int64_t>& list) {
    std::size_t start = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (list[i] == -1) {
        start = i + 1;
        continue;
      }
      if (i < start + 2) {
        continue;
      }
      const bool is_turned = (i - start) % 2 == 1;
      const std::int64_t a = list[i - 2];
      const std::int64_t b = list[i - 1];
      const std::int64_t c = list[i];
      if (a != b && b != c && c != a) {
        faces_.push_back(is_turned ? std::vector{b, a, c} : std::vector{a, b, c});
      }
    }
  }
  // After all points are known: faces may come before them.
  void check_corners() {
    for (const std::vector<std::int64_t>& face : faces_) {
      auto& polygon = soup_.polygons.emplace_back();
      for (const std::int64_t corner : face) {
        if (corner < 0 || corner >= static_cast<std::int64_t>(soup_.points.size())) {
          refuse(fmt::format("face {} has the corner {} (numbered from 0, of {} points)",
                             soup_.polygons.size() - 1, corner, soup_.points.size()));
        }
        polygon.push_back(static_cast<std::size_t>(corner));
      }
    }
  }

  const std::string& file_;
  std::string_view bytes_;
  Encoding encoding_{Encoding::ascii};
  std::vector<Element> elements_;
  std::vector<std::vector<std::int64_t>> faces_;
  SurfaceSoup soup_;
  int line_{0};
};
}  // namespace

SurfaceSoup read_ply(const std::string& file, std::string_view bytes) {
  return PlyReader{file, bytes}.read();
}
}  // namespace tapstudy::protocols
