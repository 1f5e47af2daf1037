#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/haptics/haptic_state.hpp"
namespace tapstudy::protocols {
// Points and polygons as a file has them, in its units; every corner is the number of a point.
struct SurfaceSoup {
  std::vector<core::Vec3> points;
  std::vector<std::vector<std::size_t>> polygons;
};

// Readers of the contents of one file each. Our own rather than CGAL's, which trusts a file (it
// crashes, or takes all memory, where a count lies), stops at an OBJ's tabs, continued lines and
// lines (l), divides by w twice, finds no coordinates in an STL with a byte order mark or in
// capitals, and says of none what it has found. Each throws InvalidInput with the line or element,
// what is there and what is allowed. Numbers are finite.
SurfaceSoup read_obj(const std::string& file, std::string_view bytes);
// ASCII, in small letters or capitals, or binary: whichever it is by its contents.
SurfaceSoup read_stl(const std::string& file, std::string_view bytes);
// ASCII or binary of either byte order; coordinates and indices of any of the format's types;
// faces, triangle strips, or both. Other elements and properties are passed over.
SurfaceSoup read_ply(const std::string& file, std::string_view bytes);

// The number that a word is, as a coordinate. Throws InvalidInput, which begins with `place`; of a
// decimal comma it says so.
double coordinate_in(std::string_view word, const std::string& place);
// The words of a line, between blanks and tabs.
std::vector<std::string_view> words_of(std::string_view line);
// The next line, without its end ("\n", "\r\n" or "\r"); the text loses it.
std::string_view take_line(std::string_view& text);
// The text without the byte order mark of UTF-8.
std::string_view without_byte_order_mark(std::string_view text);
}  // namespace tapstudy::protocols
