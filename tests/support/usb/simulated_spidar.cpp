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

Bytes SimulatedSpidar::reply() const {
  Bytes bytes(512, 0);
  const auto put = [&](std::size_t at, std::int64_t value) {
    bytes[at] = static_cast<std::uint8_t>(value & 0xFF);
    bytes[at + 1] = static_cast<std::uint8_t>(value >> 8 & 0xFF);
  };
  const device::PerString length_m =
      strings_at(geometry_, {position_m_, Eigen::Matrix3d::Identity()}).length_m;
  for (std::size_t i = 0; i < 8; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const auto counts =
        std::llround(sign.at(i) * (length_m[k] - length_at_rest_m_[k]) / metres_per_count);
    const auto& echoed = echoes_the_request_before_ ? dac_counts_before_ : dac_counts_;
    put(2 * i, echoed.at(i) + (echoes_wrongly_ ? 1 : 0));
    put(16 + 2 * i, first_count_ + counts + slip_.at(i));
  }
  put(48, rotary_switch_ << 4);
  return bytes;
}

Bytes SimulatedSpidar::answer(std::span<const std::uint8_t> request) {
  if (request.size() != 512 || request[0] != 0x01 || request[1] != 0x0E) {
    return {};
  }
  dac_counts_before_ = dac_counts_;
  for (std::size_t i = 0; i < 8; ++i) {
    dac_counts_.at(i) = static_cast<std::uint16_t>(request[2 + 2 * i] | request[3 + 2 * i] << 8);
    tension_n_[static_cast<Eigen::Index>(i)] = newtons_per_dac_count * dac_counts_.at(i);
  }
  pass_a_tick();
  return reply();
}
}  // namespace tapstudy::testing
