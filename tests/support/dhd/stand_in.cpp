#include "support/dhd/stand_in.hpp"

#include <dhdc.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "support/mapped_stand_in.hpp"
namespace {
using tapstudy::testing::DhdStandIn;

DhdStandIn& device() {
  static DhdStandIn& shared = tapstudy::testing::mapped_by_test<DhdStandIn>();
  return shared;
}
int outcome() {
  return device().is_gone ? -1 : 0;
}
}  // namespace

int dhdOpen() {
  return outcome();
}
int dhdClose(char /*id*/) {
  return 0;
}
int dhdEnableExpertMode() {
  return 0;
}
int dhdSetWatchdog(unsigned char duration, char /*id*/) {
  device().watchdog = duration;
  return device().has_watchdog ? 0 : -1;
}
int dhdEnableForce(unsigned char is_on, char /*id*/) {
  device().is_force_enabled = is_on == DHD_ON;
  return outcome();
}
int dhdGetSerialNumber(unsigned short* number, char /*id*/) {
  *number = 4711;
  return outcome();
}
const char* dhdGetSystemName(char /*id*/) {
  return "stand-in";
}
int dhdGetPosition(double* x_m, double* y_m, double* z_m, char /*id*/) {
  static int samples = 0;
  *x_m = 0.01 + device().tremor_m * std::sin(0.06 * ++samples);
  *y_m = device().is_lost ? std::nan("") : 0.02;
  *z_m = 0.03;
  const bool is_old = device().is_hung || (device().is_every_other && samples % 2 == 0);
  return is_old ? DHD_TIMEGUARD : outcome();
}
int dhdGetLinearVelocity(double* x_m_s, double* y_m_s, double* z_m_s, char /*id*/) {
  *x_m_s = *y_m_s = *z_m_s = 0.0;
  return outcome();
}
int dhdSetForce(double x_n, double y_n, double z_n, char /*id*/) {
  device().force_n[0] = x_n;
  device().force_n[1] = y_n;
  device().force_n[2] = z_n;
  device().largest_n = std::max(device().largest_n.load(), z_n);
  device().asked_at_ns = std::chrono::steady_clock::now().time_since_epoch().count();
  return outcome();
}
unsigned int dhdGetButtonMask(char /*id*/) {
  return 1;
}
const char* dhdErrorGetLastStr() {
  return device().is_gone ? "device not ready" : "no error";
}
