#include "runner/session/preflight.hpp"

#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
namespace {
constexpr double measured_s = 0.5;
}

PreflightReport run_preflight(const protocols::Rig& rig, SessionDevice& device,
                              device::Nanoseconds period, const std::string& sleep) {
  PreflightReport report{device.description(),
                         diagnose(rig.realtime, period, measured_s, Under::no_load)};
  report.diagnosis.round_trip = device.round_trip();
  report.diagnosis.sleep = sleep;
  const Verdict verdict = verdict_of(report.diagnosis);
  if (!verdict.holds) {
    warn(verdict.words + " (recorded with the session; for details run `tapstudy doctor`)");
  }
  return report;
}
}  // namespace tapstudy::runner
