#pragma once
#include <string>
#include <vector>
namespace tapstudy::analysis {
// Arbitrary text, quoted and escaped for gnuplot.
std::string quoted(const std::string& text);

// Runs a script that writes the new file. Throws InvalidInput if the file already exists or cannot
// be written, or if gnuplot is not available.
void draw_with_gnuplot(const std::string& script, const std::string& file);

enum class Axis { left, right };
enum class Mark { line, broad_line, points };  // broad: pale, so that a line over it is seen
struct Series {
  std::string label;
  Axis axis{Axis::left};
  std::vector<double> x;
  std::vector<double> y;  // as many as x
  Mark mark{Mark::line};
};
enum class Scale { linear, logarithmic };
struct Panel {
  std::string title;
  std::vector<Series> series;
};
// Panels in rows of `columns`, with shared axis labels and ranges. The right axis is for series of
// much smaller magnitude or of another unit.
struct Figure {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::string right_label;  // empty: there is no right axis
  std::size_t columns{1};
  std::vector<Panel> panels;
  Scale scale{Scale::linear};  // of both axes; a logarithmic one has no right axis
};

// Draws the figure with gnuplot as SVG. Throws InvalidInput if the file exists already or cannot be
// written, or if there is no gnuplot.
void draw_svg(const Figure& figure, const std::string& file);
}  // namespace tapstudy::analysis
