#pragma once
#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>
namespace tapstudy::fuzz {
// One text or file as the fuzzer made it. Whatever is refused by an exception is refused well.
template <class Read>
int try_reading(const std::uint8_t* data, std::size_t size, const Read& read) {
  try {
    const void* const raw = data;
    read(std::string{static_cast<const char*>(raw), size});
  } catch (const std::exception&) {
    return 0;
  }
  return 0;
}
}  // namespace tapstudy::fuzz
