#pragma once
#include <string>
#include <string_view>
namespace tapstudy::core {
// "data:image/png;base64,…" (RFC 2397): a file that stands in a page.
std::string data_url(std::string_view media_type, std::string_view bytes);
}  // namespace tapstudy::core
