// Section 5.1: a step of the modal simulation takes 0.18 ms on average and no more than 0.22 ms.
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/techniques/make_renderer.hpp"
#include "runner/accuracy/felt_force.hpp"
#include "runner/reproduction/claim_table.hpp"
#include "runner/reproduction/shipped_protocols.hpp"
namespace tapstudy::runner {
namespace {
constexpr double printed_mean_ms = 0.18;
constexpr double printed_longest_ms = 0.22;
constexpr Eigen::Index printed_modes_in_band = 55;
constexpr int timed_ticks = 20'000;

// With as many modes as the paper simulates, wherever below wide_hz their frequencies lie.
core::VibratingPlate plate_with_printed_modes(Bench& bench, protocols::Protocol protocol,
                                              const std::string& name, double wide_hz) {
  protocol.band_limit_hz = wide_hz;
  const auto stimulus = stimulus_with(protocol, protocol.stimulus(name));
  const auto body = bench.models.body_of(protocol, stimulus);
  const core::Material& material = *stimulus.material;
  const double hz_per_kappa =
      std::sqrt(material.youngs_modulus_pa / material.density_kg_per_m3) / (2.0 * std::numbers::pi);
  const double last_hz =
      hz_per_kappa *
      body->kappa_rad_per_m[std::min(printed_modes_in_band, body->kappa_rad_per_m.size()) - 1];
  return core::VibratingPlate{core::model_of(*body, material, (1.0 + 1e-9) * last_hz)};
}

// Of this thread: while another program runs, none passes.
double processor_time_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Each tick by itself, in contact.
double longest_tick_ms(const core::VibratingPlate& plate, const core::Shape& shape,
                       const core::RenderSettings& settings) {
  core::TapRenderer renderer =
      core::make_renderer(plate_alone(), settings, touched_shape(shape), &plate);
  double longest_s = 0.0;
  for (int tick = 0; tick < timed_ticks; ++tick) {
    const double start_s = processor_time_s();
    renderer.tick({core::Vec3{0.0, 0.0, -1e-4}, core::Vec3::Zero()});
    longest_s = std::max(longest_s, processor_time_s() - start_s);
  }
  return 1e3 * longest_s;
}

Method timed(Bench& bench, const std::string& name, const std::string& file,
             const std::string& stimulus_name, double wide_hz) {
  const protocols::Protocol protocol = shipped_protocol(file);
  const auto stimulus = stimulus_with(protocol, protocol.stimulus(stimulus_name));
  const core::VibratingPlate plate =
      plate_with_printed_modes(bench, protocol, stimulus_name, wide_hz);
  const core::Shape& shape = stimulus.plate->shape;
  const double typical_ms =
      1e-6 * tick_ns(plate, shape, stimulus.rendering, {core::Vec3::Zero(), 0.3});
  return {
      name,
      fmt::format("tapstudy trade {} --stimulus {} --quick", file, stimulus_name),
      {shown("modes", static_cast<double>(plate.model.frequency_hz.size())),
       at_most(printed_mean_ms, "typical time of a tick", typical_ms, "ms"),
       at_most(printed_longest_ms, fmt::format("longest processor time of {} ticks", timed_ticks),
               longest_tick_ms(plate, shape, stimulus.rendering), "ms"),
       shown("times faster than printed", printed_mean_ms / typical_ms)}};
}
}  // namespace

std::vector<Claim> step_time(Bench& bench) {
  Claim claim{.name = "step_time",
              .section = "section 5.1",
              .statement = fmt::format(
                  "A step of the simulation with {} modes takes {} ms on average and less "
                  "than {} ms, so that the loop keeps 1 ms.",
                  printed_modes_in_band, printed_mean_ms, printed_longest_ms),
              .rule =
                  "On this machine, which is another than the paper's, the median over batches of "
                  "1000 ticks is at most the printed mean, and no tick takes more of the "
                  "processor's time than the printed maximum."};
  claim.methods.push_back(timed(bench, std::string{method::printed},
                                "protocols/paper/plate_model.yaml", "aluminium", 4500.0));
  claim.methods.push_back(timed(bench, std::string{method::recommended},
                                "protocols/recommended/forces.yaml", "aluminium_four", 1400.0));
  claim.remarks.emplace_back(
      "The command measures the same tick with the modes that the study's own band holds. Times "
      "are measured anew each time; a busy machine has longer ones.");
  return {claim};
}
}  // namespace tapstudy::runner
