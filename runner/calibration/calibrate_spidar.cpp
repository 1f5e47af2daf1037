#include "runner/calibration/calibrate_spidar.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cmath>
#include <cstdlib>

#include "device/device.hpp"
namespace tapstudy::runner {
namespace {
using device::Digits;
using device::StringCalibration;
constexpr double longest_pull_m = 0.5;  // a 16 bit counter turns over after twice that
constexpr double strongest_n = 30.0;
constexpr std::int64_t fewest_counts = 500;
// The scale of the amplifier's converter as published; with volts a newton only their product is
// measured, and only that matters.
constexpr double digits_per_volt = 415.0;
// Of the force at the stronger output: what friction may add to both.
constexpr double most_offset = 0.3;

class Calibration {
 public:
  Calibration(device::SpidarBoard& board, device::UsbPipe& pipe, Operator& person)
      : board_{board}, pipe_{pipe}, person_{person} {
    device::BoardReading reading;
    check(board_.begin(pipe_, reading));
  }
  ~Calibration() {
    device::BoardReading ignored;
    static_cast<void>(board_.exchange(pipe_, Digits{}, ignored));
  }
  Calibration(const Calibration&) = delete;
  Calibration& operator=(const Calibration&) = delete;
  Calibration(Calibration&&) = delete;
  Calibration& operator=(Calibration&&) = delete;

  StringCalibration measure(std::size_t string) {
    const double metres_per_count = measure_length(string);
    const double weak_n = force_at(string, calibration_digits / 2);
    const double strong_n = force_at(string, calibration_digits);
    put_out({});
    const double newtons_per_digit = (strong_n - weak_n) / (0.5 * calibration_digits);
    const double offset_n = strong_n - newtons_per_digit * calibration_digits;
    if (!(newtons_per_digit > 0.0) || std::abs(offset_n) > most_offset * strong_n) {
      throw device::DeviceError{fmt::format(
          "string {}: {} N and {} N at outputs of {} and {} do not grow in proportion (does the "
          "gauge hold still? is the amplifier on?)",
          string + 1, weak_n, strong_n, calibration_digits / 2, calibration_digits)};
    }
    return {metres_per_count, 1.0 / (newtons_per_digit * digits_per_volt), digits_per_volt};
  }

 private:
  static void check(device::UsbOutcome outcome) {
    if (outcome != device::UsbOutcome::ok) {
      throw device::DeviceError{fmt::format("SPIDAR-G6: {}", to_text(outcome))};
    }
  }
  device::BoardReading put_out(const Digits& digits) {
    device::BoardReading reading;
    check(board_.exchange(pipe_, digits, reading));
    return reading;
  }
  double measure_length(std::size_t string) {
    device::UnwrappedCounters counters{board_.counter_bits()};
    person_.please(fmt::format("\nString {} of 8. Let it run in as far as it goes", string + 1));
    counters.take(put_out({}).counter);
    const double length_m = person_.how_much(
        "Pull it out by about 0.1 m, hold it, and type by how many metres", longest_pull_m);
    counters.take(put_out({}).counter);
    const std::int64_t counts = counters.counts().at(string);
    if (std::abs(counts) < fewest_counts) {
      throw device::DeviceError{fmt::format(
          "string {}: its encoder counted {} for {} m (is it this string? is the encoder plugged "
          "in?)",
          string + 1, counts, length_m)};
    }
    return length_m / static_cast<double>(counts);
  }
  double force_at(std::size_t string, int output) {
    Digits digits{};
    digits.at(string) = static_cast<std::uint16_t>(output);
    put_out(digits);
    return person_.how_much(
        fmt::format("Hold it by the gauge at output {}, and type how many newtons it shows",
                    output),
        strongest_n);
  }

  device::SpidarBoard& board_;
  device::UsbPipe& pipe_;
  Operator& person_;
};
}  // namespace

std::array<StringCalibration, device::strings> calibrate_spidar(device::SpidarBoard& board,
                                                                device::UsbPipe& pipe,
                                                                Operator& person) {
  Calibration calibration{board, pipe, person};
  std::array<StringCalibration, device::strings> strings;
  for (std::size_t i = 0; i < strings.size(); ++i) {
    strings.at(i) = calibration.measure(i);
  }
  return strings;
}

void write_calibration(std::ostream& out, const std::string& type,
                       const std::array<StringCalibration, device::strings>& strings) {
  fmt::print(out,
             "# Measured on one device, string by string; good for no other.\n"
             "format: tapstudy-calibration/1\n"
             "device: spidar-g6\n"
             "type: {}\n"
             "min_tension_n: 0.3\n"
             "max_tension_n: 10\n"
             "strings:\n",
             type);
  for (const StringCalibration& string : strings) {
    fmt::print(out,
               "  - {{metres_per_count: {:.6g}, volts_per_newton: {:.6g}, digits_per_volt: {}}}\n",
               string.metres_per_count, string.volts_per_newton, string.digits_per_volt);
  }
}
}  // namespace tapstudy::runner
