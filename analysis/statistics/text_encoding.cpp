#include "analysis/statistics/text_encoding.hpp"

#include <fmt/format.h>
#include <glib.h>
#include <utf8cpp/utf8.h>

#include <memory>

#include "core/error.hpp"
namespace tapstudy::analysis {
bool is_utf8(std::string_view bytes) {
  return utf8::is_valid(bytes.begin(), bytes.end());
}

std::string likely_encoding(std::string_view bytes) {
  const bool has_mark = bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff");
  if (has_mark) {
    return "UTF-16";
  }
  return bytes.find('\0') == std::string_view::npos ? "windows-1252" : "UTF-16LE";
}

std::optional<std::string> converted_to_utf8(std::string_view bytes, const std::string& encoding) {
  gsize size = 0;
  GError* failure = nullptr;
  const std::unique_ptr<char, decltype(&g_free)> text{
      g_convert(bytes.data(), static_cast<gssize>(bytes.size()), "UTF-8", encoding.c_str(), nullptr,
                &size, &failure),
      &g_free};
  if (text) {
    return std::string{text.get(), size};
  }
  // opening a converter that there is not fails in more than one way
  const bool is_known =
      g_error_matches(failure, G_CONVERT_ERROR, G_CONVERT_ERROR_ILLEGAL_SEQUENCE) != FALSE ||
      g_error_matches(failure, G_CONVERT_ERROR, G_CONVERT_ERROR_PARTIAL_INPUT) != FALSE;
  g_error_free(failure);
  if (!is_known) {
    throw core::InvalidInput{
        fmt::format("--encoding: '{}' is not known (iconv --list names all)", encoding)};
  }
  return std::nullopt;
}
}  // namespace tapstudy::analysis
