#pragma once
#include <string>
#include <vector>
namespace tapstudy::analysis {
struct Series {
  std::string label;
  std::vector<double> x;
  std::vector<double> y;  // as many as x
};
struct Panel {
  std::string title;
  std::vector<Series> series;
};
// Panels in rows of `columns`, sharing axes' labels and ranges.
struct Figure {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::size_t columns{1};
  std::vector<Panel> panels;
};

// Draws the figure with gnuplot as SVG. Throws InvalidInput if the file exists already or cannot be
// written, or if there is no gnuplot.
void draw_svg(const Figure& figure, const std::string& file);
}  // namespace tapstudy::analysis
