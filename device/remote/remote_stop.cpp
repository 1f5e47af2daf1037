#include <cmath>

#include "device/remote/remote_hand.hpp"
namespace tapstudy::device {
using core::TickFault;
namespace {
constexpr int max_zero_force_requests = 30;  // a device may measure its force late
constexpr int new_samples_of_a_stop = 2;
}  // namespace

// Two samples may take two of the device's periods.
int RemoteHand::max_requests_of_a_stop() const noexcept {
  constexpr double asked_hz = 1000.0;
  const double waited =
      introduction_ ? new_samples_of_a_stop * asked_hz / introduction_->rate_hz : 0.0;
  return max_zero_force_requests + static_cast<int>(std::ceil(waited));
}

// Whether the reply to the last request, which carried zero force, shows that none is exerted any
// more. In version 3 that takes two samples that the device took since the first such request.
bool RemoteHand::shows_no_force(SamplesSince& samples, Nanoseconds since) noexcept {
  const bool is_exerted = detail_.achieved_n.hasNaN() ? exerted_.has_told()  // and no longer does
                                                      : detail_.achieved_n.norm() >= noticeable_n;
  if (!reply_.sample) {
    return !is_exerted;
  }
  const double since_s = 1e-9 * static_cast<double>(pipe_->now() - since);
  return samples.counted(*reply_.sample, is_exerted, since_s) >= new_samples_of_a_stop;
}

// Confirmed by replies to requests that carried zero force. It is asked three times at once, then
// every millisecond until the device shows no force, or leaves three in a row unanswered.
StopOutcome RemoteHand::zero_force() noexcept {
  force_n_ = core::Vec3::Zero();
  const Nanoseconds start = pipe_->now();
  const int max_requests = max_requests_of_a_stop();
  SamplesSince samples;
  bool is_confirmed = false;
  int missing = 0;
  for (int i = 0; i < zero_force_packets ||
                  (!is_confirmed && missing < zero_force_packets && i < max_requests);
       ++i) {
    if (i >= zero_force_packets) {
      sleep_for(std::chrono::milliseconds{1});
    }
    const bool has_replied = ask() == TickFault::none;
    missing = has_replied ? 0 : missing + 1;
    is_confirmed = has_replied && shows_no_force(samples, start);
  }
  return is_confirmed ? StopOutcome::confirmed : StopOutcome::unconfirmed;
}
}  // namespace tapstudy::device
