#include "runner/trial_loop/mounted_plates.hpp"

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "runner/terminal/exit_code.hpp"
#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
namespace {
class IdleExploration final : public Exploration {
 public:
  void switch_to(std::size_t /*alternative*/) override {}
  void pass_time(double seconds) override {
    std::this_thread::sleep_for(std::chrono::duration<double>{seconds});
  }
  bool is_running() const override { return true; }
  double time_s() const override {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  int contacts(std::size_t /*alternative*/) const override { return 0; }

 private:
  std::chrono::steady_clock::time_point start_{std::chrono::steady_clock::now()};
};
}  // namespace

TrialResult IdleTrialLoop::run(const Rendered& /*rendered*/, const Explore& explore) {
  IdleExploration exploration;
  explore(exploration);
  TrialResult result;
  result.trace.duration_s = exploration.time_s();
  return result;
}

TrialStimuli MountedPlates::mount(const std::string& stimulus) {
  const protocols::Stimulus& plate = protocol_.stimulus(stimulus);
  if (!ask_operator_(fmt::format("For the operator alone: mount the real plate '{}' ({}).",
                                 plate.name, plate.label))) {
    stop_if_asked();
    throw Stopped{fmt::format("stopped: the real plate '{}' was not mounted", plate.name)};
  }
  return {};
}
}  // namespace tapstudy::runner
