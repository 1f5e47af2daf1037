#include "device/spidar/spidar_g6.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
namespace tapstudy::device {
using core::TickFault;
namespace {
constexpr int rounds_a_tick = 4;
constexpr int rounds_from_anywhere = 20;
// Velocity by finite differences is dominated by encoder quantisation; filter time constant.
constexpr double velocity_time_s = 3e-3;
constexpr double max_guardian_silence_s = 1.0;

TickFault fault_of(UsbOutcome outcome) noexcept {
  switch (outcome) {
    case UsbOutcome::ok:
      return TickFault::none;
    case UsbOutcome::timed_out:
      return TickFault::no_reply;
    case UsbOutcome::gone:
      return TickFault::device_gone;
    default:
      return TickFault::bad_reply;
  }
}
}  // namespace

SpidarG6::SpidarG6(UsbPipe& pipe, SpidarBoard& board, SpidarSettings settings)
    : pipe_{pipe},
      board_{board},
      settings_{std::move(settings)},
      tension_solver_{{settings_.calibration.min_tension_n, settings_.calibration.max_tension_n}},
      counters_{board.counter_bits()},
      length_at_rest_m_{strings_at(settings_.geometry, {}).length_m},
      strings_{strings_at(settings_.geometry, {})} {
  if (const UsbOutcome outcome = board_.begin(pipe_, reading_); outcome != UsbOutcome::ok) {
    throw DeviceError{fmt::format("SPIDAR-G6: the {} board does not answer: {}", board_.name(),
                                  to_text(outcome))};
  }
  // a second exchange, because the first may echo an earlier program's command
  if (const TickFault fault = exchange(); fault != TickFault::none) {
    throw DeviceError{fmt::format("SPIDAR-G6: the {} board answers nonsense: {}", board_.name(),
                                  core::to_text(fault))};
  }
}

SpidarG6::~SpidarG6() {
  SpidarG6::emergency_stop();
}

std::string SpidarG6::description() const {
  return fmt::format("SPIDAR-G6 {}, {} board, rotary switch {}", settings_.geometry.type,
                     board_.name(), reading_.rotary_switch());
}

// The guardian and this process monitor each other.
TickFault SpidarG6::fault_of_watchdog() noexcept {
  WatchdogChannel* const channel = settings_.watchdog;
  if (channel == nullptr || !channel->is_on()) {
    return TickFault::none;
  }
  channel->beat();
  const bool is_silent = channel->rounds() == guardian_rounds_;
  guardian_rounds_ = channel->rounds();
  guardian_silent_s_ = is_silent ? guardian_silent_s_ + settings_.dt_s : 0.0;
  if (channel->has_acted()) {
    return TickFault::stood_still;
  }
  return guardian_silent_s_ > max_guardian_silence_s ? TickFault::guardian_lost : TickFault::none;
}

TickFault SpidarG6::exchange() noexcept {
  if (const TickFault fault = fault_of_watchdog(); fault != TickFault::none) {
    return fault;
  }
  const UsbOutcome outcome = board_.exchange(pipe_, dac_counts_, reading_);
  if (outcome != UsbOutcome::ok) {
    return fault_of(outcome);
  }
  sent_before_ = std::exchange(sent_, dac_counts_);
  if (!is_echo_right()) {
    return TickFault::wrong_echo;
  }
  largest_step_ = counters_.take(reading_.counter);
  return TickFault::none;
}

// It is not documented whether the echo is of this request or of the previous one: this is
// determined as soon as the two differ, and enforced from then on. A reply that is a tick late
// matches neither.
bool SpidarG6::is_echo_right() noexcept {
  if (!reading_.echo) {
    return true;
  }
  const bool is_of_this = *reading_.echo == sent_;
  const bool is_of_the_one_before = *reading_.echo == sent_before_;
  if (is_of_this != is_of_the_one_before && !echoes_this_request_) {
    echoes_this_request_ = is_of_this;
  }
  return echoes_this_request_.value_or(is_of_this) ? is_of_this : is_of_the_one_before;
}

TickFault SpidarG6::tighten(double share) noexcept {
  const double tension_n = share * settings_.calibration.min_tension_n;
  dac_counts_ = dac_counts_of(PerString::Constant(tension_n), settings_.calibration);
  return exchange();
}

TickFault SpidarG6::home() noexcept {
  counters_.forget();
  is_homed_ = false;
  const TickFault fault = exchange();
  if (fault == TickFault::none) {
    pose_ = {};
    strings_ = strings_at(settings_.geometry, pose_);
    has_position_ = false;
    is_homed_ = true;
  }
  return fault;
}

void SpidarG6::begin() noexcept {
  has_position_ = false;
  guardian_silent_s_ = 0.0;
  if (settings_.watchdog != nullptr) {
    settings_.watchdog->begin();
  }
}

TickFault SpidarG6::read(core::HandState& hand) noexcept {
  if (!is_homed_) {
    return TickFault::not_homed;
  }
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  detail_.pose_residual_m = unknown;
  detail_.closure_margin = unknown;
  const TickFault fault = exchange();
  return fault == TickFault::none ? follow(hand) : fault;
}

// After a pause the intermediate path is unknown: the first tick has no velocity and no limit on
// the step.
TickFault SpidarG6::follow(core::HandState& hand) noexcept {
  PerString length_m = length_at_rest_m_;
  double largest_m_per_count = 0.0;
  for (std::size_t i = 0; i < counters_.counts().size(); ++i) {
    const double metres_per_count = settings_.calibration.strings[i].metres_per_count;
    length_m[static_cast<Eigen::Index>(i)] +=
        metres_per_count * static_cast<double>(counters_.counts()[i]);
    largest_m_per_count = std::max(largest_m_per_count, std::abs(metres_per_count));
  }
  const double step_m = largest_m_per_count * static_cast<double>(largest_step_);
  if (has_position_ && step_m > settings_.limits.max_string_speed_m_s * settings_.dt_s) {
    return TickFault::counter_jumped;
  }
  const FoundPose found = find_pose(settings_.geometry, length_m, pose_,
                                    has_position_ ? rounds_a_tick : rounds_from_anywhere);
  detail_.pose_residual_m = found.residual_m;
  if (!found.has_converged || !(found.residual_m <= settings_.limits.max_residual_m)) {
    return TickFault::strings_disagree;
  }
  const core::Vec3 difference_m_s = (found.pose.position_m - pose_.position_m) / settings_.dt_s;
  const double share = 1.0 - std::exp(-settings_.dt_s / velocity_time_s);
  velocity_m_s_ = has_position_ ? velocity_m_s_ + share * (difference_m_s - velocity_m_s_)
                                : core::Vec3::Zero().eval();
  has_position_ = true;
  pose_ = found.pose;
  strings_ = found.strings;
  detail_.closure_margin = closure_margin(strings_);
  hand = {with_z_turned(pose_.position_m), with_z_turned(velocity_m_s_)};
  const bool is_turned_too_far =
      rotation_vector_rad(pose_.rotation).norm() > settings_.limits.max_turn_rad;
  return is_turned_too_far || detail_.closure_margin <= 0.0 ? TickFault::outside_workspace
                                                            : TickFault::none;
}

TickFault SpidarG6::write(const core::Vec3& force_n) noexcept {
  const Tensions tensions =
      tension_solver_.solve(strings_, {with_z_turned(force_n), core::Vec3::Zero()});
  dac_counts_ = dac_counts_of(tensions.tension_n, settings_.calibration);
  detail_.achieved_n = with_z_turned(tensions.achieved.force_n);
  return TickFault::none;
}

// The strings are kept taut, so that the pose remains known.
void SpidarG6::zero_force() noexcept {
  static_cast<void>(write(core::Vec3::Zero()));
  if (exchange() != TickFault::none) {
    emergency_stop();
  }
  end_watchdog();
}

void SpidarG6::end_watchdog() const noexcept {
  if (settings_.watchdog != nullptr) {
    settings_.watchdog->end();
  }
}

void SpidarG6::emergency_stop() noexcept {
  is_homed_ = false;
  dac_counts_ = {};
  for (int i = 0; i < zero_force_packets; ++i) {
    BoardReading ignored;
    static_cast<void>(board_.exchange(pipe_, dac_counts_, ignored));
  }
  sent_ = sent_before_ = dac_counts_;
  end_watchdog();
}
}  // namespace tapstudy::device
