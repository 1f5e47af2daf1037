#include "analysis/modal/response/response_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "analysis/modal/modes/mode_shapes.hpp"
#include "analysis/modal/response/residue_shapes.hpp"
namespace tapstudy::analysis {
namespace {
using Complex = std::complex<double>;
constexpr Eigen::Index most_roots = 100;
constexpr Eigen::Index most_roots_near = 40;  // one mode

int highest_order(const FrequencyResponses& responses, Eigen::Index inputs, Eigen::Index roots) {
  const Eigen::Index by_lines = responses.frequency_hz.size() / 4;
  return static_cast<int>(std::max<Eigen::Index>(2, std::min(roots / inputs, by_lines)));
}

// Of chi-squared with two degrees of freedom a response: what the search over frequencies finds in
// noise stays below.
double significance_of_noise(Eigen::Index responses) {
  const double degrees = 2.0 * static_cast<double>(responses);
  return degrees + 5.0 * std::sqrt(2.0 * degrees) + min_significance;
}

Pole natural(const Complex& s) {
  constexpr double per_second = 1.0;
  return pole_of(s, per_second);
}

// Poles during the search, with the orders that have them.
struct Candidates {
  std::vector<Complex> poles;
  std::vector<int> orders;
  void erase(std::size_t at) {
    poles.erase(poles.begin() + static_cast<std::ptrdiff_t>(at));
    orders.erase(orders.begin() + static_cast<std::ptrdiff_t>(at));
  }
};

// A pole that the fit has driven to where no mode of this band is, or onto another.
bool is_lost(const std::vector<Complex>& poles, std::size_t at, const Eigen::ArrayXd& hz) {
  constexpr double beyond = 0.1;  // of the band, outside of it
  const double low_hz = hz[0];
  const double high_hz = hz[hz.size() - 1];
  const Pole pole = natural(poles[at]);
  const double margin_hz = beyond * (high_hz - low_hz);
  if (!(pole.frequency_hz > low_hz - margin_hz && pole.frequency_hz < high_hz + margin_hz) ||
      !(pole.damping_ratio > 0.0 && pole.damping_ratio < max_ratio_of_mode)) {
    return true;
  }
  constexpr double same = 1e-3;  // of the decay
  for (std::size_t i = 0; i < at; ++i) {
    if (std::abs(poles[i] - poles[at]) < same * std::abs(poles[at].real())) {
      return true;
    }
  }
  return false;
}

// Whether two poles share lines, so that one may be significant once the other is gone.
bool do_overlap(const Complex& one, const Complex& other) {
  constexpr double bandwidths = 3.0;
  return std::abs(one.imag() - other.imag()) <
         2.0 * bandwidths * (std::abs(one.real()) + std::abs(other.real()));
}

// Indices of what is lost, and of the weaker half of what is below the limit, of overlapping ones
// the weakest.
std::vector<std::size_t> dropped_from(const FrequencyResponses& responses, const ResidueFit& fit) {
  const double limit = significance_of_noise(responses.values.cols());
  std::vector<std::size_t> dropped;
  std::vector<std::size_t> weak;
  for (std::size_t i = 0; i < fit.poles.size(); ++i) {
    if (is_lost(fit.poles, i, responses.frequency_hz)) {
      dropped.push_back(i);
    } else if (fit.significance[i] < limit) {
      weak.push_back(i);
    }
  }
  std::ranges::sort(weak, {}, [&](std::size_t i) { return fit.significance[i]; });
  weak.resize((weak.size() + 1) / 2);
  for (const std::size_t i : weak) {
    if (std::ranges::none_of(
            dropped, [&](std::size_t gone) { return do_overlap(fit.poles[gone], fit.poles[i]); })) {
      dropped.push_back(i);
    }
  }
  return dropped;
}

// Whether there was any.
bool drop_weak(const FrequencyResponses& responses, const ResidueFit& fit, Candidates& all) {
  all.poles = fit.poles;
  std::vector<std::size_t> dropped = dropped_from(responses, fit);
  std::ranges::sort(dropped, std::ranges::greater{});
  for (const std::size_t i : dropped) {
    all.erase(i);
  }
  return !dropped.empty();
}

Candidates candidates_of(const std::vector<SettledPole>& settled) {
  constexpr double per_second = 1.0;
  Candidates all;
  for (const SettledPole& one : settled) {
    all.poles.push_back(log_of(one.pole, per_second));
    all.orders.push_back(one.orders);
  }
  return all;
}

// Precondition: candidates. Those that remain, with the complete fit.
ResidueFit selected(const FrequencyResponses& responses, Candidates& candidates) {
  for (const Fitting fitting : {Fitting::rough, Fitting::complete}) {
    while (!candidates.poles.empty()) {
      ResidueFit fit = fit_residues(responses, candidates.poles, fitting);
      const bool has_dropped = drop_weak(responses, fit, candidates);
      if (!has_dropped && fitting == Fitting::complete) {
        return fit;
      }
      if (!has_dropped) {
        break;
      }
    }
  }
  return {};
}

// The settled poles of a band.
std::vector<SettledPole> poles_in(const FrequencyResponses& inside, const ResponseGrid& grid,
                                  Eigen::Index roots, std::vector<StabilisationOrder>& diagram) {
  const NormalEquations equations{inside, grid,
                                  highest_order(inside, std::ssize(grid.columns.front()), roots)};
  const Eigen::ArrayXd& hz = inside.frequency_hz;
  diagram = stabilisation_diagram(equations, {hz[0], hz[hz.size() - 1]});
  return settled_poles(diagram);
}

// The lines around a mode: some of its bandwidths, and enough of them.
Band surroundings(const Pole& pole, const Eigen::ArrayXd& hz) {
  constexpr double bandwidths = 8.0;
  constexpr double lines = 32.0;
  const double step_hz = (hz[hz.size() - 1] - hz[0]) / static_cast<double>(hz.size() - 1);
  const double reach_hz =
      std::max(bandwidths * 2.0 * pole.damping_ratio * pole.frequency_hz, lines * step_hz);
  return {pole.frequency_hz - reach_hz, pole.frequency_hz + reach_hz};
}

// Where the search among the lines around a mode finds more poles within two of its bandwidths than
// the search among all did, which stronger modes elsewhere may hide: the candidates with those.
std::optional<Candidates> with_close_modes(const FrequencyResponses& responses,
                                           const ResponseGrid& grid, const Candidates& known,
                                           std::size_t at) {
  const Pole pole = natural(known.poles[at]);
  const Eigen::ArrayXd& hz = responses.frequency_hz;
  const Band around = surroundings(pole, hz);
  if ((hz >= around.low_hz && hz <= around.high_hz).count() < min_response_lines) {
    return std::nullopt;
  }
  const double near_hz = 2.0 * 2.0 * pole.damping_ratio * pole.frequency_hz;
  const auto is_near = [&](double frequency_hz) {
    return std::abs(frequency_hz - pole.frequency_hz) < near_hz;
  };
  std::vector<StabilisationOrder> diagram;
  std::vector<SettledPole> settled =
      poles_in(within(responses, around), grid, most_roots_near, diagram);
  std::erase_if(settled, [&](const SettledPole& one) { return !is_near(one.pole.frequency_hz); });
  const auto known_near = std::ranges::count_if(
      known.poles, [&](const Complex& s) { return is_near(natural(s).frequency_hz); });
  if (std::ssize(settled) <= known_near) {
    return std::nullopt;
  }
  Candidates more = candidates_of(settled);
  for (std::size_t i = 0; i < known.poles.size(); ++i) {
    if (!is_near(natural(known.poles[i]).frequency_hz)) {
      more.poles.push_back(known.poles[i]);
      more.orders.push_back(known.orders[i]);
    }
  }
  return more;
}

// Precondition: candidates are those of the fit.
void look_for_close_modes(const FrequencyResponses& responses, const ResponseGrid& grid,
                          Candidates& candidates, ResidueFit& fit) {
  const std::vector<Complex> first = candidates.poles;
  Candidates all = candidates;
  for (const Complex& pole : first) {
    const auto at = std::ranges::find(all.poles, pole);
    if (at == all.poles.end()) {
      continue;  // one of close modes that were found meanwhile
    }
    if (auto more = with_close_modes(responses, grid, all,
                                     static_cast<std::size_t>(at - all.poles.begin()))) {
      all = std::move(*more);
    }
  }
  if (all.poles == first) {
    return;
  }
  ResidueFit of_all = selected(responses, all);
  if (of_all.poles.size() > fit.poles.size()) {
    candidates = std::move(all);
    fit = std::move(of_all);
  }
}

double bandwidth_of(const ResponseMode& mode) {
  return 2.0 * mode.damping_ratio.value * mode.frequency_hz.value;
}

bool is_remainder(const ResponseMode& mode, const ResponseMode& stronger) {
  constexpr double same_shape = 0.9;
  constexpr double small_share = 0.25;
  return std::abs(mode.frequency_hz.value - stronger.frequency_hz.value) <
             bandwidth_of(mode) + bandwidth_of(stronger) &&
         mode.share < small_share * stronger.share &&
         modal_assurance(mode.residues, stronger.residues) > same_shape;
}

// Between the two lines around a frequency.
double step_at(double frequency_hz, const Eigen::ArrayXd& hz) {
  const auto* const end = hz.data() + hz.size();
  const auto* const above =
      std::clamp(std::upper_bound(hz.data(), end, frequency_hz), hz.data() + 1, end - 1);
  return *above - *(above - 1);
}

// What is listed, but with a damping ratio that few lines tell.
void remark_on_narrow_peaks(ResponseModes& found) {
  std::string narrow;
  for (const ResponseMode& mode : found.modes) {
    const double step_hz = step_at(mode.frequency_hz.value, found.measured.frequency_hz);
    if (mode.standing == Standing::agreed && bandwidth_of(mode) < step_hz) {
      narrow += fmt::format("{}{:.5g}", narrow.empty() ? "" : ", ", mode.frequency_hz.value);
    }
  }
  if (!narrow.empty()) {
    found.remarks.push_back(fmt::format(
        "peaks at {} Hz are narrower than the step between two frequencies: what a window or a cut "
        "decay adds to their damping ratios cannot be seen (measure longer)",
        narrow));
  }
}

std::string doubt_about(const ResponseMode& mode, const ResponseModes& all) {
  const Eigen::ArrayXd& hz = all.measured.frequency_hz;
  const double low_hz = hz[0];
  const double high_hz = hz[hz.size() - 1];
  const double at_hz = mode.frequency_hz.value;
  const double half_hz = 0.5 * bandwidth_of(mode);
  constexpr double widest_interval = 0.1;
  if (!(mode.damping_ratio.interval.low > 0.0)) {
    return "the interval of its damping ratio reaches 0";
  }
  if (mode.frequency_hz.interval.high - mode.frequency_hz.interval.low > widest_interval * at_hz) {
    return "the interval of its frequency is wider than a tenth of it";
  }
  if (at_hz - half_hz < low_hz || at_hz + half_hz > high_hz) {
    return "half of its peak lies outside the band";
  }
  const double step_hz = step_at(at_hz, hz);
  constexpr double narrowest = 0.1;
  if (bandwidth_of(mode) < narrowest * step_hz) {
    return fmt::format("its peak is narrower than a tenth of the step of {:g} Hz", step_hz);
  }
  for (const ResponseMode& other : all.modes) {
    if (is_remainder(mode, other)) {
      return fmt::format("a remainder of the mode at {:.5g} Hz", other.frequency_hz.value);
    }
  }
  return {};
}

ResponseMode mode_of(const ResidueFit& fit, std::size_t at, int orders, const ResponseGrid& grid) {
  const Pole pole = natural(fit.poles[at]);
  const double degrees = fit.degrees_of_freedom[at];
  ResponseMode mode;
  mode.frequency_hz = t_estimate(pole.frequency_hz, fit.errors[at].frequency_hz, degrees);
  mode.damping_ratio = t_estimate(pole.damping_ratio, fit.errors[at].damping_ratio, degrees);
  mode.degrees_of_freedom = degrees;
  mode.orders = orders;
  mode.significance = fit.significance[at];
  mode.share = fit.shares[at];
  mode.residues = fit.residues.row(static_cast<Eigen::Index>(at)).transpose();
  mode.shape = shape_of(mode.residues, grid);
  mode.phase_collinearity = phase_collinearity(mode.shape);
  return mode;
}
}  // namespace

ResponseModes find_response_modes(const FrequencyResponses& responses,
                                  const std::optional<Band>& band) {
  ResponseModes found;
  found.measured = band ? within(responses, *band) : responses;
  found.remarks = responses.remarks;
  const Eigen::ArrayXd& hz = found.measured.frequency_hz;
  const ResponseGrid grid = grid_of(responses.pairs);
  found.places = grid.places;
  if (!grid.is_complete) {
    found.remarks.emplace_back(
        "not every place was measured with every reference: each response counts as one of its own "
        "in the search for poles and in the shapes");
  }
  Candidates candidates = candidates_of(poles_in(found.measured, grid, most_roots, found.diagram));
  ResidueFit fit = selected(found.measured, candidates);
  look_for_close_modes(found.measured, grid, candidates, fit);
  found.fitted = fit.fitted;
  for (std::size_t i = 0; i < fit.poles.size(); ++i) {
    ResponseMode mode = mode_of(fit, i, candidates.orders[i], grid);
    if (mode.frequency_hz.value >= hz[0] && mode.frequency_hz.value <= hz[hz.size() - 1]) {
      found.modes.push_back(std::move(mode));
    }
  }
  std::ranges::sort(found.modes, {},
                    [](const ResponseMode& mode) { return mode.frequency_hz.value; });
  for (ResponseMode& mode : found.modes) {
    mode.why = doubt_about(mode, found);
    mode.standing = mode.why.empty() ? Standing::agreed : Standing::doubtful;
  }
  remark_on_narrow_peaks(found);
  add_driving_point_remarks(fit, found);
  return found;
}
}  // namespace tapstudy::analysis
