#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <optional>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
#include "protocols/surface/surface_soup.hpp"
#include "protocols/yaml/problems.hpp"
namespace tapstudy::protocols {
namespace {
class ObjReader {
 public:
  ObjReader(const std::string& file, std::string_view text) : file_{file}, text_{text} {}

  SurfaceSoup read() {
    while (!text_.empty()) {
      const std::string statement = take_statement();
      const auto words = words_of(statement);
      if (!words.empty()) {
        add(words);
      }
    }
    if (soup_.polygons.empty()) {
      throw core::InvalidInput{
          fmt::format("{}: is not a surface: it holds {} points (v), {} lines (l) and no face (f)",
                      file_, soup_.points.size(), lines_)};
    }
    return std::move(soup_);
  }

 private:
  std::string place() const { return fmt::format("{}:{}", file_, first_line_); }

  // A line with those that continue it, without comments.
  std::string take_statement() {
    first_line_ = line_ + 1;
    std::string statement;
    bool goes_on = true;
    while (goes_on && !text_.empty()) {
      std::string_view line = take_line(text_);
      ++line_;
      line = line.substr(0, line.find('#'));
      goes_on = line.ends_with('\\');
      statement += goes_on ? line.substr(0, line.size() - 1) : line;
      statement += ' ';
    }
    return statement;
  }

  void add(const std::vector<std::string_view>& words) {
    if (words.front() == "v") {
      add_point(words);
    } else if (words.front() == "f") {
      add_face(words);
    } else if (words.front() == "l") {
      ++lines_;
    }
  }

  // x y z, x y z w, or with a colour x y z r g b. In homogeneous coordinates the point is
  // (x, y, z) / w.
  void add_point(const std::vector<std::string_view>& words) {
    if (words.size() != 4 && words.size() != 5 && words.size() != 7) {
      throw core::InvalidInput{
          fmt::format("{}: a point (v) of {} numbers (3; 4 with a weight; 6 with a colour)",
                      place(), words.size() - 1)};
    }
    core::Vec3 point{coordinate_in(words[1], place()), coordinate_in(words[2], place()),
                     coordinate_in(words[3], place())};
    if (words.size() == 5) {
      const double weight = coordinate_in(words[4], place());
      if (weight == 0.0) {
        throw core::InvalidInput{fmt::format("{}: a point (v) of weight 0", place())};
      }
      point /= weight;
    }
    soup_.points.push_back(point);
  }

  // v, v/vt, v//vn or v/vt/vn, each v from 1, or from -1 back from the last point so far
  std::size_t corner_in(std::string_view word) const {
    const auto number = core::number_in<std::int64_t>(word.substr(0, word.find('/')));
    const auto points = static_cast<std::int64_t>(soup_.points.size());
    const std::int64_t index = number.value_or(0) < 0 ? points + *number : number.value_or(0) - 1;
    if (!number || index < 0 || index >= points) {
      throw core::InvalidInput{fmt::format("{}: a face (f) with the corner '{}' ({} points so far)",
                                           place(), printable(std::string{word}), points)};
    }
    return static_cast<std::size_t>(index);
  }

  void add_face(const std::vector<std::string_view>& words) {
    if (words.size() < 4) {
      throw core::InvalidInput{
          fmt::format("{}: a face (f) of {} corners (at least 3)", place(), words.size() - 1)};
    }
    auto& polygon = soup_.polygons.emplace_back();
    for (std::size_t i = 1; i < words.size(); ++i) {
      polygon.push_back(corner_in(words[i]));
    }
  }

  const std::string& file_;
  std::string_view text_;
  SurfaceSoup soup_;
  int line_{0};
  int first_line_{0};
  int lines_{0};
};
}  // namespace

SurfaceSoup read_obj(const std::string& file, std::string_view bytes) {
  return ObjReader{file, without_byte_order_mark(bytes)}.read();
}
}  // namespace tapstudy::protocols
