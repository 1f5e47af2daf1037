#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/rendered/rendered_section.hpp"
#include "analysis/statistics/quantiles.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double milli = 1e3;  // s to ms, N to mN
constexpr int bins = 20;

// Of all figures of one kind, so that they can be compared.
struct Ranges {
  std::vector<double> total_n{0.0};
  std::vector<double> added_mn{0.0};
  std::vector<double> spectrum_mn_per_hz{0.0};
  std::vector<double> speeds_m_s{0.0};
  std::vector<double> peaks_n{0.0};
};

// So far as half of the taps last, and as a spread can be told.
std::size_t drawn_ticks(const FeltTaps& taps) {
  std::size_t k = 0;
  while (k < taps.ticks() && taps.taps_at(k) >= 2 && 2 * taps.taps_at(k) >= taps.taps()) {
    ++k;
  }
  return k;
}

using AtTick = double (FeltTaps::*)(std::size_t) const;
struct Course {
  AtTick mean;
  AtTick spread;
  double unit;
};
constexpr Course total{&FeltTaps::mean_total_n, &FeltTaps::spread_total_n, 1.0};
constexpr Course added{&FeltTaps::mean_added_n, &FeltTaps::spread_added_n, milli};

void widen(const FeltTaps& taps, const Course& course, std::vector<double>& values) {
  for (std::size_t k = 0; k < drawn_ticks(taps); ++k) {
    const double mean = course.unit * (taps.*course.mean)(k);
    const double spread = course.unit * (taps.*course.spread)(k);
    values.insert(values.end(), {mean - spread, mean + spread});
  }
}

Ranges ranges_of(const RenderedStudy& study) {
  Ranges ranges;
  const auto append = [](std::vector<double>& all, const std::vector<double>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  for (const StimulusTaps& stimulus : study.taps) {
    append(ranges.speeds_m_s, stimulus.all.speeds_m_s());
    append(ranges.peaks_n, stimulus.all.commanded().peaks_n);
    for (const PointTaps& at : stimulus.points) {
      if (at.taps.taps() < least_drawn_taps) {
        continue;
      }
      widen(at.taps, total, ranges.total_n);
      widen(at.taps, added, ranges.added_mn);
      for (const double magnitude : at.taps.spectrum_n_per_hz()) {
        ranges.spectrum_mn_per_hz.push_back(milli * magnitude);
      }
    }
  }
  return ranges;
}

Chart course_chart(const std::string& title, const std::string& what, const FeltTaps& taps,
                   const Course& course, const std::vector<double>& values) {
  Chart chart;
  chart.caption =
      fmt::format("{}: {}, mean of {} taps ± standard deviation", title, what, taps.taps());
  chart.x_label = "time after the impact, ms";
  chart.y_label = course.unit == milli ? "added force, mN" : "total force, N";
  chart.x_range = {0.0, milli * taps.window().length_s};
  chart.y_range = range_of(values, false);
  double largest = 0.0;
  std::size_t largest_at = 0;
  for (std::size_t k = 0; k < drawn_ticks(taps); ++k) {
    const double time_ms = milli * static_cast<double>(k) / taps.window().rate_hz;
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
                     const FeltTaps& taps, const std::vector<double>& values) {
  Chart chart;
  chart.caption =
      fmt::format("{}: magnitude spectrum of the added force, RMS over {} taps{}", title,
                  taps.taps(), stimulus.model ? "; red: natural frequencies" : "");
  chart.x_label = "frequency, Hz";
  chart.y_label = "mN/Hz";
  const std::vector<double> spectrum = taps.spectrum_n_per_hz();
  constexpr double highest_hz = 1000.0;
  chart.x_range = {0.0, std::min(highest_hz, taps.frequency_hz(spectrum.size() - 1))};
  chart.y_range = {0.0, range_of(values, false).high};
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

void add_distributions(const RenderedStimulus& stimulus, const FeltTaps& taps, const Ranges& ranges,
                       std::vector<Chart>& charts) {
  charts.push_back(
      histogram(stimulus.label, "speed at impact, m/s", taps.speeds_m_s(), ranges.speeds_m_s));
  charts.back().begins_row = true;
  charts.back().name = "speed_" + stimulus.name;
  charts.push_back(histogram(stimulus.label, "peak of the commanded force, N",
                             taps.commanded().peaks_n, ranges.peaks_n));
  charts.back().name = "peak_" + stimulus.name;
}

void add_waveforms(const RenderedStimulus& stimulus, const PointTaps& at, const Ranges& ranges,
                   std::vector<Chart>& charts) {
  const std::string title =
      at.point.empty() ? stimulus.label : fmt::format("{}, at {}", stimulus.label, at.point);
  const std::string name = at.point.empty() ? stimulus.name : stimulus.name + "_" + at.point;
  charts.push_back(course_chart(title, "total force", at.taps, total, ranges.total_n));
  charts.back().begins_row = true;
  charts.back().name = "force_" + name;
  if (at.taps.has_added()) {
    charts.push_back(course_chart(title, "what is added to the contact spring", at.taps, added,
                                  ranges.added_mn));
    charts.back().name = "added_force_" + name;
    charts.push_back(spectrum_chart(title, stimulus, at.taps, ranges.spectrum_mn_per_hz));
    charts.back().name = "spectrum_" + name;
  }
}
}  // namespace

void add_rendered_charts(const RenderedStudy& study, ReportSection& section) {
  const Ranges ranges = ranges_of(study);
  for (std::size_t i = 0; i < study.stimuli.size(); ++i) {
    if (study.taps[i].all.taps() >= least_drawn_taps) {
      add_distributions(study.stimuli[i], study.taps[i].all, ranges, section.charts);
    }
  }
  const auto taps_of = [](const PointTaps& at) { return at.taps.taps(); };
  for (std::size_t i = 0; i < study.stimuli.size(); ++i) {
    const std::vector<PointTaps>& points = study.taps[i].points;
    const auto most = std::ranges::max_element(points, {}, taps_of);
    for (auto at = points.begin(); at != points.end(); ++at) {
      if (at->taps.taps() >= least_drawn_taps) {
        add_waveforms(study.stimuli[i], *at, ranges,
                      at == most ? section.charts : section.folded_charts);
      }
    }
  }
}
}  // namespace tapstudy::analysis
