#include "fuzz/input.hpp"
#include "protocols/reader/read_rig.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tapstudy::fuzz::try_reading(data, size, [](const std::string& text) {
    tapstudy::protocols::parse_calibration(text, "calibration.yaml", "X3R");
  });
}
