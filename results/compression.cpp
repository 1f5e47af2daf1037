#include "results/compression.hpp"

#include <zstd.h>

#include <memory>
#include <string>

#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
constexpr int compression_level = 1;

std::size_t checked(std::size_t result) {
  if (ZSTD_isError(result) != 0U) {
    throw StoreError{std::string{"compression failed: "} + ZSTD_getErrorName(result)};
  }
  return result;
}
}  // namespace

std::vector<std::byte> compressed(std::span<const std::byte> plain) {
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context{ZSTD_createCCtx(),
                                                                     ZSTD_freeCCtx};
  if (context == nullptr) {
    throw StoreError{"compression failed: out of memory"};
  }
  checked(ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, compression_level));
  checked(ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1));
  std::vector<std::byte> bytes(ZSTD_compressBound(plain.size()));
  bytes.resize(checked(
      ZSTD_compress2(context.get(), bytes.data(), bytes.size(), plain.data(), plain.size())));
  return bytes;
}

std::vector<std::byte> decompressed(std::span<const std::byte> bytes, std::size_t size,
                                    const std::string& what) {
  const unsigned long long stated = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
  if (stated != size || stated == ZSTD_CONTENTSIZE_UNKNOWN || stated == ZSTD_CONTENTSIZE_ERROR) {
    throw StoreError{what + " is corrupt: not one compressed frame of the expected size"};
  }
  std::vector<std::byte> plain(size);
  const std::size_t found = ZSTD_decompress(plain.data(), plain.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(found) != 0U || found != size) {
    throw StoreError{what + " is corrupt: " + ZSTD_getErrorName(found)};
  }
  return plain;
}
}  // namespace tapstudy::results
