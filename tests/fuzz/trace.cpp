#include <span>

#include "fuzz/input.hpp"
#include "results/traces/trace_codec.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tapstudy::fuzz::try_reading(data, size, [](const std::string& text) {
    for (const std::size_t ticks : {std::size_t{1}, std::size_t{100}, std::size_t{4096}}) {
      tapstudy::results::decode_trace(std::as_bytes(std::span{text}), ticks, "trace");
    }
  });
}
