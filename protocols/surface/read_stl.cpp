#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
#include "protocols/surface/surface_soup.hpp"
#include "protocols/yaml/problems.hpp"
namespace tapstudy::protocols {
namespace {
static_assert(std::endian::native == std::endian::little, "as in a binary STL");

constexpr std::size_t header_bytes = 80;
constexpr std::size_t before_triangles = header_bytes + 4;
constexpr std::size_t triangle_bytes = 50;

// Three numbers a vertex; which words stand around them is of no more use than to tell facets
// apart.
class AsciiStl {
 public:
  AsciiStl(const std::string& file, std::string_view text) : file_{file}, text_{text} {}

  SurfaceSoup read() {
    while (!text_.empty()) {
      add(words_of(take_line(text_)));
    }
    if (!corners_.empty()) {
      throw core::InvalidInput{fmt::format("{}:{}: ends inside a facet, after {} whole ones", file_,
                                           line_, soup_.polygons.size())};
    }
    if (soup_.polygons.empty()) {
      throw core::InvalidInput{
          fmt::format("{}: is not a surface: an ASCII STL without a facet", file_)};
    }
    return std::move(soup_);
  }

 private:
  std::string place() const { return fmt::format("{}:{}", file_, line_); }

  void add(const std::vector<std::string_view>& words) {
    ++line_;
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::string word = core::lower_case(words[i]);
      if (word == "solid" || word == "endsolid") {
        return;  // the rest is a name
      }
      if (word == "vertex") {
        add_corner(words, i);
        i += 3;
      } else if (word == "endfacet") {
        end_facet();
      }
    }
  }

  void add_corner(const std::vector<std::string_view>& words, std::size_t at) {
    if (at + 3 >= words.size()) {
      throw core::InvalidInput{fmt::format("{}: a vertex of {} numbers (3, on its line)", place(),
                                           words.size() - at - 1)};
    }
    corners_.push_back(soup_.points.size());
    soup_.points.emplace_back(coordinate_in(words[at + 1], place()),
                              coordinate_in(words[at + 2], place()),
                              coordinate_in(words[at + 3], place()));
  }

  void end_facet() {
    if (corners_.size() < 3) {
      throw core::InvalidInput{
          fmt::format("{}: a facet of {} vertices (at least 3)", place(), corners_.size())};
    }
    soup_.polygons.push_back(std::move(corners_));
    corners_.clear();
  }

  const std::string& file_;
  std::string_view text_;
  SurfaceSoup soup_;
  std::vector<std::size_t> corners_;  // of the facet being read
  int line_{0};
};

std::size_t triangles_by_header(std::string_view bytes) {
  std::uint32_t count{};
  std::memcpy(&count, bytes.data() + header_bytes, sizeof count);
  return count;
}

SurfaceSoup read_binary(const std::string& file, std::string_view bytes) {
  const std::size_t count = triangles_by_header(bytes);
  const std::size_t present = (bytes.size() - before_triangles) / triangle_bytes;
  if (count != present || count == 0) {
    throw core::InvalidInput{fmt::format(
        "{}: is not a surface: a binary STL of {} triangles by its header, and with bytes for {}",
        file, count, present)};
  }
  SurfaceSoup soup;
  for (std::size_t triangle = 0; triangle < count; ++triangle) {
    constexpr std::size_t normal_bytes = 12;
    const char* at = bytes.data() + before_triangles + triangle * triangle_bytes + normal_bytes;
    auto& polygon = soup.polygons.emplace_back();
    for (int corner = 0; corner < 3; ++corner) {
      std::array<float, 3> xyz{};
      std::memcpy(xyz.data(), at, sizeof xyz);
      at += sizeof xyz;
      if (!std::ranges::all_of(xyz, [](float x) { return std::isfinite(x); })) {
        throw core::InvalidInput{fmt::format(
            "{}: triangle {} has a coordinate that is not a finite number", file, triangle)};
      }
      polygon.push_back(soup.points.size());
      soup.points.emplace_back(xyz[0], xyz[1], xyz[2]);
    }
  }
  return soup;
}
}  // namespace

// Many a binary file begins with "solid", too: one that is as long as its header says is binary.
SurfaceSoup read_stl(const std::string& file, std::string_view bytes) {
  const bool can_be_binary = bytes.size() >= before_triangles;
  if (can_be_binary &&
      bytes.size() == before_triangles + triangle_bytes * triangles_by_header(bytes)) {
    return read_binary(file, bytes);
  }
  const std::string_view text = without_byte_order_mark(bytes);
  const std::string start = core::lower_case(text.substr(0, 1000));
  const bool is_text = start.find('\0') == std::string::npos;
  if (is_text && start.find_first_not_of(" \t\r\n") != std::string::npos &&
      start.substr(start.find_first_not_of(" \t\r\n")).starts_with("solid")) {
    return AsciiStl{file, text}.read();
  }
  if (!can_be_binary) {
    throw core::InvalidInput{fmt::format(
        "{}: is not a surface: {} bytes that begin with '{}' (an ASCII STL begins with 'solid', a "
        "binary one has at least {} bytes)",
        file, bytes.size(), printable(std::string{bytes.substr(0, 20)}), before_triangles)};
  }
  return read_binary(file, bytes);
}
}  // namespace tapstudy::protocols
