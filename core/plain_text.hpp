#pragma once
#include <string_view>
namespace tapstudy::core {
// Whether it can be stored and shown as text: UTF-8 (RFC 3629), no control characters but line
// breaks and tabs.
bool is_plain_text(std::string_view text);
}  // namespace tapstudy::core
