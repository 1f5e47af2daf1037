#pragma once
#include <cstddef>
#include <functional>
#include <string>
namespace tapstudy::protocols {
// The complete contents of a surface file: stored with the study that uses it.
struct SurfaceSource {
  std::string file;  // as the protocol names it
  std::string bytes;
  std::string sha256;  // of the bytes
};

// The bytes of a file that a protocol names. Throws InvalidInput if there is none.
using ReadFile = std::function<std::string(const std::string& file)>;
inline constexpr std::size_t max_surface_bytes = 200'000'000;
}  // namespace tapstudy::protocols
