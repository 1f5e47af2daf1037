#pragma once
#include <string_view>
namespace tapstudy::core {
// To a file or pipe; false where it fails, with errno.
bool write_all(int descriptor, std::string_view bytes);
}  // namespace tapstudy::core
