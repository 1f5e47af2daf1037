#pragma once
#include <optional>
#include <string>
#include <string_view>
namespace tapstudy::analysis {
bool is_utf8(std::string_view bytes);

// What text that is no UTF-8 is most probably in, as iconv calls it.
std::string likely_encoding(std::string_view bytes);

// Text in UTF-8, without the byte order mark of UTF-16; unset if the bytes are not of the encoding.
// Throws InvalidInput for an encoding that iconv does not know.
std::optional<std::string> converted_to_utf8(std::string_view bytes, const std::string& encoding);
}  // namespace tapstudy::analysis
