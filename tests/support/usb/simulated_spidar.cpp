#include "support/usb/simulated_spidar.hpp"

#include <cmath>
namespace tapstudy::testing {
namespace {
constexpr int steps_a_tick = 20;
constexpr double mass_kg = 0.1;
constexpr double muscle_n_per_m = 400.0;
constexpr double muscle_n_s_per_m = 9.0;
constexpr double newtons_per_dac_count = 1.0 / (0.365296803653 * 415.0);
// Counts fall as strings 0, 1, 6 and 7 get longer, and rise as the others do.
constexpr std::array<int, 8> sign{-1, -1, 1, 1, 1, 1, -1, -1};
constexpr double metres_per_count = 1.66555e-5;

// Little-endian.
void put(Bytes& bytes, std::size_t at, std::int64_t value, std::size_t size = 2) {
  for (std::size_t i = 0; i < size; ++i) {
    bytes[at + i] = static_cast<std::uint8_t>(value >> 8 * i & 0xFF);
  }
}
}  // namespace

core::SpidarCalibration SimulatedSpidar::calibration() {
  core::SpidarCalibration calibration;
  for (std::size_t i = 0; i < sign.size(); ++i) {
    calibration.strings.at(i) = {sign.at(i) * metres_per_count, 0.365296803653, 415.0};
  }
  calibration.min_tension_n = 0.3;
  calibration.max_tension_n = 10.0;
  return calibration;
}

void SimulatedSpidar::pass_a_tick() {
  ++ticks_;
  if (is_rigid_) {
    return;
  }
  for (int step = 0; step < steps_a_tick; ++step) {
    const device::Strings strings =
        strings_at(geometry_, {position_m_, Eigen::Matrix3d::Identity()});
    const core::Vec3 pull_n = strings.pull.leftCols<3>().transpose() * tension_n_;
    const core::Vec3 force_n =
        pull_n + muscle_n_per_m * (aim_m_ - position_m_) - muscle_n_s_per_m * velocity_m_s_;
    velocity_m_s_ += tick_s_ / steps_a_tick / mass_kg * force_n;
    position_m_ += tick_s_ / steps_a_tick * velocity_m_s_;
  }
}

std::array<std::int64_t, 8> SimulatedSpidar::counters() const {
  if (stopped_at_) {
    std::array<std::int64_t, 8> all = *stopped_at_;
    const int sample = ticks_ % repeated_samples_;
    for (std::size_t i = 0; i < all.size(); ++i) {
      all.at(i) += sample >> i & 1;
    }
    return all;
  }
  std::array<std::int64_t, 8> all{};
  const device::PerString length_m =
      strings_at(geometry_, {position_m_, Eigen::Matrix3d::Identity()}).length_m;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const auto counts =
        std::llround(sign.at(i) * (length_m[k] - length_at_rest_m_[k]) / metres_per_count);
    all.at(i) = first_count_ + counts + slip_.at(i);
  }
  return all;
}

// The counters are latched when the request arrives, before its outputs act.
Bytes SimulatedSpidar::reply_with_counters() const {
  Bytes bytes(512, 0);
  const auto counts = counters();
  for (std::size_t i = 0; i < 8; ++i) {
    put(bytes, 16 + 2 * i, counts.at(i));
    put(bytes, 32 + 2 * i, is_amplifier_on_ ? dac_counts_.at(i) : 0);
  }
  put(bytes, 48, rotary_switch_ << 4);
  return bytes;
}

void SimulatedSpidar::echo_into(Bytes& reply) const {
  const auto& echoed = echoes_the_request_before_ ? dac_counts_before_ : dac_counts_;
  for (std::size_t i = 0; i < 8; ++i) {
    put(reply, 2 * i, echoed.at(i) + (echoes_wrongly_ ? 1 : 0));
  }
}

void SimulatedSpidar::take_outputs(std::span<const std::uint8_t> words) {
  dac_counts_before_ = dac_counts_;
  for (std::size_t i = 0; i < 8; ++i) {
    dac_counts_.at(i) = static_cast<std::uint16_t>(words[2 * i] | words[2 * i + 1] << 8);
    tension_n_[static_cast<Eigen::Index>(i)] =
        is_amplifier_on_ ? newtons_per_dac_count * dac_counts_.at(i) : 0.0;
  }
}

// Outputs and the reading of the counters are two commands; a tick passes before the outputs.
Bytes SimulatedSpidar::answer_as_simple_board(std::span<const std::uint8_t> request) {
  if (request[0] == 0x52) {
    pass_a_tick();
    take_outputs(request.subspan(1));
  }
  if (request[0] != 0x51) {
    return {};
  }
  Bytes latched(32, 0);
  const auto counts = counters();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    put(latched, 3 * i, counts.at(i), 3);
  }
  put(latched, 24, rotary_switch_ << 4, 1);
  return latched;
}

Bytes SimulatedSpidar::answer(std::span<const std::uint8_t> request) {
  if (request.size() == 32) {
    return answer_as_simple_board(request);
  }
  if (request.size() != 512 || request[0] != 0x01 || request[1] != 0x0E) {
    return {};
  }
  pass_a_tick();  // since the request before, under the outputs that it set
  Bytes latched = reply_with_counters();
  take_outputs(request.subspan(2));
  echo_into(latched);
  return latched;
}
}  // namespace tapstudy::testing
