#include "protocols/yaml/text_file.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "core/error.hpp"
namespace tapstudy::protocols {
// Read in chunks, so that the maximum size is not allocated at once.
std::string contents_of(const std::string& file, std::size_t max_bytes) {
  std::error_code error;
  std::ifstream stream{file, std::ios::binary};
  if (!stream || std::filesystem::is_directory(file, error)) {
    throw core::InvalidInput{
        fmt::format("{}: cannot be read{}", file,
                    std::filesystem::exists(file, error) ? "" : " (no such file)")};
  }
  std::string text;
  std::array<char, 1 << 16> piece{};
  while (stream && text.size() <= max_bytes) {
    stream.read(piece.data(), piece.size());
    text.append(piece.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) {
    throw core::InvalidInput{file + ": cannot be read"};
  }
  if (text.size() > max_bytes) {
    throw core::InvalidInput{fmt::format("{}: is too long (at most {} bytes)", file, max_bytes)};
  }
  return text;
}
}  // namespace tapstudy::protocols
