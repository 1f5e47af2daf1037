#pragma once
#include <string>
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// A small figure within a page, in the page's colours, that scales with the page's width.
struct ChartPoint {
  double x{};
  double y{};
  double weight{1.0};  // of the area of its mark, in (0, 1]
  bool is_open{};      // an outline only
  std::string label{};
};

struct Chart {
  std::string caption;
  std::string alternative;  // what it shows, for those who cannot see it
  std::string x_label;
  std::string y_label;
  Interval x_range;
  Interval y_range;
  bool is_x_logarithmic{};  // the range is then above 0
  bool is_y_logarithmic{};
  std::vector<ChartPoint> line{};    // joined in this order
  std::vector<ChartPoint> points{};  // marks
  struct Bar {                       // an interval
    double y{};
    Interval x;
  };
  std::vector<Bar> bars{};
  std::vector<double> levels{};  // y of dashed lines across
  struct BandPoint {
    double x{};
    Interval y;
  };
  std::vector<BandPoint> band{};  // an area, from point to point
  std::vector<double> x_marks{};  // short lines at the lower edge
  bool begins_row{};              // of the figures on a wide page
  std::string name{};             // of its file; empty: from its caption
};

// What lies outside the ranges is drawn at their edge.
std::string inline_svg(const Chart& chart);

// The same figure as a file of its own, in light colours, its caption below. `mark`: whose data
// these are, where they are not a study's; may be empty.
std::string standalone_svg(const Chart& chart, const std::string& mark);

// Round numbers within the range (1, 2 or 5 times a power of ten), at most six.
std::vector<double> ticks(const Interval& range, bool is_logarithmic);

// Widens one of the ranges so that a step is as long on both axes, as a map needs.
void make_axes_equal(Chart& chart);

// The smallest range with a margin that holds all values; not a point.
Interval range_of(const std::vector<double>& values, bool is_logarithmic);
}  // namespace tapstudy::analysis
