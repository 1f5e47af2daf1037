#include "core/tick/vibrating_plate.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
namespace tapstudy::core {
namespace {
std::size_t clamped_cell(double cells, std::size_t count) noexcept {
  const double last = static_cast<double>(count) - 1.0;
  return static_cast<std::size_t>(std::clamp(std::floor(cells), 0.0, last));
}
}  // namespace

SurfaceLocator::SurfaceLocator(const ModalModel& model) : surface_{model.touch_surface} {
  const Eigen::RowVector3d low = model.touch_nodes_m.colwise().minCoeff();
  const Eigen::RowVector3d extent = model.touch_nodes_m.colwise().maxCoeff() - low;
  const auto triangles = static_cast<double>(model.touch_surface.rows());
  const auto per_side = static_cast<std::size_t>(std::ceil(std::sqrt(triangles)));
  low_x_m_ = low.x();
  low_y_m_ = low.y();
  cells_x_ = per_side;
  cells_y_ = per_side;
  cells_per_m_x_ = static_cast<double>(cells_x_) / extent.x();
  cells_per_m_y_ = static_cast<double>(cells_y_) / extent.y();

  std::vector<std::vector<int>> listed(cells_x_ * cells_y_);
  for (Eigen::Index row = 0; row < model.touch_surface.rows(); ++row) {
    Corners corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      const int node = model.touch_surface(row, static_cast<Eigen::Index>(i));
      corners.x.at(i) = model.touch_nodes_m(node, 0);
      corners.y.at(i) = model.touch_nodes_m(node, 1);
    }
    corners_.push_back(corners);
    const auto [min_x, max_x] = std::ranges::minmax(corners.x);
    const auto [min_y, max_y] = std::ranges::minmax(corners.y);
    const std::size_t first = cell_of(min_x, min_y);
    const std::size_t last = cell_of(max_x, max_y);
    for (std::size_t j = first / cells_x_; j <= last / cells_x_; ++j) {
      for (std::size_t i = first % cells_x_; i <= last % cells_x_; ++i) {
        listed[j * cells_x_ + i].push_back(static_cast<int>(row));
      }
    }
  }
  first_in_cell_.push_back(0);
  for (const auto& cell : listed) {
    triangles_.insert(triangles_.end(), cell.begin(), cell.end());
    first_in_cell_.push_back(static_cast<int>(triangles_.size()));
  }
}

std::size_t SurfaceLocator::cell_of(double x_m, double y_m) const noexcept {
  return clamped_cell((y_m - low_y_m_) * cells_per_m_y_, cells_y_) * cells_x_ +
         clamped_cell((x_m - low_x_m_) * cells_per_m_x_, cells_x_);
}

std::array<double, 3> SurfaceLocator::barycentric(const Corners& corners, double x_m,
                                                  double y_m) noexcept {
  const auto& [x, y] = corners;
  const double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  const double second = ((x_m - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y_m - y[0])) / area;
  const double third = ((x[1] - x[0]) * (y_m - y[0]) - (x_m - x[0]) * (y[1] - y[0])) / area;
  return {1.0 - second - third, second, third};
}

SurfacePoint SurfaceLocator::locate(double x_m, double y_m) const noexcept {
  const std::size_t cell = cell_of(x_m, y_m);
  int best = 0;
  std::array<double, 3> best_weights{};
  double deepest = -HUGE_VAL;
  for (int k = first_in_cell_[cell]; k < first_in_cell_[cell + 1]; ++k) {
    const auto triangle = static_cast<std::size_t>(triangles_[static_cast<std::size_t>(k)]);
    const std::array<double, 3> weights = barycentric(corners_[triangle], x_m, y_m);
    const double depth = *std::ranges::min_element(weights);
    if (depth > deepest) {
      deepest = depth;
      best = static_cast<int>(triangle);
      best_weights = weights;
    }
    if (depth >= 0.0) {
      break;
    }
  }
  return surface_point(surface_, best, best_weights);
}

namespace {
TriangleSurface corners_of(const ModalModel& model) {
  return {model.touch_nodes_m, model.touch_surface.leftCols<3>()};
}
}  // namespace

VibratingPlate::VibratingPlate(ModalModel modal) : model{std::move(modal)}, locator{model} {}

VibratingPlate::VibratingPlate(ModalModel modal, AllOver /*all_over*/)
    : model{std::move(modal)}, triangles{std::make_shared<const TriangleTree>(corners_of(model))} {}

VibratingPlate VibratingPlate::touched_all_over(ModalModel modal) {
  return {std::move(modal), AllOver{}};
}

SurfacePoint VibratingPlate::place_of(const Contact& contact) const noexcept {
  if (locator) {
    return locator->locate(contact.god_object_m.x(), contact.god_object_m.y());
  }
  return surface_point(model.touch_surface, contact.triangle, contact.barycentric);
}
}  // namespace tapstudy::core
