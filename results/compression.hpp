#pragma once
#include <cstddef>
#include <span>
#include <vector>
namespace tapstudy::results {
// One Zstandard frame (RFC 8878) with its size and a checksum of its content, which the frame's
// decoder verifies. Throws StoreError.
std::vector<std::byte> compressed(std::span<const std::byte> plain);
// Throws StoreError if the bytes are not one frame of this size, or damaged. The frame itself says
// how large it is: a damaged row must not ask for all memory there is.
std::vector<std::byte> decompressed(std::span<const std::byte> bytes, std::size_t size);
}  // namespace tapstudy::results
