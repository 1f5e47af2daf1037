#include "device/remote/packets.hpp"
#include "fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tapstudy::fuzz::try_reading(data, size, [](const std::string& text) {
    const void* const raw = text.data();
    tapstudy::device::decoded_reply({static_cast<const std::uint8_t*>(raw), text.size()});
  });
}
