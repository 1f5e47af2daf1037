#include "analysis/modal/modes/mode_kinds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>

#include "analysis/modal/modes/distinct_modes.hpp"
#include "analysis/modal/modes/one_resonance.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
double hz(const RepeatedMode& mode) {
  return mode.frequency_hz.value;
}

bool is_listed(const RepeatedMode& mode) {
  return mode.standing == Standing::agreed;
}

double width(const Interval& interval) {
  return interval.high - interval.low;
}

int most_taps_of(const std::vector<RepeatedMode>& modes) {
  int most = 0;
  for (const RepeatedMode& mode : modes) {
    most = is_listed(mode) ? std::max(most, mode.taps) : most;
  }
  return most;
}

// Why a mode is not certain, or empty.
std::string uncertainty_of(const RepeatedMode& mode, int most_taps) {
  if (mode.taps < least_share_of_taps * most_taps) {
    return fmt::format("in {} of {} taps only", mode.taps, most_taps);
  }
  const Interval& ratio = mode.damping_ratio.interval;
  if (!(ratio.low > 0.0)) {
    return fmt::format("its damping ratio is anything from {:.2g} to {:.2g}", ratio.low,
                       ratio.high);
  }
  if (!(width(mode.frequency_hz.interval) <= widest_frequency * hz(mode))) {
    return fmt::format("its frequency is anything from {:.4g} to {:.4g} Hz",
                       mode.frequency_hz.interval.low, mode.frequency_hz.interval.high);
  }
  const double fall_a_period = 2.0 * std::numbers::pi * mode.damping_ratio.value;
  if (fall_a_period * min_periods > 1.0 && fall_a_period * hz(mode) * blow_s > 1.0) {
    return fmt::format("dies away in fewer than {:g} periods and sooner than a blow is over",
                       min_periods);
  }
  return {};
}
}  // namespace

void judge_certainty(double decay_s, std::vector<RepeatedMode>& modes) {
  const int most_taps = most_taps_of(modes);
  for (RepeatedMode& mode : modes) {
    if (mode.standing == Standing::line) {
      continue;
    }
    if (hz(mode) * decay_s < min_periods) {
      mode.standing = Standing::background;
      mode.why = fmt::format("fewer than {:g} periods in a decay", min_periods);
      continue;
    }
    const std::string uncertain = uncertainty_of(mode, most_taps);
    if (is_listed(mode) && !uncertain.empty()) {
      mode.standing = Standing::doubtful;
      mode.why = uncertain;
    }
  }
  const auto lowest = std::ranges::find_if(modes, is_listed);
  for (auto mode = modes.begin(); mode != lowest; ++mode) {
    if (mode->standing == Standing::doubtful && mode->damping_ratio.value <= 0.0) {
      mode->standing = Standing::background;
    }
  }
}

namespace {
double bandwidth_of(const RepeatedMode& mode) {
  return 2.0 * mode.damping_ratio.value * hz(mode);
}

bool is_weak_beside(const RepeatedMode& mode, const RepeatedMode& other) {
  constexpr double weak = 0.1;
  constexpr double beside = 1.5;
  return mode.amplitude < weak * other.amplitude &&
         std::max(hz(mode), hz(other)) < beside * std::min(hz(mode), hz(other));
}

bool may_be_part_of(const RepeatedMode& mode, const RepeatedMode& other) {
  const bool dies_sooner =
      mode.amplitude < other.amplitude && bandwidth_of(mode) > series_ratio * bandwidth_of(other);
  return std::abs(hz(mode) - hz(other)) < bandwidth_of(mode) + bandwidth_of(other) &&
         (dies_sooner || mode.agreed < other.agreed);
}

bool may_be_moved_from(const RepeatedMode& mode, const RepeatedMode& other, double below_hz) {
  constexpr double weak = 0.3;
  constexpr double tolerance = 0.01;
  const double apart_hz = std::abs(hz(mode) - hz(other));
  const auto is_at = [&](double times) {
    return std::abs(apart_hz - times * below_hz) < tolerance * hz(mode);
  };
  return below_hz > 0.0 && mode.amplitude < weak * other.amplitude && (is_at(1.0) || is_at(2.0));
}

// Why a mode of one decay is doubtful beside another, or empty.
std::string doubt_beside(const RepeatedMode& mode, const RepeatedMode& other, double below_hz) {
  if (is_weak_beside(mode, other)) {
    return fmt::format("weak beside the mode at {:.5g} Hz, in a single decay", hz(other));
  }
  if (may_be_part_of(mode, other)) {
    return fmt::format("within the bandwidth of the mode at {:.5g} Hz, in a single decay",
                       hz(other));
  }
  if (may_be_moved_from(mode, other, below_hz)) {
    return fmt::format("beside the mode at {:.5g} Hz by the motion at {:.3g} Hz, in a single decay",
                       hz(other), below_hz);
  }
  return {};
}

std::string doubt_in_single_decay(const RepeatedMode& mode, double below_hz,
                                  const std::vector<RepeatedMode>& modes) {
  if (2.0 * std::numbers::pi * mode.damping_ratio.value > 1.0) {
    return "dies away within a period, in a single decay";
  }
  for (const RepeatedMode& other : modes) {
    if (is_listed(other)) {
      if (std::string doubt = doubt_beside(mode, other, below_hz); !doubt.empty()) {
        return doubt;
      }
    }
  }
  return {};
}
}  // namespace

void judge_single_decay(std::size_t sensors, double below_hz, std::vector<RepeatedMode>& modes) {
  constexpr double weak = 0.1;
  const std::vector<RepeatedMode> before = modes;
  double strongest = 0.0;
  for (const RepeatedMode& mode : before) {
    strongest = std::max(strongest, is_listed(mode) ? mode.amplitude : 0.0);
  }
  for (RepeatedMode& mode : modes) {
    if (!is_listed(mode) || mode.agreed > 1) {
      continue;
    }
    std::string doubt = doubt_in_single_decay(mode, below_hz, before);
    if (doubt.empty() && sensors > 1 && mode.amplitude < weak * strongest) {
      doubt = fmt::format("weak, and at one of {} sensors alone", sensors);
    }
    if (!doubt.empty()) {
      mode.standing = Standing::doubtful;
      mode.why = doubt;
    }
  }
}

namespace {
constexpr double around = 1.5;
constexpr double as_strong = 0.5;
constexpr double highest_hum_hz = 200.0;

double amplitude_in(const Band& band, const FreeDecay& rest) {
  try {
    const BandSpectrum spectrum = band_spectrum(about_mean(rest), band);
    return 2.0 * spectrum.values.norm() / static_cast<double>(spectrum.length);
  } catch (const core::InvalidInput&) {
    return 0.0;  // too short to tell
  }
}
}  // namespace

double amplitude_at(double frequency_hz, const FreeDecay& rest) {
  return frequency_hz * rest.duration_s() < min_periods
             ? 0.0
             : amplitude_in({frequency_hz / around, around * frequency_hz}, rest);
}

void mark_background(const std::vector<FreeDecay>& rests, std::vector<RepeatedMode>& modes) {
  for (RepeatedMode& mode : modes) {
    if (mode.standing == Standing::line || hz(mode) >= highest_hum_hz) {
      continue;
    }
    // Within so few periods a slow movement looks like it, of any lower frequency.
    const bool is_short = 2.0 * std::numbers::pi * mode.damping_ratio.value * min_periods > 1.0;
    std::vector<double> amplitudes;
    for (const FreeDecay& rest : rests) {
      amplitudes.push_back(is_short && rest.samples.size() > 0
                               ? amplitude_in({1.0 / rest.duration_s(), around * hz(mode)}, rest)
                               : amplitude_at(hz(mode), rest));
    }
    if (!amplitudes.empty() && quantile(amplitudes, 0.5) >= as_strong * mode.amplitude) {
      mode.standing = Standing::background;
      mode.why = "as strong at rest as in the taps";
    }
  }
}

namespace {
constexpr double combination_tolerance = 0.002;  // of the frequency: a converter's and a fit's
constexpr double rate_tolerance = 0.3;           // of the decay
constexpr double outlasting_tolerance = 0.1;     // damping follows amplitude, too
constexpr double combination_weakness = 0.3;     // about 10 dB
constexpr double least_of_other_sideband = 0.1;  // of the sideband's amplitude
constexpr int highest_multiple = 3;

constexpr double widest_tolerance = 0.01;  // of the frequency

struct Line {
  double frequency_hz{};
  double decay_per_s{};
  double error_hz{};  // half of the interval
};

Line line_of(const RepeatedMode& mode) {
  return {hz(mode), 2.0 * std::numbers::pi * hz(mode) * mode.damping_ratio.value,
          width(mode.frequency_hz.interval) / 2.0};
}

bool is_at(const Line& made, const RepeatedMode& mode) {
  const double errors_hz = made.error_hz + width(mode.frequency_hz.interval) / 2.0;
  return std::abs(made.frequency_hz - hz(mode)) <=
         std::clamp(errors_hz, combination_tolerance * hz(mode), widest_tolerance * hz(mode));
}

bool is_made_as(const Line& made, const RepeatedMode& mode) {
  const double decay_per_s = line_of(mode).decay_per_s;
  return is_at(made, mode) &&
         std::abs(decay_per_s - made.decay_per_s) <= rate_tolerance * made.decay_per_s;
}

// A product decays by the sum of its factors' rates, so that it does not outlast either.
bool outlasts(const RepeatedMode& mode, const RepeatedMode& factor) {
  const double fastest_per_s = 2.0 * std::numbers::pi * hz(mode) * mode.damping_ratio.interval.high;
  return fastest_per_s < (1.0 - outlasting_tolerance) * line_of(factor).decay_per_s;
}

// "2 times 45.9 Hz", or empty.
std::string multiple_of(const RepeatedMode& mode, const Line& line) {
  for (int n = 2; n <= highest_multiple; ++n) {
    if (is_made_as({n * line.frequency_hz, n * line.decay_per_s, n * line.error_hz}, mode)) {
      return fmt::format("{} times {:.5g} Hz", n, line.frequency_hz);
    }
  }
  return {};
}

bool is_seen_at(const Line& made, const RepeatedMode& mode,
                const std::vector<RepeatedMode>& modes) {
  return std::ranges::any_of(modes, [&](const RepeatedMode& other) {
    return other.standing != Standing::line && is_at(made, other) &&
           other.amplitude >= least_of_other_sideband * mode.amplitude;
  });
}

// A product of two motions holds their sum and their difference alike: one without the other is a
// mode that happens to lie there. A difference below 0 is seen above it.
bool has_other_sideband(const RepeatedMode& mode, const Line& carrier, bool is_below_0,
                        const std::vector<RepeatedMode>& modes) {
  const double difference_hz = is_below_0 ? -hz(mode) : hz(mode);
  const double mirrored_hz = std::abs(2.0 * carrier.frequency_hz - difference_hz);
  return is_seen_at({mirrored_hz, 0.0, 2.0 * carrier.error_hz}, mode, modes);
}

// "45.9 Hz - 6.9 Hz", "45.9 Hz + 2 times 6.9 Hz", or empty.
std::string sum_of(const RepeatedMode& mode, const Line& a, const Line& b,
                   const std::vector<RepeatedMode>& modes) {
  for (int n = 1; n <= highest_multiple; ++n) {
    const std::string times = n > 1 ? fmt::format("{} times ", n) : "";
    for (const double sign : {-1.0, 1.0}) {
      const double sum_hz = a.frequency_hz + sign * n * b.frequency_hz;
      const Line made{std::abs(sum_hz), a.decay_per_s + n * b.decay_per_s,
                      a.error_hz + n * b.error_hz};
      const bool is_of_other = n == 1 && sum_hz < 0.0;  // a sideband of the faster one
      if (!is_of_other && is_made_as(made, mode) &&
          has_other_sideband(mode, a, sum_hz < 0.0, modes)) {
        return fmt::format("{:.5g} Hz {} {}{:.5g} Hz", a.frequency_hz, sign < 0.0 ? "-" : "+",
                           times, b.frequency_hz);
      }
    }
  }
  return {};
}

std::string made_of(const RepeatedMode& mode, const RepeatedMode& one, const RepeatedMode& other,
                    const std::vector<RepeatedMode>& modes) {
  if (outlasts(mode, one) || outlasts(mode, other)) {
    return {};
  }
  return &one == &other ? multiple_of(mode, line_of(one))
                        : sum_of(mode, line_of(one), line_of(other), modes);
}

constexpr std::array<std::array<double, 2>, 4> signs_of_three{
    {{1.0, 1.0}, {1.0, -1.0}, {-1.0, 1.0}, {-1.0, -1.0}}};

// What a cubic curve, as of an amplifier near its limit, makes of three motions holds all sums and
// differences of them: one of them without any other is a mode that happens to lie there.
std::string sum_of_three(const RepeatedMode& mode, const std::array<Line, 3>& lines,
                         const std::vector<RepeatedMode>& modes) {
  const Line& a = lines[0];
  const Line& b = lines[1];
  const Line& c = lines[2];
  const auto made_by = [&](const std::array<double, 2>& signs) {
    return Line{std::abs(a.frequency_hz + signs[0] * b.frequency_hz + signs[1] * c.frequency_hz),
                a.decay_per_s + b.decay_per_s + c.decay_per_s,
                a.error_hz + b.error_hz + c.error_hz};
  };
  for (const auto& signs : signs_of_three) {
    if (!is_made_as(made_by(signs), mode)) {
      continue;
    }
    const bool has_another = std::ranges::any_of(signs_of_three, [&](const auto& others) {
      return others != signs && is_seen_at(made_by(others), mode, modes);
    });
    if (has_another) {
      return fmt::format("{:.5g} Hz {} {:.5g} Hz {} {:.5g} Hz", a.frequency_hz,
                         signs[0] < 0.0 ? "-" : "+", b.frequency_hz, signs[1] < 0.0 ? "-" : "+",
                         c.frequency_hz);
    }
  }
  return {};
}

// Of any three of the stronger modes, or empty.
std::string product_of_three(const RepeatedMode& mode, const std::vector<RepeatedMode>& stronger,
                             const std::vector<RepeatedMode>& modes) {
  for (std::size_t i = 0; i < stronger.size(); ++i) {
    for (std::size_t k = i + 1; k < stronger.size(); ++k) {
      for (std::size_t l = k + 1; l < stronger.size(); ++l) {
        std::string made = sum_of_three(
            mode, {line_of(stronger[i]), line_of(stronger[k]), line_of(stronger[l])}, modes);
        if (!made.empty()) {
          return made;
        }
      }
    }
  }
  return {};
}

std::string made_with(const RepeatedMode& mode, const RepeatedMode& one,
                      const std::vector<RepeatedMode>& modes,
                      const std::function<bool(const RepeatedMode&)>& takes_part) {
  for (const RepeatedMode& other : modes) {
    if (takes_part(other)) {
      if (std::string made = made_of(mode, one, other, modes); !made.empty()) {
        return made;
      }
    }
  }
  return {};
}

std::string combination_of(const RepeatedMode& mode, const std::vector<RepeatedMode>& modes,
                           int derivatives, const std::function<bool(std::size_t)>& moves_as) {
  const auto is_stronger = [&](const RepeatedMode& other) {
    return is_listed(other) && mode.amplitude < combination_weakness * other.amplitude;
  };
  const auto modulates = [&](const RepeatedMode& other) {
    const double as_displacement = std::pow(hz(mode) / hz(other), derivatives);
    return is_listed(other) &&
           mode.amplitude < combination_weakness * as_displacement * other.amplitude;
  };
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const RepeatedMode& one = modes[i];
    const auto takes_part = [&](const RepeatedMode& other) {
      return &one == &other || ((is_stronger(other) || modulates(other)) && moves_as(i));
    };
    if (is_stronger(one)) {
      if (std::string made = made_with(mode, one, modes, takes_part); !made.empty()) {
        return made;
      }
    }
  }
  std::vector<RepeatedMode> stronger;
  std::ranges::copy_if(modes, std::back_inserter(stronger), [&](const RepeatedMode& other) {
    return is_stronger(other) && !outlasts(mode, other);
  });
  return product_of_three(mode, stronger, modes);
}
}  // namespace

void mark_combinations(std::vector<RepeatedMode>& modes, int derivatives,
                       const Likeness& likeness) {
  const std::vector<RepeatedMode> before = modes;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    RepeatedMode& mode = modes[i];
    const auto moves_as = [&](std::size_t carrier) {
      return !likeness || likeness(i, carrier) >= like_carrier;
    };
    const std::string made =
        is_listed(mode) ? combination_of(mode, before, derivatives, moves_as) : std::string{};
    if (!made.empty()) {
      mode.standing = Standing::combination;
      mode.why = made;
    }
  }
}

namespace {
struct Others {
  int count{};
  double low_hz{};
  double high_hz{};
};

std::string places(const Others& others) {
  if (others.count == 1) {
    return fmt::format("1 component at {:.4g} Hz", others.high_hz);
  }
  return fmt::format("{} components from {:.3g} to {:.4g} Hz", others.count, others.low_hz,
                     others.high_hz);
}

std::string sentence(Standing kind, const Others& others) {
  switch (kind) {
    case Standing::background:
      return fmt::format("{} component{} below {:.3g} Hz: hum or handling", others.count,
                         others.count == 1 ? "" : "s", std::ceil(others.high_hz));
    case Standing::line:
      return places(others) + ": steady tones, hum of the mains among them";
    case Standing::combination:
      return places(others) + ": multiples, sums and differences of stronger modes";
    case Standing::doubtful:
      return places(others) + ": doubtful";
    case Standing::agreed:
      break;
  }
  return {};
}
}  // namespace

std::vector<std::string> summaries_of_others(const std::vector<RepeatedMode>& modes) {
  std::map<Standing, Others> kinds;
  for (const RepeatedMode& mode : modes) {
    if (!is_listed(mode)) {
      Others& others = kinds[mode.standing];
      others.low_hz = others.count == 0 ? hz(mode) : std::min(others.low_hz, hz(mode));
      others.high_hz = std::max(others.high_hz, hz(mode));
      ++others.count;
    }
  }
  std::vector<std::string> sentences;
  for (const auto& [kind, others] : kinds) {
    sentences.push_back(sentence(kind, others));
  }
  return sentences;
}
}  // namespace tapstudy::analysis
