#include "core/files/data_url.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <vector>
namespace tapstudy::core {
std::string data_url(std::string_view media_type, std::string_view bytes) {
  const std::vector<unsigned char> plain(bytes.begin(), bytes.end());
  std::vector<unsigned char> encoded(4 * ((plain.size() + 2) / 3) + 1);  // with a zero at its end
  const int length = EVP_EncodeBlock(encoded.data(), plain.data(), static_cast<int>(plain.size()));
  return fmt::format("data:{};base64,{}", media_type,
                     std::string(encoded.begin(), encoded.begin() + length));
}
}  // namespace tapstudy::core
