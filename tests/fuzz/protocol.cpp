#include "fuzz/input.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "protocols/schedule/schedule.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return tapstudy::fuzz::try_reading(data, size, [](const std::string& text) {
    const auto none = [](const std::string& file) { return file; };
    const auto protocol = tapstudy::protocols::parse_protocol({text, "study.yaml"}, none);
    std::size_t trials = 0;
    for (const auto& block : protocol.blocks) {
      trials += static_cast<std::size_t>(block.repetitions) * block.stimuli.size();
    }
    if (trials < 1000) {
      make_schedule(protocol, 1, 0);
    }
  });
}
