#include "device/loop/sleep_inhibitor.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <systemd/sd-bus.h>
#include <unistd.h>

#include <cstring>
#include <memory>
namespace tapstudy::device {
namespace {
struct Unref {
  void operator()(sd_bus* bus) const { sd_bus_flush_close_unref(bus); }
  void operator()(sd_bus_message* message) const { sd_bus_message_unref(message); }
};

// A descriptor, or a negative errno.
int inhibit_sleep() {
  sd_bus* opened = nullptr;
  if (const int error = sd_bus_open_system(&opened); error < 0) {
    return error;
  }
  const std::unique_ptr<sd_bus, Unref> bus{opened};
  sd_bus_message* answer = nullptr;
  const int error = sd_bus_call_method(
      bus.get(), "org.freedesktop.login1", "/org/freedesktop/login1",
      "org.freedesktop.login1.Manager", "Inhibit", nullptr, &answer, "ssss",
      "sleep:idle:handle-lid-switch", "tapstudy", "a haptic device is in use", "block");
  if (error < 0) {
    return error;
  }
  const std::unique_ptr<sd_bus_message, Unref> reply{answer};
  int lock = -1;
  if (const int unread = sd_bus_message_read(reply.get(), "h", &lock); unread < 0) {
    return unread;
  }
  return fcntl(lock, F_DUPFD_CLOEXEC, 0);  // the message's own is closed with it
}
}  // namespace

SleepInhibitor::SleepInhibitor() : lock_{inhibit_sleep()} {
  outcome_ = lock_ >= 0 ? "sleep inhibited"
                        : fmt::format("sleep not inhibited ({})", std::strerror(-lock_));
}

SleepInhibitor::~SleepInhibitor() {
  if (lock_ >= 0) {
    close(lock_);
  }
}
}  // namespace tapstudy::device
