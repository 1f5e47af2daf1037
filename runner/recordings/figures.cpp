#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/modal_identification/stabilisation.hpp"
#include "runner/recordings/writers.hpp"
namespace tapstudy::runner {
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
}  // namespace tapstudy::runner
