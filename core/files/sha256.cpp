#include "core/files/sha256.hpp"

#include <openssl/evp.h>

#include <array>
#include <span>

#include "core/error.hpp"
#include "core/text/hexadecimal.hpp"
namespace tapstudy::core {
std::string sha256(const std::string& text) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(text.data(), text.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    throw Error{"SHA-256 is not available"};
  }
  return to_hex(std::as_bytes(std::span{digest}.first(size)));
}
}  // namespace tapstudy::core
