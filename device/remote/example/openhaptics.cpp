// The Touch and Phantom devices of 3D Systems, through the HDAPI of OpenHaptics, as a device of
// tapstudy. Builds with the vendor's kit:
//
//   c++ -std=c++20 -o openhaptics openhaptics.cpp -I KIT/include -L KIT/lib -lHD -lpthread
//   openhaptics PORT [NAME]    and in the rig   device: remote   remote: {port: PORT}
//
// NAME is that of the vendor's set-up program, without it the default device. The servo loop of the
// HDAPI exerts the force of the last request and lets go of it 20 ms after that one, also while the
// rest of this program hangs. What the device does when this program is killed is up to its driver:
// nothing in the HDAPI asks for a release. Kill it once (kill -9) with nobody at the device before
// a rig relies on it.
#include <HD/hd.h>

#include <mutex>
#include <string>

#include "server.hpp"
namespace {
constexpr double m_per_mm = 1e-3;
constexpr double n_per_m_per_n_per_mm = 1e3;

[[noreturn]] void give_up(const char* what) {
  std::fprintf(stderr, "openhaptics: %s: %s\n", what, hdGetErrorString(hdGetError().errorCode));
  std::exit(1);
}

double told_by(HDenum parameter) {
  double value = 0.0;
  hdGetDoublev(parameter, &value);
  return value;
}

// x, y and z are those of tapstudy: right, up, towards the operator.
class OpenHapticsDevice final : public bridge::Device {
 public:
  // Ends the program if there is no device.
  explicit OpenHapticsDevice(const char* name) : id_{hdInitDevice(name)} {
    if (id_ == HD_INVALID_HANDLE) {
      give_up("no device can be opened");
    }
    hdEnable(HD_FORCE_OUTPUT);
    hdScheduleAsynchronous(&OpenHapticsDevice::tick, this, HD_MAX_SCHEDULER_PRIORITY);
    hdStartScheduler();
    if (hdGetError().errorCode != HD_SUCCESS) {
      give_up("the servo loop does not start");
    }
  }
  ~OpenHapticsDevice() override {
    hdStopScheduler();
    hdDisableDevice(id_);
  }

  bridge::wire::Introduction introduction() override {
    bridge::wire::Introduction told;
    // least x, y, z, then greatest, mm
    std::array<double, 6> box_mm{};
    hdMakeCurrentDevice(id_);
    hdGetDoublev(HD_USABLE_WORKSPACE_DIMENSIONS, box_mm.data());
    double least_mm = box_mm[3] - box_mm[0];
    for (std::size_t axis = 1; axis < 3; ++axis) {
      least_mm = std::min(least_mm, box_mm[axis + 3] - box_mm[axis]);
    }
    told.workspace_radius_m = 0.5 * m_per_mm * least_mm;
    told.max_force_n = told_by(HD_NOMINAL_MAX_FORCE);
    told.max_stiffness_n_per_m = n_per_m_per_n_per_mm * told_by(HD_NOMINAL_MAX_STIFFNESS);
    told.rate_hz = 1000.0;
    bridge::put_text(told.name, hdGetString(HD_DEVICE_MODEL_TYPE));
    bridge::put_text(told.serial_number, hdGetString(HD_DEVICE_SERIAL_NUMBER));
    return told;
  }
  void exert(const bridge::wire::Vector& force_n) override {
    const std::lock_guard lock{mutex_};
    force_n_ = force_n;
    asked_at_ = bridge::Clock::now();
  }
  void sample(bridge::wire::Reply& reply) override {
    const std::lock_guard lock{mutex_};
    reply = newest_;
    reply.age_s = bridge::seconds_since(taken_at_);
    if (error_ != HD_SUCCESS) {
      reply.status &= ~bridge::wire::motors_on;
      bridge::put_text(reply.text, hdGetErrorString(error_));
    }
  }

 private:
  // In the HDAPI's servo thread, 1000 times a second.
  static HDCallbackCode HDCALLBACK tick(void* device) {
    static_cast<OpenHapticsDevice*>(device)->tick();
    return HD_CALLBACK_CONTINUE;
  }
  void tick() {
    bridge::wire::Vector position_mm{};
    bridge::wire::Vector velocity_mm_s{};
    HDint buttons = 0;
    const std::lock_guard lock{mutex_};
    const bool is_silent = bridge::Clock::now() - asked_at_ > bridge::max_silence;
    bridge::wire::Vector force_n = is_silent ? bridge::wire::Vector{} : force_n_;
    hdBeginFrame(id_);
    hdGetDoublev(HD_CURRENT_POSITION, position_mm.data());
    hdGetDoublev(HD_CURRENT_VELOCITY, velocity_mm_s.data());
    hdGetIntegerv(HD_CURRENT_BUTTONS, &buttons);
    hdSetDoublev(HD_CURRENT_FORCE, force_n.data());
    hdEndFrame(id_);
    if (const HDErrorInfo found = hdGetError(); found.errorCode != HD_SUCCESS) {
      error_ = found.errorCode;
      return;  // the sample before stays the newest
    }
    error_ = HD_SUCCESS;
    ++newest_.sample;
    taken_at_ = bridge::Clock::now();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      newest_.position_m[axis] = m_per_mm * position_mm[axis];
      newest_.velocity_m_s[axis] = m_per_mm * velocity_mm_s[axis];
    }
    newest_.buttons = static_cast<std::uint32_t>(buttons);
    newest_.orientation.fill(std::nan(""));
    newest_.exerted_n.fill(std::nan(""));  // commanded, not measured
    newest_.exerted_n_m.fill(std::nan(""));
  }

  HHD id_;
  std::mutex mutex_;  // of what follows
  bridge::wire::Vector force_n_{};
  bridge::Clock::time_point asked_at_{};
  HDerror error_ = HD_SUCCESS;
  bridge::wire::Reply newest_;
  bridge::Clock::time_point taken_at_{};
};
}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    std::fputs("usage: openhaptics PORT [NAME]\n", stderr);
    return 2;
  }
  OpenHapticsDevice device{argc == 3 ? argv[2] : HD_DEFAULT_DEVICE};
  bridge::Server{std::atoi(argv[1]), device}.run();
}
