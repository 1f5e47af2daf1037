#include "analysis/report/figures/figure.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "core/error.hpp"
#include "core/files/output_files.hpp"
namespace tapstudy::analysis {
namespace {
void run_gnuplot(const std::string& script, const std::string& file) {
  // of its standard input gnuplot reads one byte at a time, of a named file blocks
  FILE* const gnuplot = popen("gnuplot /dev/stdin >/dev/null 2>&1", "w");
  const bool is_written =
      gnuplot != nullptr && std::fwrite(script.data(), 1, script.size(), gnuplot) == script.size();
  const int status = gnuplot == nullptr ? -1 : pclose(gnuplot);
  constexpr int not_found = 127;  // of the shell
  if (status != -1 && WIFEXITED(status) && WEXITSTATUS(status) == not_found) {
    throw core::InvalidInput{"figures need gnuplot, which is not installed"};
  }
  if (status != 0 || !is_written) {
    throw core::InvalidInput{file + ": gnuplot could not draw it"};
  }
}

// gnuplot does not report a full disk.
bool is_whole(const std::string& file) {
  std::ifstream stream{file};
  const std::string text{std::istreambuf_iterator<char>{stream}, {}};
  return text.find("</svg>") != std::string::npos;
}
}  // namespace

// Inside single quotes gnuplot reads '' as one quote and has no other escape; a newline would end
// the command, so control characters are replaced.
std::string quoted(const std::string& text) {
  std::string safe{"'"};
  for (const char c : text) {
    if (c == '\'') {
      safe += "''";
    } else {
      safe += std::iscntrl(static_cast<unsigned char>(c)) != 0 ? ' ' : c;
    }
  }
  return safe + "'";
}

void draw_with_gnuplot(const std::string& script, const std::string& file) {
  core::write_new_file(file, [](std::ostream&) {});  // gnuplot does not report why it fails
  try {
    run_gnuplot(script, file);
    if (!is_whole(file)) {
      throw core::WritingFailed{file};
    }
  } catch (const core::Error&) {
    std::error_code error;
    std::filesystem::remove(file, error);
    throw;
  }
}

namespace {
const char* style_of(Mark mark) {
  switch (mark) {
    case Mark::line:
      return "lines lw 1.5";
    case Mark::broad_line:
      return "lines lw 5 lc rgb '#c3ccd6'";
    case Mark::points:
      break;
  }
  return "points pt 7 ps 0.5";
}

constexpr std::size_t panel_width = 400;
constexpr std::size_t panel_height = 230;

struct Span {
  double low{0.0};
  double high{0.0};
};

// The common range of all series on an axis, including zero, with a margin.
Span span_of(const Figure& figure, Axis axis) {
  Span span;
  for (const Panel& panel : figure.panels) {
    for (const Series& series : panel.series) {
      if (series.axis == axis && !series.y.empty()) {
        const auto [low, high] = std::ranges::minmax(series.y);
        span = {std::min(span.low, low), std::max(span.high, high)};
      }
    }
  }
  const double margin = 0.05 * std::max(span.high - span.low, 1e-12);
  return {span.low - margin, span.high + margin};
}

void write_panel(std::ostream& script, const Panel& panel, std::size_t index) {
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const Series& series = panel.series[i];
    script << fmt::format("$data_{}_{} << END\n", index, i);
    for (std::size_t k = 0; k < series.x.size(); ++k) {
      script << fmt::format("{:.9g} {:.9g}\n", series.x[k], series.y[k]);
    }
    script << "END\n";
  }
  script << "set title " << quoted(panel.title) << " noenhanced\nplot ";
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const Series& series = panel.series[i];
    script << (i == 0 ? "" : ", ")
           << fmt::format("$data_{}_{} axes {} with {} title ", index, i,
                          series.axis == Axis::left ? "x1y1" : "x1y2", style_of(series.mark))
           << quoted(series.label);
  }
  script << '\n';
}

// Points may lie anywhere.
bool has_points(const Figure& figure) {
  return std::ranges::any_of(figure.panels, [](const Panel& panel) {
    return std::ranges::find(panel.series, Mark::points, &Series::mark) != panel.series.end();
  });
}

std::string axes(const Figure& figure) {
  if (figure.scale == Scale::logarithmic) {
    return fmt::format(
        "set xlabel {}\nset ylabel {}\nset logscale xy\nset format xy '%g'\nset key outside bottom "
        "center horizontal width 2\n",
        quoted(figure.x_label), quoted(figure.y_label));
  }
  const Span left = span_of(figure, Axis::left);
  std::string script =
      fmt::format("set xlabel {}\nset ylabel {}\nset yrange [{:.9g}:{:.9g}]\n",
                  quoted(figure.x_label), quoted(figure.y_label), left.low, left.high);
  if (!figure.right_label.empty()) {
    const Span right = span_of(figure, Axis::right);
    script += fmt::format(
        "set y2label {}\nset y2range [{:.9g}:{:.9g}]\nset ytics nomirror\n"
        "set y2tics\n",
        quoted(figure.right_label), right.low, right.high);
  }
  return script;
}

std::string gnuplot_script(const Figure& figure, const std::string& file) {
  const std::size_t rows = (figure.panels.size() + figure.columns - 1) / figure.columns;
  std::ostringstream script;
  script << fmt::format("set terminal svg size {},{} font 'sans,11' background 'white'\n",
                        panel_width * figure.columns, panel_height * rows + 40)
         << "set output " << quoted(file) << "\nset grid\nset key "
         << (has_points(figure) ? "outside bottom center horizontal width 2\n" : "top right\n")
         << axes(figure) << fmt::format("set multiplot layout {},{} title ", rows, figure.columns)
         << quoted(figure.title) << " noenhanced\n";
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    write_panel(script, figure.panels[i], i);
  }
  script << "unset multiplot\n";
  return script.str();
}
}  // namespace

void draw_svg(const Figure& figure, const std::string& file) {
  draw_with_gnuplot(gnuplot_script(figure, file), file);
}
}  // namespace tapstudy::analysis
