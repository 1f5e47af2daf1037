#include "runner/laboratory/identify/modal_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "analysis/modal/decay/pole_estimation.hpp"
#include "core/files/output_files.hpp"
#include "runner/laboratory/identify/assurance_matrix.hpp"
namespace tapstudy::runner {
namespace {
using analysis::Estimate;
using analysis::Standing;

std::string interval(const Estimate& estimate) {
  return fmt::format("{:.6g} to {:.6g}", estimate.interval.low, estimate.interval.high);
}

void print_taps(const TapIdentification& found) {
  fmt::print("\n  tap  at_s      decay_s  modes  explained  recording\n");
  for (std::size_t i = 0; i < found.taps.size(); ++i) {
    const IdentifiedTap& tap = found.taps[i];
    const auto agreed =
        std::ranges::count(tap.modes.modes, Standing::agreed, &analysis::TapMode::standing);
    fmt::print("  {:>3}  {:<8.3f}  {:>7.3f}  {:>5}  {:>7.1f} %  {}, {}\n", i + 1, tap.time_s,
               tap.decay.duration_s(), agreed, 100.0 * tap.modes.fit.explained, tap.file,
               tap.channel);
  }
}

std::string note_of(const analysis::RepeatedMode& mode) {
  switch (mode.standing) {
    case Standing::agreed:
      return mode.at_tap ? fmt::format("at rest; at a tap {:.6g} Hz, {:.3g}",
                                       mode.at_tap->frequency_hz, mode.at_tap->damping_ratio)
                         : mode.why;
    case Standing::line:
    case Standing::combination:
      return "no mode: " + mode.why;
    case Standing::background:
      return "hum or handling: " + mode.why;
    case Standing::doubtful:
      break;
  }
  return "doubtful: " + mode.why;
}

void print_modes(const TapIdentification& found, Listing listing) {
  fmt::print("{} taps ({}), {:g} to {:g} Hz\n\n", found.taps.size(), name(found.question.quantity),
             found.band.low_hz, found.band.high_hz);
  fmt::print(
      "Modes (95 % intervals {}{}):\n"
      "  frequency_hz                     damping_ratio                    taps\n",
      found.taps.size() > 1 ? "over taps" : "of this tap's noise",
      found.question.rate_error > 0.0
          ? fmt::format(", and of a rate wrong by {:g} %", 100.0 * found.question.rate_error)
          : "");
  for (const analysis::RepeatedMode& mode : found.modes) {
    if (mode.standing != Standing::agreed && listing == Listing::modes) {
      continue;
    }
    const std::string note = note_of(mode);
    fmt::print("  {:>9.3f}  {:<20}  {:>9.5f}  {:<20}  {:>2} of {}{}{}\n", mode.frequency_hz.value,
               interval(mode.frequency_hz), mode.damping_ratio.value, interval(mode.damping_ratio),
               mode.standing == Standing::agreed ? mode.agreed : mode.taps, found.taps.size(),
               note.empty() ? "" : "  ", note);
  }
  for (const std::string& other : found.others) {
    fmt::print("  {}{}\n", other, listing == Listing::modes ? " (--all lists them)" : "");
  }
}

void print_rayleigh(const analysis::RayleighFit& fit) {
  fmt::print("\nRayleigh damping: alpha {:.4g} 1/s ({}), beta {:.4g} s ({})\n",
             fit.alpha_per_s.value, interval(fit.alpha_per_s), fit.beta_s.value,
             interval(fit.beta_s));
  if (fit.p) {
    fmt::print("  chi-squared {:.3g} of {:g} degrees of freedom, p {:.2g}{}; ", fit.chi_squared,
               fit.degrees_of_freedom, *fit.p,
               fit.p_is_of_f ? " (by F: the ratios' errors are estimates, too)" : "");
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

void print_model(const ModalFindings& found, const ModelComparison& model) {
  fmt::print("\nModel of '{}', material '{}':\n", found.stimulus, model.material_name);
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
  fmt::print("  Young's modulus{} {:.4g} Pa ({}); before {:.4g} Pa\n",
             model.material->orthotropy ? " along the material's first axis" : "",
             update.youngs_modulus_pa.value, interval(update.youngs_modulus_pa),
             model.material->youngs_modulus_pa);
  if (model.material->orthotropy) {
    fmt::print("  its other moduli, of shear too, are taken to be in proportion to it\n");
  }
  if (update.matched.size() == 1) {
    fmt::print("  by one mode: the interval holds its noise, not the model's misfit\n");
  }
  if (model.springs) {
    fmt::print("  springs {:.4g} ({}) times as stiff as the protocol's\n",
               model.springs->factor.value, interval(model.springs->factor));
  }
  fmt::print(
      "  measured_hz  mode  model_hz   misfit after the update{}\n",
      std::ranges::any_of(update.matched, [](const auto& one) { return one.assurance.has_value(); })
          ? "   MAC"
          : "");
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
  for (const std::string& doubt : model.doubts) {
    fmt::print("  caution: {}\n", doubt);
  }
}
}  // namespace

void print_damping_and_model(const ModalFindings& found) {
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
}

void print(const TapIdentification& found, Listing listing) {
  print_modes(found, listing);
  print_damping_and_model(found);
  print_taps(found);
  fmt::print("{}", found.remarks.empty() ? "" : "\n");
  for (const std::string& remark : found.remarks) {
    fmt::print("  {}\n", remark);
  }
}

namespace {
using analysis::Figure;
using analysis::Mark;
using analysis::Panel;
using analysis::Series;

constexpr std::size_t max_panels = 4;
constexpr Eigen::Index max_points = 1500;

std::string title_of(const TapIdentification& found, std::size_t i) {
  return fmt::format("tap {} at {:.3f} s", i + 1, found.taps[i].time_s);
}

// The sum of the fitted modes at a sample.
double fitted_at(const IdentifiedTap& tap, double sample) {
  double sum = 0.0;
  for (const analysis::FittedMode& mode : tap.modes.fit.modes) {
    const std::complex<double> log_z = log_of(mode.pole, tap.decay.rate_hz);
    sum += mode.amplitude * std::exp(log_z.real() * sample) *
           std::cos(log_z.imag() * sample + mode.phase_rad);
  }
  return sum;
}

Panel time_panel(const IdentifiedTap& tap, const std::string& title) {
  Series measured{"measured", analysis::Axis::left, {}, {}, Mark::broad_line};
  Series fitted{"fitted modes", analysis::Axis::left, {}, {}};
  const Eigen::Index count = std::min(max_points, tap.decay.samples.size());
  for (Eigen::Index n = 0; n < count; ++n) {
    const double t_s = static_cast<double>(n) / tap.decay.rate_hz;
    measured.x.push_back(t_s);
    measured.y.push_back(tap.decay.samples[n]);
    fitted.x.push_back(t_s);
    fitted.y.push_back(fitted_at(tap, static_cast<double>(n)));
  }
  const bool is_cut = count < tap.decay.samples.size();
  return {is_cut ? fmt::format("{}, its first {} samples", title, count) : title,
          {measured, fitted}};
}

double decibels(double magnitude, double largest) {
  constexpr double floor = 1e-6;
  return 20.0 * std::log10(std::max(magnitude / largest, floor));
}

Panel spectrum_panel(const IdentifiedTap& tap, const std::string& title) {
  const analysis::BandSpectrum& spectrum = tap.modes.spectrum;
  const double largest = std::max(spectrum.values.cwiseAbs().maxCoeff(), 1e-300);
  Series measured{"measured", analysis::Axis::left, {}, {}, Mark::broad_line};
  Series fitted{"fitted", analysis::Axis::left, {}, {}};
  for (Eigen::Index k = 0; k < spectrum.values.size(); ++k) {
    const double frequency_hz =
        spectrum.rad_per_sample[k] * spectrum.rate_hz / (2.0 * std::numbers::pi);
    measured.x.push_back(frequency_hz);
    measured.y.push_back(decibels(std::abs(spectrum.values[k]), largest));
    fitted.x.push_back(frequency_hz);
    fitted.y.push_back(decibels(std::abs(tap.modes.fit.fitted[k]), largest));
  }
  return {title, {measured, fitted}};
}

Panel stabilisation_panel(const IdentifiedTap& tap, const std::string& title) {
  Series stable{"poles that the order below has, too", analysis::Axis::left, {}, {}, Mark::points};
  Series poles{"other poles", analysis::Axis::left, {}, {}, Mark::points};
  const std::vector<analysis::Pole>* below = nullptr;
  for (const analysis::PolesOfOrder& order : tap.modes.pencil.orders) {
    for (const analysis::Pole& pole : order.poles) {
      const bool is_continued =
          below != nullptr && std::ranges::any_of(*below, [&](const analysis::Pole& other) {
            return analysis::continues(other, pole);
          });
      Series& series = is_continued ? stable : poles;
      series.x.push_back(pole.frequency_hz);
      series.y.push_back(order.order);
    }
    below = &order.poles;
  }
  Series agreed{"agreed modes", analysis::Axis::left, {}, {}, Mark::points};
  const double top = tap.modes.pencil.orders.empty() ? 0.0 : tap.modes.pencil.orders.back().order;
  for (const analysis::TapMode& mode : tap.modes.modes) {
    if (mode.standing == analysis::Standing::agreed) {
      agreed.x.push_back(mode.fitted.pole.frequency_hz);
      agreed.y.push_back(top + 4.0);  // above the poles
    }
  }
  return {title, {poles, stable, agreed}};
}

Figure panels_of(const TapIdentification& found, const Figure& labels,
                 Panel (*panel_of)(const IdentifiedTap&, const std::string&), std::size_t panels) {
  Figure figure = labels;
  for (std::size_t i = 0; i < std::min(panels, found.taps.size()); ++i) {
    figure.panels.push_back(panel_of(found.taps[i], title_of(found, i)));
  }
  figure.columns = figure.panels.size() > 1 ? 2 : 1;
  return figure;
}
}  // namespace

std::vector<NamedFigure> figures_of(const TapIdentification& found) {
  const std::string quantity = name(found.question.quantity);
  return {
      {"time.svg",
       panels_of(found, {"Free decay", "time [s]", quantity, "", 1, {}}, time_panel, max_panels)},
      {"spectrum.svg",
       panels_of(found,
                 {"Spectrum of the free decay", "frequency [Hz]", quantity + " [dB]", "", 1, {}},
                 spectrum_panel, max_panels)},
      {"stabilisation.svg", panels_of(found,
                                      {"Stabilisation diagram: poles over the order of the model",
                                       "frequency [Hz]",
                                       "order",
                                       "",
                                       1,
                                       {}},
                                      stabilisation_panel, 1)}};
}

void write_files(const std::string& directory, const TapIdentification& found) {
  core::write_new_directory(directory, [&](const std::string& unfinished) {
    const auto in = [&](const std::string& file) {
      return (std::filesystem::path{unfinished} / file).string();
    };
    core::write_new_file(in("identified.yaml"), [&](std::ostream& out) { out << yaml_of(found); });
    write_assurance(found, unfinished);
    if (found.question.at_m) {
      core::write_new_file(in("recordings.yaml"),
                           [&](std::ostream& out) { out << playback_of(found, found.finger_kg); });
    }
    core::write_new_file(in("identified.json"),
                         [&](std::ostream& out) { out << json_of(found) << '\n'; });
    for (const NamedFigure& one : figures_of(found)) {
      analysis::draw_svg(one.figure, in(one.name));
    }
  });
}
}  // namespace tapstudy::runner
