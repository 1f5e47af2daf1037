#include "device/spidar/calibration_procedure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <span>

#include "device/device.hpp"
#include "device/spidar/board.hpp"
#include "device/spidar/calibration.hpp"
namespace tapstudy::device {
namespace {
using core::StringCalibration;
constexpr double max_pull_m = 0.5;  // a 16-bit counter wraps after twice that
constexpr double max_gauge_force_n = 30.0;
constexpr std::int64_t min_counts = 500;
// The published scale of the amplifier's DAC; only its product with volts per newton is measured,
// and only the product matters.
constexpr double dac_counts_per_volt = 415.0;
constexpr double min_tension_n = 0.3;
constexpr double max_tension_n = 10.0;
// Largest offset due to friction, as a fraction of the force at the stronger output.
constexpr double max_offset = 0.3;

// While a string pulls: the guardian monitors the program, for a limited time.
class Pull {
 public:
  Pull(SpidarBoard& board, UsbPipe& pipe, WatchdogChannel& watchdog, TickClock& clock,
       CalibrationOperator& person)
      : board_{board},
        pipe_{pipe},
        watchdog_{watchdog},
        clock_{clock},
        person_{person},
        started_{clock.now()} {
    if (!is_guardian_alive(watchdog_)) {
      throw DeviceError{"SPIDAR-G6: the watchdog process has ended"};
    }
    watchdog_.begin();
  }
  ~Pull() {
    bool is_confirmed = false;  // by the last reply: earlier ones may be stale
    for (int i = 0; i < zero_force_packets; ++i) {
      is_confirmed = exchange_zeros(board_, pipe_).is_confirmed;
    }
    if (is_confirmed) {
      watchdog_.end();
    } else {
      watchdog_.repeat_zero_force();
      person_.warn(force_may_be_on);
    }
  }
  Pull(const Pull&) = delete;
  Pull& operator=(const Pull&) = delete;
  Pull(Pull&&) = delete;
  Pull& operator=(Pull&&) = delete;

  void check_goes_on() const {
    watchdog_.beat();
    if (watchdog_.has_acted()) {
      throw DeviceError{"SPIDAR-G6: the program stood still and its guardian took the force off"};
    }
    if (1e-9 * static_cast<double>(clock_.now() - started_) > max_pull_s) {
      throw DeviceError{fmt::format(
          "SPIDAR-G6: a string was under tension for {} s without operator input", max_pull_s)};
    }
  }

 private:
  SpidarBoard& board_;
  UsbPipe& pipe_;
  WatchdogChannel& watchdog_;
  TickClock& clock_;
  CalibrationOperator& person_;
  Nanoseconds started_;
};

class Calibration {
 public:
  Calibration(SpidarBoard& board, UsbPipe& pipe, WatchdogChannel& watchdog, TickClock& clock,
              CalibrationOperator& person)
      : board_{board}, pipe_{pipe}, watchdog_{watchdog}, clock_{clock}, person_{person} {
    BoardReading reading;
    check(board_.begin(pipe_, reading));
    watchdog_.allow_power();
  }
  ~Calibration() {
    BoardReading ignored;
    static_cast<void>(board_.exchange(pipe_, DacCounts{}, ignored));
  }
  Calibration(const Calibration&) = delete;
  Calibration& operator=(const Calibration&) = delete;
  Calibration(Calibration&&) = delete;
  Calibration& operator=(Calibration&&) = delete;

  // Into the next place, until it is plausible.
  void measure_next(std::span<StringCalibration> up_to_next) {
    StringCalibration& next = up_to_next.back();
    while (true) {
      const std::optional<StringCalibration> measured = measured_once(up_to_next.size());
      if (measured) {
        next = *measured;
        const auto in = differing_quantity(up_to_next);
        if (!in) {
          return;
        }
        person_.warn(*in);
      }
      person_.warn(fmt::format("String {} once more:", up_to_next.size()));
    }
  }

 private:
  static void check(UsbOutcome outcome) {
    if (outcome != UsbOutcome::ok) {
      throw DeviceError{fmt::format("SPIDAR-G6: {}", to_text(outcome))};
    }
  }
  BoardReading put_out(const DacCounts& dac_counts) {
    BoardReading reading;
    check(board_.exchange(pipe_, dac_counts, reading));
    return reading;
  }
  // Nothing if a reading is implausible, which the operator is told. Strings count from 1.
  std::optional<StringCalibration> measured_once(std::size_t string) {
    const std::optional<double> metres_per_count = measured_length(string);
    if (!metres_per_count) {
      return std::nullopt;
    }
    const double weak_n = force_at(string, calibration_dac_counts / 2);
    const double strong_n = force_at(string, calibration_dac_counts);
    const double newtons_per_dac_count = (strong_n - weak_n) / (0.5 * calibration_dac_counts);
    const double offset_n = strong_n - newtons_per_dac_count * calibration_dac_counts;
    if (!(newtons_per_dac_count > 0.0) || std::abs(offset_n) > max_offset * strong_n) {
      person_.warn(fmt::format(
          "string {}: {} N and {} N at outputs of {} and {} are not proportional (is the gauge "
          "held still? is the amplifier on?)",
          string, weak_n, strong_n, calibration_dac_counts / 2, calibration_dac_counts));
      return std::nullopt;
    }
    return StringCalibration{*metres_per_count, 1.0 / (newtons_per_dac_count * dac_counts_per_volt),
                             dac_counts_per_volt};
  }
  std::optional<double> measured_length(std::size_t string) {  // per encoder count, m
    UnwrappedCounters counters{board_.counter_bits()};
    person_.please(fmt::format("\nString {} of 8. Let it wind in completely", string));
    counters.take(put_out({}).counter);
    const double length_m = person_.how_much(
        "Pull it out by about 0.1 m, hold it, and enter the length in metres", max_pull_m, [] {});
    counters.take(put_out({}).counter);
    const std::int64_t counts = counters.counts().at(string - 1);
    if (std::abs(counts) < min_counts) {
      person_.warn(fmt::format(
          "string {}: its encoder counted {} for {} m (is it this string? is the encoder plugged "
          "in?)",
          string, counts, length_m));
      return std::nullopt;
    }
    return length_m / static_cast<double>(counts);
  }
  double force_at(std::size_t string, int output) {
    DacCounts dac_counts{};
    dac_counts.at(string - 1) = static_cast<std::uint16_t>(output);
    const Pull pull{board_, pipe_, watchdog_, clock_, person_};
    pull.check_goes_on();
    put_out(dac_counts);
    return person_.how_much(
        fmt::format("Hold it with the gauge at output {}, and enter the reading in newtons",
                    output),
        max_gauge_force_n, [&] { pull.check_goes_on(); });
  }

  SpidarBoard& board_;
  UsbPipe& pipe_;
  WatchdogChannel& watchdog_;
  TickClock& clock_;
  CalibrationOperator& person_;
};
}  // namespace

core::SpidarCalibration calibrate_spidar(SpidarBoard& board, UsbPipe& pipe,
                                         WatchdogChannel& watchdog, TickClock& clock,
                                         CalibrationOperator& person) {
  Calibration procedure{board, pipe, watchdog, clock, person};
  core::SpidarCalibration calibration{min_tension_n, max_tension_n, {}};
  for (std::size_t i = 1; i <= calibration.strings.size(); ++i) {
    procedure.measure_next(std::span{calibration.strings}.first(i));
  }
  calibration.max_tension_n = std::min(max_tension_n, highest_tension_n(calibration));
  return calibration;
}
}  // namespace tapstudy::device
