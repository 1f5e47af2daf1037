#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
namespace tapstudy::protocols {
inline constexpr std::size_t max_picture_bytes = 1'000'000;

// Beside what participants read: a file that the protocol names, whole.
struct Picture {
  std::string file;  // as the protocol names it
  std::string text;  // for those who cannot see it
  std::string_view media_type;
  std::shared_ptr<const std::string> bytes;
};

// SVG, PNG or JPEG, by what it holds. Throws InvalidInput for other files, for one that is too
// large or breaks off, and for SVG that is not well-formed or holds what a picture in a page does
// not do: scripts, event handlers, declarations of entities, and references to anything but itself.
std::string_view media_type_of_picture(const std::string& file, const std::string& bytes);
}  // namespace tapstudy::protocols
