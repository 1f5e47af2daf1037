#include <array>

#include "core/error.hpp"
#include "fuzz/input.hpp"
#include "protocols/surface/check_surface.hpp"
#include "protocols/surface/surface_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tapstudy::fuzz::try_reading(data, size, [](const std::string& text) {
    constexpr std::array<const char*, 4> endings{".stl", ".ply", ".off", ".obj"};
    for (const char* const ending : endings) {
      try {
        tapstudy::protocols::check_surface(
            tapstudy::protocols::read_surface(
                tapstudy::protocols::surface_source(std::string{"body"} + ending, text), 1.0)
                .surface);
      } catch (const tapstudy::core::Error&) {
        continue;
      }
    }
  });
}
