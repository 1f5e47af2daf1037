#include "fuzz/input.hpp"
#include "protocols/spidar_calibration.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tapstudy::fuzz::try_reading(data, size, [](const std::string& text) {
    tapstudy::protocols::parse_calibration(text, "calibration.yaml", "X3R");
  });
}
