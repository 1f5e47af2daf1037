#pragma once
#include <string>
namespace tapstudy::protocols {
// Is this well-formed UTF-8 (RFC 3629: no surrogates, nothing overlong, nothing past U+10FFFF)?
bool is_utf8(const std::string& text);
}  // namespace tapstudy::protocols
