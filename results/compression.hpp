#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>
namespace tapstudy::results {
// One Zstandard frame (RFC 8878) with its content size and checksum, which the decoder verifies.
// Throws StoreError.
std::vector<std::byte> compressed(std::span<const std::byte> plain);
// Throws StoreError, naming `what` they are, if the bytes are damaged or not one frame of this
// size. The size in the frame header is checked first, so that a damaged row cannot cause a huge
// allocation.
std::vector<std::byte> decompressed(std::span<const std::byte> bytes, std::size_t size,
                                    const std::string& what);
}  // namespace tapstudy::results
