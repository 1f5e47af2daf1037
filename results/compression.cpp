#include "results/compression.hpp"

#include <zstd.h>

#include <algorithm>
#include <memory>
#include <string>

#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
constexpr int compression_level = 1;
constexpr std::size_t most_kept_bytes = 4 << 20;  // more than a chunk of a trace takes

std::size_t checked(std::size_t result) {
  if (ZSTD_isError(result) != 0U) {
    throw StoreError{std::string{"compression failed: "} + ZSTD_getErrorName(result)};
  }
  return result;
}
}  // namespace

// A context and its tables are a megabyte, and as much is the room for what might not shrink: each
// thread keeps its own, since the system takes longer to give and clear new memory for every chunk
// of a trace than the chunk takes to be compressed.
std::vector<std::byte> compressed(std::span<const std::byte> plain) {
  thread_local const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context{ZSTD_createCCtx(),
                                                                                  ZSTD_freeCCtx};
  thread_local std::vector<std::byte> room;
  if (context == nullptr) {
    throw StoreError{"compression failed: out of memory"};
  }
  checked(ZSTD_CCtx_reset(context.get(), ZSTD_reset_session_and_parameters));
  checked(ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, compression_level));
  checked(ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1));
  room.resize(std::max(room.size(), ZSTD_compressBound(plain.size())));
  const std::size_t size =
      checked(ZSTD_compress2(context.get(), room.data(), room.size(), plain.data(), plain.size()));
  std::vector<std::byte> bytes{room.begin(), room.begin() + static_cast<std::ptrdiff_t>(size)};
  if (room.size() > most_kept_bytes) {  // a surface, once for a study
    room = std::vector<std::byte>{};
  }
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
