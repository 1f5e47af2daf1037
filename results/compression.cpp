#include "results/compression.hpp"

#include <zstd.h>

#include <memory>
#include <string>

#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
constexpr int compression_level = 1;
}

std::vector<std::byte> compressed(std::span<const std::byte> plain) {
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context{ZSTD_createCCtx(),
                                                                     ZSTD_freeCCtx};
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, compression_level);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::vector<std::byte> bytes(ZSTD_compressBound(plain.size()));
  const std::size_t size =
      ZSTD_compress2(context.get(), bytes.data(), bytes.size(), plain.data(), plain.size());
  if (ZSTD_isError(size) != 0U) {
    throw StoreError{std::string{"compression failed: "} + ZSTD_getErrorName(size)};
  }
  bytes.resize(size);
  return bytes;
}

std::vector<std::byte> decompressed(std::span<const std::byte> bytes, std::size_t size) {
  if (ZSTD_getFrameContentSize(bytes.data(), bytes.size()) != size) {
    throw StoreError{"a compressed row has unexpected contents"};
  }
  std::vector<std::byte> plain(size);
  const std::size_t found = ZSTD_decompress(plain.data(), plain.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(found) != 0U || found != size) {
    throw StoreError{"a compressed row is damaged"};
  }
  return plain;
}
}  // namespace tapstudy::results
