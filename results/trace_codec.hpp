#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "core/haptic_state.hpp"
namespace tapstudy::results {
inline constexpr const char* trace_codec = "tapstudy-trace/1";

// Samples to bytes and back, to the last bit. Each column of numbers is kept as the difference to
// the sample before (bits by exclusive or, time by subtraction), byte by byte of equal weight, and
// the whole compressed by Zstandard.
std::vector<std::byte> encode_trace(std::span<const core::TraceSample> samples);
// Throws StoreError if the bytes are not `ticks` encoded samples.
std::vector<core::TraceSample> decode_trace(std::span<const std::byte> bytes, std::size_t ticks);
}  // namespace tapstudy::results
