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
// After a late tick the next may follow at once; a difference over less would be all quantisation.
constexpr double min_step_s = 1e-4;
// Where no position is needed in time.
constexpr int patient_exchanges = 4;
}  // namespace

SpidarG6::SpidarG6(UsbPipe& pipe, SpidarBoard& board, SpidarSettings settings)
    : settings_{std::move(settings)},
      link_{pipe, board, settings_.watchdog, settings_.dt_s},
      board_name_{board.name()},
      tension_solver_{{settings_.calibration.min_tension_n, settings_.calibration.max_tension_n}},
      counters_{board.counter_bits()},
      length_at_rest_m_{strings_at(settings_.geometry, {}).length_m},
      strings_{strings_at(settings_.geometry, {})} {
  if (const UsbOutcome outcome = link_.open(); outcome != UsbOutcome::ok) {
    throw DeviceError{
        fmt::format("SPIDAR-G6: the {} board does not answer: {}", board_name_, to_text(outcome))};
  }
  // a second exchange, because the first may echo an earlier program's command
  if (const TickFault fault = exchange(settings_.dt_s); fault != TickFault::none) {
    throw DeviceError{fmt::format("SPIDAR-G6: the {} board sent an invalid reply: {}", board_name_,
                                  core::to_text(fault))};
  }
}

SpidarG6::~SpidarG6() {
  SpidarG6::emergency_stop();
}

std::string SpidarG6::description() const {
  return fmt::format("SPIDAR-G6 {}, {} board, rotary switch {}", settings_.geometry.type,
                     board_name_, rotary_switch());
}

TickFault SpidarG6::exchange(double elapsed_s) noexcept {
  const TickFault fault = link_.exchange(dac_counts_, elapsed_s);
  if (fault == TickFault::none) {
    largest_step_ = counters_.take(link_.reading().counter);
  }
  return fault;
}

TickFault SpidarG6::exchange_patiently() noexcept {
  TickFault fault = TickFault::no_reply;
  const int exchanges = link_.can_miss_a_reply() ? patient_exchanges : 1;
  for (int i = 0; i < exchanges && fault == TickFault::no_reply; ++i) {
    fault = exchange(settings_.dt_s);
  }
  return fault;
}

TickFault SpidarG6::tighten(double share) noexcept {
  const double tension_n = share * settings_.calibration.min_tension_n;
  dac_counts_ = dac_counts_of(PerString::Constant(tension_n), settings_.calibration);
  return exchange_patiently();
}

TickFault SpidarG6::home() noexcept {
  counters_.forget();
  is_homed_ = false;
  const TickFault fault = exchange_patiently();
  if (fault == TickFault::none) {
    pose_ = {};
    strings_ = strings_at(settings_.geometry, pose_);
    held_.forget();
    is_homed_ = true;
  }
  return fault;
}

TickFault SpidarG6::begin() noexcept {
  held_.forget();
  counts_.forget();
  is_frozen_ = false;
  detail_.missed_replies = 0;
  detail_.unanswered_s = 0.0;
  without_voltage_s_ = 0.0;
  return link_.begin_watch();
}

TickFault SpidarG6::read(core::HandState& hand, double elapsed_s) noexcept {
  if (!is_homed_) {
    return TickFault::not_homed;
  }
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  detail_.pose_residual_m = unknown;
  detail_.closure_margin = unknown;
  detail_.motor_voltage_v = unknown;
  unread_s_ += elapsed_s;
  const TickFault fault = exchange(elapsed_s);
  // without an echo a late reply could not be told from the right one
  if (fault == TickFault::no_reply && link_.can_miss_a_reply() &&
      held_.use_last_reading(hand, elapsed_s)) {
    detail_.missed_replies = held_.missed_replies();
    detail_.unanswered_s = held_.unanswered_s();
    return TickFault::none;
  }
  if (fault != TickFault::none) {
    return fault;
  }
  detail_.missed_replies = 0;
  detail_.unanswered_s = 0.0;
  if (const TickFault off = fault_of_amplifier(elapsed_s); off != TickFault::none) {
    return off;
  }
  return follow(hand, std::max(std::exchange(unread_s_, 0.0), min_step_s));
}

bool SpidarG6::has_motor_voltage() const noexcept {
  return link_.reading().motor_voltage_v.value_or(settings_.limits.min_motor_voltage_v) >=
         settings_.limits.min_motor_voltage_v;
}

// The strings are always under tension here, so some voltage is commanded. Without it they would
// pull all at once when the amplifier is switched on again.
TickFault SpidarG6::fault_of_amplifier(double elapsed_s) noexcept {
  detail_.motor_voltage_v =
      link_.reading().motor_voltage_v.value_or(std::numeric_limits<double>::quiet_NaN());
  const bool is_fine = !settings_.is_amplifier_sensed || has_motor_voltage();
  without_voltage_s_ = is_fine ? 0.0 : without_voltage_s_ + elapsed_s;
  return without_voltage_s_ > settings_.limits.max_without_voltage_s ? TickFault::amplifier_off
                                                                     : TickFault::none;
}

PerString SpidarG6::lengths_m() const noexcept {
  PerString length_m = length_at_rest_m_;
  for (std::size_t i = 0; i < counters_.counts().size(); ++i) {
    length_m[static_cast<Eigen::Index>(i)] += settings_.calibration.strings[i].metres_per_count *
                                              static_cast<double>(counters_.counts()[i]);
  }
  return length_m;
}

double SpidarG6::longest_step_m() const noexcept {
  double largest_m_per_count = 0.0;
  for (const core::StringCalibration& string : settings_.calibration.strings) {
    largest_m_per_count = std::max(largest_m_per_count, std::abs(string.metres_per_count));
  }
  return largest_m_per_count * static_cast<double>(largest_step_);
}

TickFault SpidarG6::fault_of_counters(double elapsed_s) noexcept {
  is_frozen_ = counts_.judge(fingerprint_of(counters_.counts()), force_n_, elapsed_s);
  if (is_frozen_) {
    return TickFault::position_frozen;
  }
  return longest_step_m() > settings_.limits.max_string_speed_m_s * elapsed_s
             ? TickFault::counter_jumped
             : TickFault::none;
}

// After a pause the intermediate path is unknown: the first tick has no velocity and no limit on
// the step.
TickFault SpidarG6::follow(core::HandState& hand, double elapsed_s) noexcept {
  const bool has_position = held_.is_known();
  if (const TickFault fault = fault_of_counters(elapsed_s);
      has_position && fault != TickFault::none) {
    return fault;
  }
  const FoundPose found = find_pose(settings_.geometry, lengths_m(), pose_,
                                    has_position ? rounds_a_tick : rounds_from_anywhere);
  detail_.pose_residual_m = found.residual_m;
  if (!found.has_converged || !(found.residual_m <= settings_.limits.max_residual_m)) {
    return TickFault::strings_disagree;
  }
  if (!has_position) {
    velocity_.forget();
  }
  pose_ = found.pose;
  strings_ = found.strings;
  detail_.closure_margin = closure_margin(strings_);
  hand = {with_z_turned(pose_.position_m),
          with_z_turned(velocity_.take(pose_.position_m, elapsed_s))};
  held_.keep(hand, elapsed_s);
  const bool is_turned_too_far =
      rotation_vector_rad(pose_.rotation).norm() > settings_.limits.max_turn_rad;
  return is_turned_too_far || detail_.closure_margin <= 0.0 ? TickFault::outside_workspace
                                                            : TickFault::none;
}

TickFault SpidarG6::write(const core::Vec3& force_n) noexcept {
  force_n_ = force_n;
  const Tensions tensions =
      tension_solver_.solve(strings_, {with_z_turned(force_n), core::Vec3::Zero()});
  dac_counts_ = dac_counts_of(tensions.tension_n, settings_.calibration);
  detail_.achieved_n = with_z_turned(tensions.achieved.force_n);
  return tensions.is_optimal ? TickFault::none : TickFault::tensions_unsolved;
}

// The strings are kept taut, so that the pose remains known. A board may echo the request before.
StopOutcome SpidarG6::zero_force() noexcept {
  constexpr int exchanges = 2;
  TickFault fault = write(core::Vec3::Zero());
  bool is_echoed = false;
  for (int i = 0; i < exchanges && fault == TickFault::none && !is_echoed; ++i) {
    fault = exchange_patiently();
    is_echoed = fault == TickFault::none && link_.is_last_echoed();
  }
  if (!is_echoed) {
    return emergency_stop();
  }
  link_.end_watch();
  return StopOutcome::confirmed;
}

StopOutcome SpidarG6::emergency_stop() noexcept {
  is_homed_ = false;
  dac_counts_ = {};
  return link_.stop(!is_frozen_);
}
}  // namespace tapstudy::device
