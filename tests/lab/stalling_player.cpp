// stalling_player CARD: plays a steady level whose source stalls three times for longer than the
// card's buffer lasts, and prints how many underruns were counted.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>

#include "device/audio/alsa_sink.hpp"
#include "device/audio/audio_player.hpp"
using namespace tapstudy;
using namespace std::chrono_literals;

namespace {
constexpr auto stall = 400ms;  // the buffer holds 80 ms
constexpr int periods_between = 60;
constexpr int stalls = 3;

class StallingSource final : public device::SampleSource {
 public:
  void fill(std::span<float> samples) noexcept override {
    ++periods_;
    if (periods_ % periods_between == 0 && periods_ / periods_between <= stalls) {
      std::this_thread::sleep_for(stall);
    }
    std::ranges::fill(samples, 0.25F);
  }

 private:
  int periods_{0};
};
}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    return 2;
  }
  device::AudioPlayer player{device::open_alsa({.card = argv[1]}),
                             std::make_unique<StallingSource>(), 0.05,
                             core::RealtimeRequest{0, false, std::nullopt}};
  std::this_thread::sleep_for(1s);  // for a recorder to be connected
  player.fade_in();
  std::this_thread::sleep_for((stalls + 1) * (stall + periods_between * 10ms));
  fmt::print("{}\n", player.played().underruns);
}
