#pragma once
#include <cstddef>
#include <string>
#include <string_view>
namespace tapstudy::core {
// Whether it can be stored and shown as text: UTF-8 (RFC 3629), no control characters but line
// breaks and tabs.
bool is_plain_text(std::string_view text);
// Without spaces, tabs and line breaks at its ends.
std::string trimmed(std::string_view text);
// Characters of plain text, each of one code point.
std::size_t character_count(std::string_view text);
// The first characters, as many as fit into so many bytes: none is cut in two.
std::string cut_to(std::string_view text, std::size_t max_bytes);
// The same, with "…" after what was cut.
std::string shortened(std::string_view text, std::size_t max_bytes);
}  // namespace tapstudy::core
