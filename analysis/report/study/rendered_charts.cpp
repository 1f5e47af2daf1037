#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/report/study/rendered.hpp"
#include "analysis/statistics/quantiles.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double milli = 1e3;  // s to ms, N to mN
constexpr int bins = 20;

// Of all stimuli's figures at one point, so that they can be compared.
struct Ranges {
  std::vector<double> total_n{0.0};
  std::vector<double> added_mn{0.0};
  double added_ms{};  // all is over by then
  double highest_mn_per_hz{};
};

// So far as half of the taps last, and as a spread can be told.
std::size_t drawn_ticks(const TapStatistics& taps) {
  std::size_t k = 0;
  while (k < taps.ticks() && taps.taps_at(k) >= 2 && 2 * taps.taps_at(k) >= taps.taps()) {
    ++k;
  }
  return k;
}

using AtTick = double (TapStatistics::*)(std::size_t) const;
struct Course {
  AtTick mean;
  AtTick spread;
  double unit;
};
constexpr Course total{&TapStatistics::mean_total_n, &TapStatistics::spread_total_n, 1.0};
constexpr Course added{&TapStatistics::mean_added_n, &TapStatistics::spread_added_n, milli};

void widen(const TapStatistics& taps, const Course& course, std::vector<double>& values) {
  for (std::size_t k = 0; k < drawn_ticks(taps); ++k) {
    const double mean = course.unit * (taps.*course.mean)(k);
    const double spread = course.unit * (taps.*course.spread)(k);
    values.insert(values.end(), {mean - spread, mean + spread});
  }
}

// When the force that is added has fallen below a fiftieth of its largest value for good.
double fading_ms(const TapStatistics& taps) {
  constexpr double faded = 0.02;
  double largest = 0.0;
  for (std::size_t k = 0; k < drawn_ticks(taps); ++k) {
    largest = std::max(largest, std::abs(taps.mean_added_n(k)));
  }
  std::size_t last = 0;
  for (std::size_t k = 0; k < drawn_ticks(taps); ++k) {
    last = std::abs(taps.mean_added_n(k)) > faded * largest ? k : last;
  }
  return milli * static_cast<double>(last + 1) / taps.window().rate_hz;
}

Ranges ranges_of(const RenderedStudy& study, std::size_t point) {
  Ranges ranges;
  for (const StimulusTaps& stimulus : study.taps) {
    const TapStatistics& taps = stimulus.points[point].taps;
    if (taps.taps() < least_drawn_taps) {
      continue;
    }
    widen(taps, total, ranges.total_n);
    widen(taps, added, ranges.added_mn);
    ranges.added_ms = std::max(ranges.added_ms, fading_ms(taps));
    ranges.highest_mn_per_hz =
        std::max(ranges.highest_mn_per_hz, milli * std::ranges::max(taps.spectrum_n_per_hz()));
  }
  return ranges;
}

Chart course_chart(const std::string& title, const std::string& what, const TapStatistics& taps,
                   const Course& course, const std::vector<double>& values, double until_ms) {
  Chart chart;
  chart.caption =
      fmt::format("{}: {}, mean of {} taps ± standard deviation", title, what, taps.taps());
  chart.x_label = "time after the impact, ms";
  chart.y_label = course.unit == milli ? "added force, mN" : "total force, N";
  chart.x_range = {0.0, until_ms};
  chart.y_range = range_of(values, false);
  double largest = 0.0;
  std::size_t largest_at = 0;
  for (std::size_t k = 0; k < drawn_ticks(taps); ++k) {
    const double time_ms = milli * static_cast<double>(k) / taps.window().rate_hz;
    if (time_ms > until_ms) {
      break;
    }
    const double mean = course.unit * (taps.*course.mean)(k);
    const double spread = course.unit * (taps.*course.spread)(k);
    chart.line.push_back({time_ms, mean});
    chart.band.push_back({time_ms, {mean - spread, mean + spread}});
    if (std::abs(mean) > std::abs(largest)) {
      largest = mean;
      largest_at = k;
    }
  }
  chart.alternative = fmt::format(
      "{}: {} over {:.0f} ms after the impact, mean of {} taps; farthest from zero {} {} after {} "
      "ms",
      title, what, chart.x_range.high, taps.taps(), rounded(largest),
      course.unit == milli ? "mN" : "N",
      rounded(milli * static_cast<double>(largest_at) / taps.window().rate_hz));
  return chart;
}

Chart spectrum_chart(const std::string& title, const RenderedStimulus& stimulus,
                     const TapStatistics& taps, double highest) {
  Chart chart;
  chart.caption =
      fmt::format("{}: magnitude spectrum of the added force, RMS over {} taps{}", title,
                  taps.taps(), stimulus.model ? "; red: natural frequencies" : "");
  chart.x_label = "frequency, Hz";
  chart.y_label = "magnitude, mN/Hz";
  chart.is_y_logarithmic = true;
  constexpr double shown = 3e-3;  // of the highest
  const std::vector<double> spectrum = taps.spectrum_n_per_hz();
  constexpr double highest_hz = 1000.0;
  chart.x_range = {0.0, std::min(highest_hz, taps.frequency_hz(spectrum.size() - 1))};
  chart.y_range = {shown * highest, 1.3 * highest};
  for (std::size_t m = 0; m < spectrum.size(); ++m) {
    if (taps.frequency_hz(m) <= chart.x_range.high) {
      chart.line.push_back({taps.frequency_hz(m), milli * spectrum[m]});
    }
  }
  if (stimulus.model) {
    chart.x_marks = stimulus.model->frequencies_hz;
  }
  const auto top = std::ranges::max_element(chart.line, {}, &ChartPoint::y);
  chart.alternative = fmt::format("{}: magnitude spectrum, largest at {} Hz: {} mN/Hz", title,
                                  rounded(top->x), rounded(top->y));
  return chart;
}

Chart histogram(const std::string& title, const std::string& x_label,
                const std::vector<double>& values, const std::vector<double>& all) {
  Chart chart;
  const Quartiles of = quartiles(values);
  const double top = range_of(all, false).high;
  chart.x_range = {0.0, top};
  std::vector<double> counts(bins, 0.0);
  for (const double value : values) {
    const double place = std::clamp(value / top, 0.0, 1.0) * bins;
    ++counts[std::min<std::size_t>(static_cast<std::size_t>(place), bins - 1)];
  }
  const double most = std::ranges::max(counts);
  chart.y_range = {0.0, 1.25 * most};
  for (int bin = 0; bin < bins; ++bin) {
    const Interval height{0.0, counts[static_cast<std::size_t>(bin)]};
    chart.band.push_back({top * bin / bins, height});
    chart.band.push_back({top * (bin + 1) / bins, height});
  }
  chart.bars = {{1.12 * most, {of.low, of.high}}};
  chart.points = {{of.median, 1.12 * most, 0.3}};
  chart.caption =
      fmt::format("{}: {}, {} taps; above: median and quartiles", title, x_label, values.size());
  chart.x_label = x_label;
  chart.y_label = "taps";
  chart.alternative =
      fmt::format("{}: {} of {} taps, median {}, quartiles {} and {}", title, x_label,
                  values.size(), rounded(of.median), rounded(of.low), rounded(of.high));
  return chart;
}

void add_distributions(const RenderedStudy& study, std::vector<Chart>& charts) {
  std::vector<double> speeds_m_s;
  std::vector<double> peaks_n;
  for (const StimulusTaps& stimulus : study.taps) {
    const TapStatistics& taps = stimulus.all;
    speeds_m_s.insert(speeds_m_s.end(), taps.speeds_m_s().begin(), taps.speeds_m_s().end());
    peaks_n.insert(peaks_n.end(), taps.commanded().peaks_n.begin(), taps.commanded().peaks_n.end());
  }
  for (std::size_t i = 0; i < study.stimuli.size(); ++i) {
    const RenderedStimulus& stimulus = study.stimuli[i];
    const TapStatistics& taps = study.taps[i].all;
    if (taps.taps() < least_drawn_taps) {
      continue;
    }
    charts.push_back(
        histogram(stimulus.label, "speed at impact, m/s", taps.speeds_m_s(), speeds_m_s));
    charts.back().begins_row = true;
    charts.back().name = "speed_" + stimulus.name;
    charts.push_back(histogram(stimulus.label, "peak of the commanded force, N",
                               taps.commanded().peaks_n, peaks_n));
    charts.back().name = "peak_" + stimulus.name;
  }
}

void add_waveforms(const RenderedStimulus& stimulus, const PointTaps& at, const Ranges& ranges,
                   std::vector<Chart>& charts) {
  const std::string title = fmt::format("{}, at {}", stimulus.label, at.point);
  const std::string name = stimulus.name + "_" + at.point;
  charts.push_back(course_chart(title, "total force", at.taps, total, ranges.total_n,
                                milli * at.taps.window().length_s));
  charts.back().begins_row = true;
  charts.back().name = "force_" + name;
  if (at.taps.has_added()) {
    charts.push_back(course_chart(title, "what is added to the contact spring", at.taps, added,
                                  ranges.added_mn, ranges.added_ms));
    charts.back().name = "added_force_" + name;
    charts.push_back(spectrum_chart(title, stimulus, at.taps, ranges.highest_mn_per_hz));
    charts.back().name = "spectrum_" + name;
  }
}

// How much is added at a point to the contact spring, over all stimuli, and how many taps there
// are.
std::pair<double, std::int64_t> rank_of(const RenderedStudy& study, std::size_t point) {
  std::pair<double, std::int64_t> rank;
  for (const StimulusTaps& stimulus : study.taps) {
    const TapStatistics& taps = stimulus.points[point].taps;
    if (taps.taps() >= least_drawn_taps) {
      rank.first += std::ranges::max(taps.spectrum_n_per_hz());
      rank.second += taps.taps();
    }
  }
  return rank;
}

std::size_t shown_point(const RenderedStudy& study, std::size_t points) {
  std::size_t shown = 0;
  for (std::size_t point = 1; point < points; ++point) {
    shown = rank_of(study, point) > rank_of(study, shown) ? point : shown;
  }
  return shown;
}
}  // namespace

void add_rendered_charts(const RenderedStudy& study, ReportSection& section) {
  add_distributions(study, section.charts);
  const std::size_t points = study.taps.empty() ? 0 : study.taps.front().points.size();
  const std::size_t shown = shown_point(study, points);
  for (std::size_t point = 0; point < points; ++point) {
    const Ranges ranges = ranges_of(study, point);
    for (std::size_t i = 0; i < study.stimuli.size(); ++i) {
      const PointTaps& at = study.taps[i].points[point];
      if (at.taps.taps() >= least_drawn_taps) {
        add_waveforms(study.stimuli[i], at, ranges,
                      point == shown ? section.charts : section.folded_charts);
      }
    }
  }
}
}  // namespace tapstudy::analysis
