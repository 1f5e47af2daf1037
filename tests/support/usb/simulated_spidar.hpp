#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "device/spidar/calibration.hpp"
#include "device/spidar/kinematics.hpp"
#include "support/usb/fake_usbfs.hpp"
namespace tapstudy::testing {
// A SPIDAR-G6 X3R as it would be: a grip with mass, held by a hand's spring and by eight motors
// whose currents follow the board's outputs, and encoders that count. Time passes with every
// request, one tick each. It knows requests and replies only by their bytes: those of 512 are an
// SH4 board's, those of 32 a Simple board's, which neither echoes nor measures voltages.
class SimulatedSpidar {
 public:
  static core::SpidarCalibration calibration();

  Bytes answer(std::span<const std::uint8_t> request);
  void hold_at(const core::Vec3& position_m) { aim_m_ = position_m; }
  const core::Vec3& position_m() const { return position_m_; }
  const device::PerString& tension_n() const { return tension_n_; }
  void start_counters_at(std::int64_t count) { first_count_ = count; }
  // Off: no tension and no voltage, whatever is commanded.
  void switch_amplifier(bool is_on) { is_amplifier_on_ = is_on; }
  void turn_rotary_switch_to(int position) { rotary_switch_ = position; }
  // Moved from outside instead of by the hand's muscle and the strings.
  void be_rigid() { is_rigid_ = true; }
  void put_at(const core::Vec3& position_m) { position_m_ = position_m; }
  void pass_with_each_request(double seconds) { tick_s_ = seconds; }
  // What the board gets wrong.
  void jump(std::size_t string, int counts) { slip_.at(string) += counts; }
  void echo_wrongly() { echoes_wrongly_ = true; }
  void stop_counting() { stopped_at_ = counters(); }
  // At most 256, which differ by a count of some strings.
  void repeat_samples(int how_many) {
    stop_counting();
    repeated_samples_ = how_many;
  }
  // Which of the two a real board does is not known.
  void echo_the_request_before() { echoes_the_request_before_ = true; }

 private:
  void pass_a_tick();
  std::array<std::int64_t, 8> counters() const;
  void take_outputs(std::span<const std::uint8_t> words);
  Bytes answer_as_simple_board(std::span<const std::uint8_t> request);
  Bytes reply_with_counters() const;
  void echo_into(Bytes& reply) const;
  device::SpidarGeometry geometry_{device::spidar_geometry("X3R")};
  device::PerString length_at_rest_m_{strings_at(geometry_, {}).length_m};
  device::PerString tension_n_{device::PerString::Zero()};
  std::array<std::uint16_t, 8> dac_counts_{};
  std::array<std::uint16_t, 8> dac_counts_before_{};
  core::Vec3 position_m_{core::Vec3::Zero()};
  core::Vec3 velocity_m_s_{core::Vec3::Zero()};
  core::Vec3 aim_m_{core::Vec3::Zero()};
  std::int64_t first_count_{0};
  double tick_s_{1e-3};
  int rotary_switch_{3};
  std::array<int, 8> slip_{};
  std::optional<std::array<std::int64_t, 8>> stopped_at_;
  int repeated_samples_{1};
  int ticks_{0};
  bool is_rigid_{false};
  bool is_amplifier_on_{true};
  bool echoes_wrongly_{false};
  bool echoes_the_request_before_{false};
};
}  // namespace tapstudy::testing
