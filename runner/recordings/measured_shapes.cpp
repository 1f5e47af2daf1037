#include "runner/recordings/measured_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "analysis/modal_identification/modal_assurance.hpp"
#include "core/error.hpp"
#include "core/model/shape/top_height.hpp"
#include "core/tick/surface_point.hpp"
namespace tapstudy::runner {
namespace {
// Of a place in a triangle seen from above; nullopt outside of it, and edge on.
std::optional<std::array<double, 3>> barycentric(const std::array<Eigen::Vector2d, 3>& corners,
                                                 const Eigen::Vector2d& at) {
  constexpr double rounding = 1e-9;
  const auto area = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                       const Eigen::Vector2d& c) {
    const Eigen::Vector2d u = b - a;
    const Eigen::Vector2d v = c - a;
    return u.x() * v.y() - u.y() * v.x();
  };
  const double whole = area(corners[0], corners[1], corners[2]);
  if (whole <= 0.0) {
    return std::nullopt;
  }
  const std::array<double, 3> parts{area(at, corners[1], corners[2]) / whole,
                                    area(corners[0], at, corners[2]) / whole,
                                    area(corners[0], corners[1], at) / whole};
  return std::ranges::min(parts) < -rounding ? std::nullopt : std::optional{parts};
}

struct TopPlace {
  int triangle{-1};  // below 0: none
  std::array<double, 3> barycentric{};
};

// Of the triangles there, seen from above, the one that is nearest to where the upper surface is.
TopPlace top_place(const core::ModalModel& model, const Eigen::Vector2d& at_m, double z_m) {
  TopPlace found;
  double nearest_m = 0.0;
  for (int triangle = 0; triangle < static_cast<int>(model.touch_surface.rows()); ++triangle) {
    std::array<Eigen::Vector2d, 3> corners;
    double mean_z_m = 0.0;
    for (int i = 0; i < 3; ++i) {
      const auto point = model.touch_nodes_m.row(model.touch_surface(triangle, i));
      corners.at(static_cast<std::size_t>(i)) = point.head<2>().transpose();
      mean_z_m += point.z() / 3.0;
    }
    const double away_m = std::abs(mean_z_m - z_m);
    if (const auto inside = barycentric(corners, at_m);
        inside && (found.triangle < 0 || away_m < nearest_m)) {
      nearest_m = away_m;
      found = {triangle, *inside};
    }
  }
  return found;
}

// Displacement along z per unit of each modal coordinate.
Eigen::RowVectorXd shape_at(const core::ModalModel& model, const TopPlace& place) {
  Eigen::RowVectorXd shape = Eigen::RowVectorXd::Zero(model.frequency_hz.size());
  const core::SurfacePoint point =
      core::surface_point(model.touch_surface, place.triangle, place.barycentric);
  for (std::size_t i = 0; i < point.count; ++i) {
    shape += point.weights[i] * model.shape.row(3 * point.nodes[i] + 2);
  }
  return shape;
}
}  // namespace

NumberedPlaces numbered(const std::vector<Eigen::Vector2d>& of_impacts_m) {
  NumberedPlaces numbered;
  for (const Eigen::Vector2d& at_m : of_impacts_m) {
    const auto known = std::ranges::find(numbered.places_m, at_m);
    numbered.of_impacts.push_back(static_cast<std::size_t>(known - numbered.places_m.begin()));
    if (known == numbered.places_m.end()) {
      numbered.places_m.push_back(at_m);
    }
  }
  return numbered;
}

Eigen::MatrixXd assurance_of(const MeasuredShapes& measured, const core::ModalModel& model,
                             const core::Shape& body) {
  const core::TopHeight top{body};
  Eigen::MatrixXd model_shapes(static_cast<Eigen::Index>(measured.places_m.size()),
                               model.frequency_hz.size());
  for (std::size_t place = 0; place < measured.places_m.size(); ++place) {
    const Eigen::Vector2d& at_m = measured.places_m[place];
    const auto z_m = top.at_m(at_m);
    const TopPlace found = z_m ? top_place(model, at_m, *z_m) : TopPlace{};
    if (found.triangle < 0) {
      throw core::InvalidInput{
          fmt::format("--places: {:g}, {:g} m is not on the body", at_m.x(), at_m.y())};
    }
    model_shapes.row(static_cast<Eigen::Index>(place)) = shape_at(model, found);
  }
  Eigen::MatrixXd assurance(measured.shapes.cols(), model.frequency_hz.size());
  for (Eigen::Index i = 0; i < assurance.rows(); ++i) {
    for (Eigen::Index j = 0; j < assurance.cols(); ++j) {
      assurance(i, j) = analysis::modal_assurance(measured.shapes.col(i), model_shapes.col(j));
    }
  }
  return assurance;
}
}  // namespace tapstudy::runner
