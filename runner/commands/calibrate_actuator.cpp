#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "analysis/modal/recording/recording.hpp"
#include "analysis/modal/response/swept_sine.hpp"
#include "core/error.hpp"
#include "core/tick/actuator_voice.hpp"
#include "device/audio/pace.hpp"
#include "device/device.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/session/devices/actuator_card.hpp"
#include "runner/session/devices/rigs.hpp"
#include "runner/terminal/terminal_output.hpp"
namespace tapstudy::runner {
namespace {
struct ActuatorCalibration {
  std::string rig;
  bool plays{false};
  std::string recording;
  std::string column;
  std::string reference_column;
  double newtons_per_unit{0.0};  // 0: not given
  double force_n{0.0};           // 0: a tenth of what the limits allow
  double from_hz{40.0};
  double to_hz{1000.0};
  double seconds{5.0};
  int repeats{4};
  int points{24};
  double min_coherence{0.9};
};

core::ActuatorOutput actuator_in(const std::string& rig_file) {
  const protocols::Rig rig = read_rig(rig_file);
  if (!rig.actuator) {
    throw core::InvalidInput{fmt::format("{}: the rig has no section 'actuator'", rig_file)};
  }
  return *rig.actuator;
}

analysis::SweptSine sweep_of(const ActuatorCalibration& options,
                             const core::ActuatorOutput& actuator) {
  if (options.from_hz >= options.to_hz) {
    throw core::InvalidInput{"--from-hz is not below --to-hz"};
  }
  if (options.repeats < 2 || options.repeats > 100) {
    throw core::InvalidInput{"--repeats: 2 to 100, whose difference tells the coherence"};
  }
  if (options.points < 2 || options.points > 1000) {
    throw core::InvalidInput{"--points: 2 to 1000"};
  }
  return {static_cast<double>(actuator.rate_hz), options.from_hz, options.to_hz, options.seconds,
          options.repeats};
}

// The amplitude of the sweep; a sine's RMS is its root half.
double amplitude_n(const ActuatorCalibration& options, const core::ActuatorOutput& actuator) {
  constexpr double usual_share = 0.1;
  const double most_n = std::min(
      {actuator.limits.peak_n, actuator.full_scale_n, std::numbers::sqrt2 * actuator.limits.rms_n});
  if (options.force_n > most_n) {
    throw core::InvalidInput{fmt::format(
        "--force-n {} is above what the rig's limits allow, {:.4g} N", options.force_n, most_n)};
  }
  return options.force_n > 0.0 ? options.force_n : usual_share * most_n;
}

// Through the limiter of a session, and until the card has played the last sample.
void play(const std::vector<double>& sweep, double force_n, const core::ActuatorOutput& actuator) {
  const auto card = open_actuator_card(actuator);
  core::ActuatorLimiter limiter{
      {std::min(actuator.limits.peak_n, actuator.full_scale_n), actuator.limits.rms_n},
      1.0 / actuator.rate_hz};
  std::vector<float> period(card->period_frames());
  device::Pace pace{*card, 1.0};
  card->begin();
  for (std::size_t at = 0; at < sweep.size() + card->buffer_frames(); at += period.size()) {
    for (std::size_t i = 0; i < period.size(); ++i) {
      const double wanted_n = at + i < sweep.size() ? force_n * sweep[at + i] : 0.0;
      period[i] = static_cast<float>(limiter.limited(wanted_n) / actuator.full_scale_n);
    }
    const device::PcmOutcome outcome = card->write(period);
    if (outcome != device::PcmOutcome::played) {
      card->end();
      throw device::DeviceError{
          outcome == device::PcmOutcome::gone
              ? fmt::format("the actuator's card plays no more ({})", card->failure())
              : "the sweep has had a gap: play it again with nothing else running"};
    }
    pace.wait_after(period.size());
  }
  card->end();
}

std::vector<double> channel_of(const ActuatorCalibration& options, const std::string& column,
                               double rate_hz) {
  analysis::Recording recording =
      analysis::read_recording(options.recording, {.rate_hz = 0.0, .column = column});
  constexpr double same_rate = 1e-3;
  if (std::abs(recording.rate_hz / rate_hz - 1.0) > same_rate) {
    throw core::InvalidInput{
        fmt::format("{}: {} Hz, and the sweep was played at {} Hz: record at "
                    "the rig's actuator.rate_hz",
                    options.recording, recording.rate_hz, rate_hz)};
  }
  return std::move(recording.samples);
}

// As the reader of rigs takes them.
bool is_usable(const analysis::ResponsePoint& point, double min_coherence) {
  return point.coherence >= min_coherence && point.gain >= 1e-3 && point.gain <= 1e3;
}

void print(const analysis::SweptResponse& response, const ActuatorCalibration& options) {
  fmt::print("# {} sweeps from {:g} to {:g} Hz; phase {}\nresponse:\n  points:\n", options.repeats,
             options.from_hz, options.to_hz,
             options.reference_column.empty()
                 ? "against the largest value of the impulse response, whose delay is left out"
                 : "against the command as recorded");
  int used = 0;
  for (const analysis::ResponsePoint& point : response.points) {
    const bool is_used = is_usable(point, options.min_coherence);
    used += is_used ? 1 : 0;
    fmt::print(
        "    {}- {{frequency_hz: {:.5g}, gain: {:.4g}, phase_deg: {:.1f}}}  # coherence "
        "{:.3f}\n",
        is_used ? "" : "# left out ", point.frequency_hz, point.gain,
        180.0 / std::numbers::pi * point.phase_rad, point.coherence);
  }
  if (used == 0) {
    throw core::InvalidInput{fmt::format(
        "{}: nowhere is the coherence {} or more, with a gain between 0.001 and 1000: is the sweep "
        "in this channel, and --newtons-per-unit right?",
        options.recording, options.min_coherence)};
  }
}

void run_calibrate_actuator(const ActuatorCalibration& options) {
  if (options.plays != options.recording.empty()) {
    throw core::InvalidInput{"either --play, or --recording of what was played"};
  }
  const core::ActuatorOutput actuator = actuator_in(options.rig);
  const analysis::SweptSine sweep = sweep_of(options, actuator);
  const double force_n = amplitude_n(options, actuator);
  const std::vector<double> samples = analysis::samples_of(sweep);
  if (options.plays) {
    play(samples, force_n, actuator);
    fmt::print("played {} sweeps of {:.4g} N, {:.1f} s\n", sweep.repeats, force_n,
               static_cast<double>(samples.size()) / sweep.rate_hz);
    return;
  }
  if (options.newtons_per_unit <= 0.0) {
    throw core::InvalidInput{
        "--newtons-per-unit is needed: the force on the finger that a unit of the recording stands "
        "for (of sound, full scale; of an accelerometer, times the mass that it moves)"};
  }
  std::vector<double> recorded = channel_of(options, options.column, sweep.rate_hz);
  for (double& sample : recorded) {
    sample *= options.newtons_per_unit / force_n;
  }
  const std::vector<double> reference =
      options.reference_column.empty()
          ? std::vector<double>{}
          : channel_of(options, options.reference_column, sweep.rate_hz);
  print(analysis::response_to(sweep, recorded, reference, options.points), options);
}
}  // namespace

void add_calibrate_actuator(CommandParser& line) {
  Command command = line.add(
      "calibrate-actuator",
      "Play a swept sine through a rig's actuator, or find its response in a recording of that");
  const auto options = std::make_shared<ActuatorCalibration>();
  command.shipped_file("rig", options->rig, "Rig with a section actuator (YAML)");
  command.flag("--play", options->plays, "Play the sweeps, while a sensor is recorded");
  command.option("--recording", options->recording,
                 "What was recorded meanwhile, at the rate of the card (any file that identify "
                 "reads); prints the rig's lines");
  command.option("--column", options->column, "Channel of the sensor: its name, or number from 1");
  command.option("--reference-column", options->reference_column,
                 "Channel in which the command itself was recorded, for the phase");
  command.number_within("--newtons-per-unit", options->newtons_per_unit, 0.0, 1e9,
                        "Force on the finger that a unit of the recording stands for");
  command.number_within("--force-n", options->force_n, 0.0, 1000.0,
                        "Amplitude; 0: a tenth of what the rig's limits allow");
  command.number_within("--from-hz", options->from_hz, 5.0, 20'000.0, "Lowest frequency");
  command.number_within("--to-hz", options->to_hz, 10.0, 40'000.0, "Highest frequency");
  command.number_within("--seconds", options->seconds, 0.1, 60.0, "Of one sweep");
  command.option_with_default("--repeats", options->repeats, "Sweeps");
  command.option_with_default("--points", options->points, "Frequencies");
  command.number_within("--min-coherence", options->min_coherence, 0.0, 1.0,
                        "Frequencies of less are left out");
  command.on_run([options] { run_calibrate_actuator(*options); });
}
}  // namespace tapstudy::runner
