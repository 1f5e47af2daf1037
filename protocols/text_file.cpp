#include "protocols/text_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "core/error.hpp"
namespace tapstudy::protocols {
namespace {
constexpr std::size_t largest_file = 4'000'000;
}

std::string contents_of(const std::string& file) {
  std::error_code error;
  std::ifstream stream{file, std::ios::binary};
  if (!stream || std::filesystem::is_directory(file, error)) {
    throw core::InvalidInput{file + ": cannot be read"};
  }
  std::string text(largest_file + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) {
    throw core::InvalidInput{file + ": cannot be read"};
  }
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > largest_file) {
    throw core::InvalidInput{fmt::format("{}: is too long (at most {} bytes)", file, largest_file)};
  }
  return text;
}
}  // namespace tapstudy::protocols
