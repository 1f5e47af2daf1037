#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runner/recordings/writers.hpp"
namespace tapstudy::runner {
namespace {
using analysis::Estimate;
using analysis::Standing;

std::string interval(const Estimate& estimate) {
  return fmt::format("{:.6g} to {:.6g}", estimate.interval.low, estimate.interval.high);
}

void print_taps(const TapIdentification& found) {
  fmt::print("{} taps ({}), {:g} to {:g} Hz\n\n", found.taps.size(), name(found.question.quantity),
             found.band.low_hz, found.band.high_hz);
  fmt::print("  tap  at_s      decay_s  agreed  explained  recording\n");
  for (std::size_t i = 0; i < found.taps.size(); ++i) {
    const IdentifiedTap& tap = found.taps[i];
    const auto agreed =
        std::ranges::count(tap.modes.modes, Standing::agreed, &analysis::TapMode::standing);
    fmt::print("  {:>3}  {:<8.3f}  {:>7.3f}  {:>6}  {:>7.1f} %  {}, {}\n", i + 1, tap.time_s,
               tap.decay.duration_s(), agreed, 100.0 * tap.modes.fit.explained, tap.file,
               tap.channel);
  }
}

void print_modes(const TapIdentification& found) {
  fmt::print(
      "\nModes (95 % intervals {}{}):\n"
      "  frequency_hz                     damping_ratio                    taps\n",
      found.taps.size() > 1 ? "over taps" : "of this tap's noise",
      found.question.rate_error > 0.0
          ? fmt::format(", and of a rate wrong by {:g} %", 100.0 * found.question.rate_error)
          : "");
  for (const analysis::RepeatedMode& mode : found.modes) {
    fmt::print("  {:>9.3f}  {:<20}  {:>9.5f}  {:<20}  {:>2} of {}{}\n", mode.frequency_hz.value,
               interval(mode.frequency_hz), mode.damping_ratio.value, interval(mode.damping_ratio),
               mode.standing == Standing::agreed ? mode.agreed : mode.taps, found.taps.size(),
               mode.standing == Standing::agreed ? mode.why.empty() ? "" : "  " + mode.why
               : mode.standing == Standing::line ? "  no mode: " + mode.why
                                                 : "  doubtful: " + mode.why);
  }
}

void print_rayleigh(const analysis::RayleighFit& fit) {
  fmt::print("\nRayleigh damping: alpha {:.4g} 1/s ({}), beta {:.4g} s ({})\n",
             fit.alpha_per_s.value, interval(fit.alpha_per_s), fit.beta_s.value,
             interval(fit.beta_s));
  if (fit.p) {
    fmt::print("  chi-squared {:.3g} of {:g} degrees of freedom, p {:.2g}{}; ", fit.chi_squared,
               fit.degrees_of_freedom, *fit.p,
               fit.p_is_of_f ? " (by F: the ratios' errors are of few taps)" : "");
  } else {
    fmt::print("  two modes cannot say whether it fits; ");
  }
  fmt::print("largest misfit of a ratio {:.1f} % at {:.1f} Hz{}\n", 100.0 * fit.largest_misfit,
             fit.at_hz, fit.fits() ? "" : ": does not fit, take a ratio for each mode");
  if (fit.is_bounded) {
    fmt::print("  a coefficient would have been negative and is held at 0\n");
  }
}

void print_sinusoid(const SinusoidLaw& law) {
  fmt::print(
      "\nDecaying sinusoid: decay {:.6g} 1/s ({}), frequency {:.6g} Hz ({}); explains {:.0f} % of "
      "the taps\n",
      law.decay_per_s.value, interval(law.decay_per_s), law.frequency_hz.value,
      interval(law.frequency_hz), 100.0 * law.explained);
  if (law.amplitude_per_speed) {
    fmt::print("  amplitude per impact speed {:.4g} ({}), SI\n", law.amplitude_per_speed->value,
               std::isfinite(law.amplitude_per_speed->interval.high)
                   ? interval(*law.amplitude_per_speed)
                   : "one tap: no interval");
  }
  if (!law.is_of_one_sensor) {
    fmt::print(
        "  no amplitude by speed: the recordings are of several sensors (--column takes one)\n");
  }
  if (law.line) {
    fmt::print("  by a line: {:.4g} ({}) + {:.4g} ({}) per m/s{}\n", law.line->offset.value,
               interval(law.line->offset), law.line->slope.value, interval(law.line->slope),
               law.line->is_proportional() ? "" : ": the amplitude is not proportional to speed");
  }
  if (law.amplitude_n_s_per_m) {
    fmt::print("  as a force of the protocol's finger {:.4g} N s/m\n", *law.amplitude_n_s_per_m);
  }
}

void print_model(const TapIdentification& found, const ModelComparison& model) {
  fmt::print("\nModel of '{}', material '{}':\n", found.question.stimulus, model.material_name);
  if (!model.update && model.is_on_springs) {
    fmt::print("  neither Young's modulus nor its springs can be told from these modes\n");
    return;
  }
  if (!model.update) {
    fmt::print("  none of its {} modes is within {:.0f} % of a measured one\n",
               model.frequencies_hz.size(), 100.0 * analysis::max_match_difference);
    return;
  }
  const analysis::ModelUpdate& update = *model.update;
  fmt::print("  Young's modulus {:.4g} Pa ({}); before {:.4g} Pa\n", update.youngs_modulus_pa.value,
             interval(update.youngs_modulus_pa), model.material->youngs_modulus_pa);
  if (update.matched.size() == 1) {
    fmt::print("  by one mode: the interval holds its noise, not the model's misfit\n");
  }
  if (model.springs) {
    fmt::print("  springs {:.4g} ({}) times as stiff as the protocol's\n",
               model.springs->factor.value, interval(model.springs->factor));
  }
  fmt::print("  measured_hz  mode  model_hz   misfit after the update{}\n",
             found.places_m.empty() ? "" : "   MAC");
  for (const analysis::MatchedMode& one : update.matched) {
    fmt::print("  {:>11.3f}  {:>4}  {:>8.3f}  {:>+7.2f} %{}\n",
               found.modes[found.agreed[one.measured]].frequency_hz.value, one.model + 1,
               model.frequencies_hz[one.model], 100.0 * one.misfit,
               one.assurance ? fmt::format("{:>20.3f}", *one.assurance) : "");
  }
  for (const std::size_t i : update.unmatched) {
    fmt::print("  {:>11.3f}     -         -  no mode of the model is left for it within {:.0f} %\n",
               found.modes[found.agreed[i]].frequency_hz.value,
               100.0 * analysis::max_match_difference);
  }
  if (update.rival_pa) {
    fmt::print("  another assignment fits nearly as well, with {:.4g} Pa: which is right?\n",
               *update.rival_pa);
  }
}
}  // namespace

void print(const TapIdentification& found) {
  print_taps(found);
  print_modes(found);
  if (found.rayleigh) {
    print_rayleigh(*found.rayleigh);
  }
  if (found.sinusoid) {
    print_sinusoid(*found.sinusoid);
  }
  if (found.model) {
    print_model(found, *found.model);
  }
  if (found.model && found.model->is_held_rigidly) {
    fmt::print(
        "\nThe model holds its fixations rigidly; their stiffness is identified where they are on "
        "springs_n_per_m.\n");
  }
  for (const std::string& remark : found.remarks) {
    fmt::print("  {}\n", remark);
  }
}
}  // namespace tapstudy::runner
