#include "support/openhaptics/stand_in.hpp"

#include <HD/hd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stop_token>
#include <thread>

#include "support/mapped_stand_in.hpp"
namespace {
using tapstudy::testing::OpenHapticsStandIn;

OpenHapticsStandIn& device() {
  static OpenHapticsStandIn& shared = tapstudy::testing::mapped_by_test<OpenHapticsStandIn>();
  return shared;
}
HDSchedulerCallback scheduled = nullptr;
void* scheduled_data = nullptr;
std::jthread servo;
int frames = 0;
int periods = 0;
}  // namespace

HHD hdInitDevice(const char* /*name*/) {
  return device().is_gone ? HD_INVALID_HANDLE : 0;
}
void hdDisableDevice(HHD /*id*/) {
  for (auto& part_n : device().force_n) {
    part_n = 0.0;
  }
}
void hdMakeCurrentDevice(HHD /*id*/) {}
void hdEnable(HDenum /*capability*/) {}
HDSchedulerHandle hdScheduleAsynchronous(HDSchedulerCallback callback, void* data,
                                         HDushort /*priority*/) {
  scheduled = callback;
  scheduled_data = data;
  return 1;
}
void hdStartScheduler() {
  device().is_running = true;
  servo = std::jthread{[](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      const bool is_left_out = device().is_every_other && ++periods % 2 == 0;
      if (!device().is_hung && !is_left_out) {
        scheduled(scheduled_data);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
  }};
}
void hdStopScheduler() {
  servo = {};
  device().is_running = false;
}
void hdBeginFrame(HHD /*id*/) {}
void hdEndFrame(HHD /*id*/) {}
void hdGetDoublev(HDenum parameter, HDdouble* values) {
  switch (parameter) {
    case HD_CURRENT_POSITION:
      values[0] = 10.0 + 1e3 * device().tremor_m * std::sin(0.06 * ++frames);
      values[1] = device().is_lost ? std::nan("") : 20.0;
      values[2] = 30.0;
      break;
    case HD_CURRENT_VELOCITY:
      values[0] = values[1] = values[2] = 0.0;
      break;
    case HD_USABLE_WORKSPACE_DIMENSIONS:
      values[0] = -80.0;
      values[1] = -60.0;
      values[2] = -35.0;
      values[3] = 80.0;
      values[4] = 60.0;
      values[5] = 35.0;
      break;
    default:
      *values = parameter == HD_NOMINAL_MAX_FORCE ? 3.3 : 2.35;  // N, N/mm
  }
}
void hdGetIntegerv(HDenum /*parameter*/, HDint* values) {
  *values = 1;
}
void hdSetDoublev(HDenum /*parameter*/, const HDdouble* values) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    device().force_n[axis] = device().is_gone ? 0.0 : values[axis];
  }
  device().largest_n = std::max(device().largest_n.load(), device().force_n[1].load());
}
const char* hdGetString(HDenum parameter) {
  return parameter == HD_DEVICE_MODEL_TYPE ? "stand-in" : "4711";
}
HDErrorInfo hdGetError() {
  return {device().is_gone ? 1U : HD_SUCCESS, 0, 0};
}
const char* hdGetErrorString(HDerror error) {
  return error == HD_SUCCESS ? "no error" : "communication error";
}
