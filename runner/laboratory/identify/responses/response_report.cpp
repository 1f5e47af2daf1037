#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "analysis/statistics/csv_rows.hpp"
#include "core/files/output_files.hpp"
#include "runner/laboratory/identify/assurance_matrix.hpp"
#include "runner/laboratory/identify/modal_report.hpp"
#include "runner/laboratory/identify/responses/response_identification.hpp"
namespace tapstudy::runner {
namespace {
using analysis::Axis;
using analysis::Figure;
using analysis::Mark;
using analysis::Panel;
using analysis::ResponseMode;
using analysis::Series;

std::string around(const analysis::Estimate& estimate) {
  return fmt::format("{:.7g} to {:.7g}", estimate.interval.low, estimate.interval.high);
}
}  // namespace

void print(const ResponseIdentification& found) {
  fmt::print(
      "{}\n\nModes (95 % intervals of the responses' noise):\n"
      "  frequency_hz                       damping_ratio                      orders  "
      "phase_collinearity\n",
      found.source);
  for (const std::size_t i : found.agreed) {
    const ResponseMode& mode = found.responses.modes[i];
    fmt::print("  {:>9.3f}  {:<22}  {:>9.5f}  {:<22}  {:>6}  {:>18.3f}\n", mode.frequency_hz.value,
               around(mode.frequency_hz), mode.damping_ratio.value, around(mode.damping_ratio),
               mode.orders, mode.phase_collinearity);
  }
  for (const std::string& other : found.others) {
    fmt::print("  not listed: {}\n", other);
  }
  print_damping_and_model(found);
  fmt::print("{}", found.remarks.empty() ? "" : "\n");
  for (const std::string& remark : found.remarks) {
    fmt::print("  {}\n", remark);
  }
}

std::string shapes_csv(const ResponseIdentification& found) {
  std::string text = "mode,frequency_hz,place,real,imaginary\n";
  int number = 0;
  for (const std::size_t i : found.agreed) {
    const ResponseMode& mode = found.responses.modes[i];
    ++number;
    for (std::size_t place = 0; place < found.responses.places.size(); ++place) {
      const std::complex<double> at = mode.shape[static_cast<Eigen::Index>(place)];
      text += fmt::format("{},{:.9g},{},{:.9g},{:.9g}\n", number, mode.frequency_hz.value,
                          analysis::csv_cell(found.responses.places[place]), at.real(), at.imag());
    }
  }
  return text;
}

namespace {
double decibels_of(const std::complex<double>& value) {
  constexpr double least = 1e-300;
  return 20.0 * std::log10(std::max(std::abs(value), least));
}

Series level_series(const std::string& label, Axis axis, Mark mark) {
  return {label, axis, {}, {}, mark};
}

// Poles over the order of the polynomial, with the mean response behind them.
Figure stabilisation_of(const analysis::ResponseModes& found) {
  const Eigen::ArrayXd& hz = found.measured.frequency_hz;
  Series mean = level_series("mean response", Axis::right, Mark::broad_line);
  for (Eigen::Index line = 0; line < hz.size(); ++line) {
    mean.x.push_back(hz[line]);
    mean.y.push_back(decibels_of(found.measured.values.row(line).cwiseAbs().mean()));
  }
  Series fresh = level_series("poles", Axis::left, Mark::points);
  Series settled = level_series(fmt::format("poles of {} orders", analysis::min_orders_of_mode),
                                Axis::left, Mark::points);
  for (const analysis::StabilisationOrder& order : found.diagram) {
    for (const analysis::OrderedPole& one : order.poles) {
      Series& series = one.orders >= analysis::min_orders_of_mode ? settled : fresh;
      series.x.push_back(one.pole.frequency_hz);
      series.y.push_back(order.order);
    }
  }
  Series modes = level_series("modes", Axis::left, Mark::points);
  for (const ResponseMode& mode : found.modes) {
    if (mode.standing == analysis::Standing::agreed) {
      modes.x.push_back(mode.frequency_hz.value);
      modes.y.push_back(static_cast<double>(found.diagram.size()) + 2.0);  // above the poles
    }
  }
  return {"Stabilisation diagram: poles over the order of the polynomials",
          "frequency [Hz]",
          "order",
          fmt::format("{} [dB]", name(found.measured.kind)),
          1,
          {{"", {mean, fresh, settled, modes}}}};
}

Figure responses_of(const analysis::ResponseModes& found) {
  constexpr std::size_t max_panels = 4;
  Figure figure{"Frequency responses",
                "frequency [Hz]",
                fmt::format("{} [dB]", name(found.measured.kind)),
                "",
                1,
                {}};
  const Eigen::ArrayXd& hz = found.measured.frequency_hz;
  for (std::size_t pair = 0; pair < std::min(max_panels, found.measured.pairs.size()); ++pair) {
    const auto column = static_cast<Eigen::Index>(pair);
    Series measured = level_series("measured", Axis::left, Mark::broad_line);
    Series fitted = level_series("modes and residuals", Axis::left, Mark::line);
    for (Eigen::Index line = 0; line < hz.size(); ++line) {
      measured.x.push_back(hz[line]);
      measured.y.push_back(decibels_of(found.measured.values(line, column)));
      if (found.fitted.size() > 0) {
        fitted.x.push_back(hz[line]);
        fitted.y.push_back(decibels_of(found.fitted(line, column)));
      }
    }
    figure.panels.push_back({name(found.measured.pairs[pair]), {measured, fitted}});
  }
  figure.columns = figure.panels.size() > 1 ? 2 : 1;
  return figure;
}
}  // namespace

void write_files(const std::string& directory, const ResponseIdentification& found) {
  core::write_new_directory(directory, [&](const std::string& unfinished) {
    const auto in = [&](const std::string& file) {
      return (std::filesystem::path{unfinished} / file).string();
    };
    core::write_new_file(in("identified.yaml"), yaml_of(found));
    core::write_new_file(in("identified.json"), json_of(found) + "\n");
    core::write_new_file(in("shapes.csv"), shapes_csv(found));
    write_assurance(found, unfinished);
    analysis::draw_svg(stabilisation_of(found.responses), in("stabilisation.svg"));
    analysis::draw_svg(responses_of(found.responses), in("responses.svg"));
  });
}
}  // namespace tapstudy::runner
