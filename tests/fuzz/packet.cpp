#include "device/remote/packets.hpp"
#include "fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tapstudy::fuzz::try_reading(data, size, [](const std::string& text) {
    const void* const raw = text.data();
    const std::span bytes{static_cast<const std::uint8_t*>(raw), text.size()};
    tapstudy::device::decoded_reply(bytes);
    tapstudy::device::decoded_introduction(bytes, 0);
  });
}
