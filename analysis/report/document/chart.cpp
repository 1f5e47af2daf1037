#include "analysis/report/document/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/report/document/cells.hpp"
#include "analysis/report/document/formats.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double chart_width = 340.0;
constexpr double chart_height = 220.0;
constexpr double left = 52.0;
constexpr double right = 330.0;
constexpr double top = 10.0;
constexpr double bottom = 180.0;
constexpr double largest_radius = 6.0;
constexpr double smallest_radius = 2.0;
constexpr std::array steps{1.0, 2.0, 5.0};
// As the report's page in light colours.
constexpr const char* standalone_style =
    "text{font:11px sans-serif;fill:#1b2733}path{fill:none}.frame{stroke:#8796a5}"
    ".line{stroke:#08519c;stroke-width:1.5}.chance{stroke:#b0413e;stroke-dasharray:3 2}"
    ".interval{stroke:#08519c;stroke-width:3}.band{fill:#c6dbef}.mark{stroke:#b0413e}"
    ".caption{fill:#567}circle{fill:#08519c;stroke:#08519c;fill-opacity:.8}circle.open{fill:#fff;"
    "fill-opacity:1}";

double along(double value, const Interval& range, bool is_logarithmic) {
  const double inside = std::clamp(value, range.low, range.high);
  return is_logarithmic ? std::log(inside / range.low) / std::log(range.high / range.low)
                        : (inside - range.low) / (range.high - range.low);
}

double place_x(const Chart& chart, double x) {
  return left + (right - left) * along(x, chart.x_range, chart.is_x_logarithmic);
}

double place_y(const Chart& chart, double y) {
  return bottom - (bottom - top) * along(y, chart.y_range, chart.is_y_logarithmic);
}

// With a minus sign, not a hyphen.
std::string tick_text(double value) {
  const std::string text = rounded(value);
  return text.starts_with('-') ? "−" + text.substr(1) : text;
}

std::string axes(const Chart& chart) {
  std::string svg =
      fmt::format("<path class=\"frame\" d=\"M{0} {1}V{2}H{3}\"/>", left, top, bottom, right);
  for (const double x : ticks(chart.x_range, chart.is_x_logarithmic)) {
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                       place_x(chart, x), bottom + 14.0, tick_text(x));
  }
  for (const double y : ticks(chart.y_range, chart.is_y_logarithmic)) {
    svg += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", left - 5.0,
                       place_y(chart, y) + 4.0, tick_text(y));
  }
  return svg +
         fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                     0.5 * (left + right), chart_height - 8.0, escaped(chart.x_label)) +
         fmt::format(
             "<text transform=\"translate(12 {}) rotate(-90)\" text-anchor=\"middle\">{}"
             "</text>",
             0.5 * (top + bottom), escaped(chart.y_label));
}

std::string joined(const Chart& chart) {
  std::string svg;
  for (std::size_t i = 0; i < chart.line.size(); ++i) {
    svg += fmt::format("{}{:.1f} {:.1f}", i == 0 ? 'M' : 'L', place_x(chart, chart.line[i].x),
                       place_y(chart, chart.line[i].y));
  }
  return svg.empty() ? "" : "<path class=\"line\" d=\"" + svg + "\"/>";
}

std::string mark(const Chart& chart, const ChartPoint& point) {
  const double x = place_x(chart, point.x);
  const double y = place_y(chart, point.y);
  const double radius = std::max(smallest_radius, largest_radius * std::sqrt(point.weight));
  const bool is_left = x > 0.5 * (left + right);
  const std::string label =
      point.label.empty()
          ? ""
          : fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>",
                        is_left ? x - radius - 3.0 : x + radius + 3.0, y + 4.0,
                        is_left ? "end" : "start", escaped(point.label));
  return fmt::format("<circle{} cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>{}",
                     point.is_open ? " class=\"open\"" : "", x, y, radius, label);
}

std::vector<double> logarithmic_ticks(const Interval& range) {
  std::vector<double> found;
  for (double decade = std::pow(10.0, std::floor(std::log10(range.low))); decade <= range.high;
       decade *= 10.0) {
    for (const double step : steps) {
      if (step * decade >= range.low && step * decade <= range.high) {
        found.push_back(step * decade);
      }
    }
  }
  return found;
}

std::vector<double> linear_ticks(const Interval& range) {
  const double least = (range.high - range.low) / 5.0;
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  double step = 10.0 * decade;
  for (const double candidate : {5.0, 2.0, 1.0}) {
    step = candidate * decade >= least ? candidate * decade : step;
  }
  std::vector<double> found;
  for (double place = std::ceil(range.low / step); place * step <= range.high; place += 1.0) {
    found.push_back(place * step + 0.0);  // no -0
  }
  return found;
}
}  // namespace

std::vector<double> ticks(const Interval& range, bool is_logarithmic) {
  constexpr std::size_t most = 6;
  constexpr std::size_t fewest = 2;
  std::vector<double> found = is_logarithmic ? logarithmic_ticks(range) : linear_ticks(range);
  if (found.size() < fewest) {  // less than a decade may hold no round number
    found = linear_ticks(range);
  }
  if (found.size() <= most) {
    return found;
  }
  std::vector<double> fewer;
  const std::size_t stride = (found.size() + most - 1) / most;
  for (std::size_t i = 0; i < found.size(); i += stride) {
    fewer.push_back(found[i]);
  }
  return fewer;
}

void make_axes_equal(Chart& chart) {
  const auto widened = [](const Interval& range, double length) {
    const double middle = 0.5 * (range.low + range.high);
    return Interval{middle - 0.5 * length, middle + 0.5 * length};
  };
  const double x = chart.x_range.high - chart.x_range.low;
  const double y = chart.y_range.high - chart.y_range.low;
  const double aspect = (right - left) / (bottom - top);
  if (x < aspect * y) {
    chart.x_range = widened(chart.x_range, aspect * y);
  } else {
    chart.y_range = widened(chart.y_range, x / aspect);
  }
}

Interval range_of(const std::vector<double>& values, bool is_logarithmic) {
  if (values.empty()) {
    return is_logarithmic ? Interval{1.0, 10.0} : Interval{0.0, 1.0};
  }
  const auto [low, high] = std::ranges::minmax(values);
  if (is_logarithmic) {
    const double margin = low == high ? 1.5 : std::pow(high / low, 0.05);
    return {low / margin, high * margin};
  }
  const double margin = low == high ? std::max(0.5 * std::abs(low), 0.5) : 0.05 * (high - low);
  return {low - margin, high + margin};
}

namespace {
std::string area(const Chart& chart) {
  if (chart.band.empty()) {
    return "";
  }
  std::string upper;
  std::string lower;
  for (const Chart::BandPoint& point : chart.band) {
    const double x = place_x(chart, point.x);
    upper +=
        fmt::format("{}{:.1f} {:.1f}", upper.empty() ? 'M' : 'L', x, place_y(chart, point.y.high));
    lower.insert(0, fmt::format("L{:.1f} {:.1f}", x, place_y(chart, point.y.low)));
  }
  return "<path class=\"band\" d=\"" + upper + lower + "Z\"/>";
}

// All that is within the frame's element.
std::string drawn(const Chart& chart) {
  std::string svg = area(chart) + axes(chart);
  for (const double x : chart.x_marks) {
    svg += fmt::format("<path class=\"mark\" d=\"M{:.1f} {}v-8\"/>", place_x(chart, x), bottom);
  }
  for (const double level : chart.levels) {
    svg += fmt::format("<path class=\"chance\" d=\"M{} {:.1f}H{}\"/>", left, place_y(chart, level),
                       right);
  }
  svg += joined(chart);
  for (const Chart::Bar& bar : chart.bars) {
    svg +=
        fmt::format("<path class=\"interval\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>",
                    place_x(chart, bar.x.low), place_y(chart, bar.y), place_x(chart, bar.x.high));
  }
  for (const ChartPoint& point : chart.points) {
    svg += mark(chart, point);
  }
  return svg;
}
}  // namespace

std::string inline_svg(const Chart& chart) {
  return fmt::format(
      "<figure{}><svg class=chart viewBox=\"0 0 {} {}\" role=img aria-label=\"{}\">{}</svg>"
      "<figcaption>{}</figcaption></figure>\n",
      chart.begins_row ? " class=first" : "", chart_width, chart_height, escaped(chart.alternative),
      drawn(chart), escaped(chart.caption));
}

std::string standalone_svg(const Chart& chart, const std::string& mark) {
  constexpr std::size_t line_characters = 58;
  constexpr double line_height = 14.0;
  std::string below;
  double y = chart_height;
  for (const std::string& line :
       lines_of((mark.empty() ? "" : mark + ": ") + chart.caption.words, line_characters)) {
    y += line_height;
    below += fmt::format("<text class=\"caption\" x=\"8\" y=\"{}\">{}</text>\n", y, escaped(line));
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{2}\" "
      "height=\"{3}\" role=\"img\">\n<title>{4}</title>\n<style>{5}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{6}\n{7}</svg>\n",
      chart_width, y + line_height, 2.0 * chart_width, 2.0 * (y + line_height),
      escaped(chart.alternative), standalone_style, drawn(chart), below);
}
}  // namespace tapstudy::analysis
