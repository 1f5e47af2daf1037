#include "runner/laboratory/identify/assurance_matrix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "analysis/report/figures/figure.hpp"
#include "core/files/output_files.hpp"
namespace tapstudy::runner {
namespace {
double measured_hz(const ModalFindings& found, Eigen::Index measured) {
  return found.modes[found.agreed[static_cast<std::size_t>(measured)]].frequency_hz.value;
}

double model_hz(const ModelComparison& model, Eigen::Index mode) {
  return model.frequencies_hz[static_cast<std::size_t>(mode)];
}

bool is_pair(const ModelComparison& model, Eigen::Index measured, Eigen::Index mode) {
  return model.update &&
         std::ranges::any_of(model.update->matched, [&](const analysis::MatchedMode& one) {
           return one.measured == static_cast<std::size_t>(measured) &&
                  one.model == static_cast<std::size_t>(mode);
         });
}

std::string ticks(Eigen::Index count, const std::function<double(Eigen::Index)>& hz_of) {
  std::string text;
  for (Eigen::Index i = 0; i < count; ++i) {
    text += fmt::format("{}'{:.4g}' {}", i == 0 ? "" : ", ", hz_of(i), i);
  }
  return text;
}

std::string frame(Eigen::Index measured, Eigen::Index mode) {
  const auto x = static_cast<double>(mode);
  const auto y = static_cast<double>(measured);
  return fmt::format(
      "set object rectangle from {},{} to {},{} front fillstyle empty border rgb '#000000' lw 2\n",
      x - 0.5, y - 0.5, x + 0.5, y + 0.5);
}

std::string assurance_csv(const ModalFindings& found) {
  const ModelComparison& model = *found.model;
  std::string text = "measured_mode,measured_hz,model_mode,model_hz,mac,is_pair\n";
  for (Eigen::Index i = 0; i < model.assurance.rows(); ++i) {
    for (Eigen::Index j = 0; j < model.assurance.cols(); ++j) {
      text += fmt::format("{},{:.9g},{},{:.9g},{:.6f},{:d}\n", i + 1, measured_hz(found, i), j + 1,
                          model_hz(model, j), model.assurance(i, j), is_pair(model, i, j));
    }
  }
  return text;
}

void draw_assurance(const ModalFindings& found, const std::string& file) {
  const ModelComparison& model = *found.model;
  const Eigen::Index rows = model.assurance.rows();
  const Eigen::Index columns = model.assurance.cols();
  std::string script = fmt::format(
      "set terminal svg size {},{} font 'sans,11' background 'white'\nset output {}\n"
      "set title 'Modal assurance (MAC); matched modes are framed'\n"
      "set xlabel 'mode of the model [Hz]'\nset ylabel 'measured mode [Hz]'\n"
      "set xtics rotate ({})\nset ytics ({})\nset xrange [-0.5:{}]\nset yrange [-0.5:{}]\n"
      "set cbrange [0:1]\nset palette defined (0 '#f7f7f7', 1 '#6baed6')\n",
      200 + 44 * columns, 180 + 30 * rows, analysis::quoted(file),
      ticks(columns, [&](Eigen::Index j) { return model_hz(model, j); }),
      ticks(rows, [&](Eigen::Index i) { return measured_hz(found, i); }),
      static_cast<double>(columns) - 0.5, static_cast<double>(rows) - 0.5);
  std::string values = "$mac << END\n";
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < columns; ++j) {
      values += fmt::format("{} {} {:.4f}\n", j, i, model.assurance(i, j));
      script += is_pair(model, i, j) ? frame(i, j) : "";
    }
  }
  analysis::draw_with_gnuplot(
      values + "END\n" + script +
          "plot $mac using 1:2:(0.5):(0.5):3 with boxxyerror fillstyle solid fillcolor palette "
          "notitle, $mac using 1:2:(sprintf('%.2f', $3)) with labels notitle\n",
      file);
}
}  // namespace

void write_assurance(const ModalFindings& found, const std::string& directory) {
  if (found.model && found.model->assurance.size() > 0) {
    core::write_new_file((std::filesystem::path{directory} / "mac.csv").string(),
                         assurance_csv(found));
    draw_assurance(found, (std::filesystem::path{directory} / "mac.svg").string());
  }
}
}  // namespace tapstudy::runner
