#include "fuzz/input.hpp"
#include "runner/session/devices/rigs.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tapstudy::fuzz::try_reading(
      data, size, [](const std::string& text) { tapstudy::runner::parse_rig(text, "rig.yaml"); });
}
