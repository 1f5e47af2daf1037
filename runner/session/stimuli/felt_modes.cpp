#include "runner/session/stimuli/felt_modes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>

#include "runner/session/stimuli/model_library.hpp"
namespace tapstudy::runner {
namespace {
core::Contact contact_from_above(const core::VibratingPlate& plate, const Eigen::Vector2d& at_m) {
  constexpr double far_m = 100.0;
  core::Contact contact;
  contact.god_object_m << at_m, 0.0;
  if (plate.triangles) {
    const core::Vec3 above{at_m.x(), at_m.y(), far_m};
    const core::Vec3 below{at_m.x(), at_m.y(), -far_m};
    const auto entry = plate.triangles->first_entered(above, below, 0.0);
    contact.triangle = entry.triangle;
    if (entry.triangle != core::TriangleTree::none) {
      contact.god_object_m = above + entry.along * (below - above);
      contact.normal = plate.triangles->normal(entry.triangle);
      contact.barycentric = plate.triangles->barycentric(entry.triangle, contact.god_object_m);
    }
  }
  return contact;
}

std::vector<Eigen::Vector2d> places_around(const Eigen::Vector2d& point_m, double within_m) {
  constexpr int directions = 8;
  std::vector<Eigen::Vector2d> places{point_m};
  for (const double share : {0.5, 1.0}) {
    for (int i = 0; within_m > 0.0 && i < directions; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / directions;
      places.emplace_back(point_m +
                          share * within_m * Eigen::Vector2d{std::cos(angle), std::sin(angle)});
    }
  }
  return places;
}

// Beyond its edge there is nothing to tap.
bool is_on(const core::Shape& shape, const Eigen::Vector2d& at_m) {
  const auto* const box = std::get_if<core::Box>(&shape);
  return box == nullptr || ((at_m.array() >= box->low_m().head<2>().array()).all() &&
                            (at_m.array() <= box->high_m().head<2>().array()).all());
}

// Per unit of momentum, up to a factor.
Eigen::ArrayXd felt_at(const core::VibratingPlate& plate, const Eigen::Vector2d& at_m,
                       const core::Finger& finger) {
  const Eigen::ArrayXd omega = 2.0 * std::numbers::pi * plate.model.frequency_hz;
  const Eigen::ArrayXd impedance = omega.unaryExpr([&](double w) {
    return std::abs(std::complex{finger.stiffness_n_per_m, w * finger.damping_n_s_per_m});
  });
  return impedance * modes_at(plate, at_m).transpose().array().square() / omega;
}
}  // namespace

Eigen::RowVectorXd modes_at(const core::VibratingPlate& plate, const Eigen::Vector2d& at_m) {
  Eigen::RowVectorXd along = Eigen::RowVectorXd::Zero(plate.model.shape.cols());
  const core::Contact contact = contact_from_above(plate, at_m);
  if (plate.triangles && contact.triangle == core::TriangleTree::none) {
    return along;
  }
  const core::SurfacePoint place = plate.place_of(contact);
  for (std::size_t i = 0; i < place.count; ++i) {
    const auto rows = plate.model.shape.middleRows<3>(3 * Eigen::Index{place.nodes[i]});
    along += place.weights[i] * (contact.normal.transpose() * rows);
  }
  return along;
}

Eigen::ArrayXd levels_of_modes_db(const core::VibratingPlate& plate,
                                  const protocols::PresentedStimulus& stimulus, double within_m) {
  Eigen::ArrayXd ratio = Eigen::ArrayXd::Zero(plate.model.frequency_hz.size());
  for (const auto& [name, point_m] : stimulus.plate->tapping_points_m) {
    for (const Eigen::Vector2d& at_m : places_around(point_m, within_m)) {
      if (!is_on(stimulus.plate->shape, at_m)) {
        continue;
      }
      const Eigen::ArrayXd felt = felt_at(plate, at_m, stimulus.rendering.finger);
      const double most = felt.size() == 0 ? 0.0 : felt.maxCoeff();
      if (most > 0.0) {
        ratio = ratio.max(felt / most);
      }
    }
  }
  return 20.0 * ratio.log10();
}

std::vector<UnfeltMode> unfelt_modes(const core::VibratingPlate& plate,
                                     const protocols::PresentedStimulus& stimulus,
                                     const protocols::DroppedModes& which) {
  const Eigen::ArrayXd level_db = levels_of_modes_db(plate, stimulus, which.within_m);
  std::vector<UnfeltMode> unfelt;
  for (Eigen::Index i = 0; i < level_db.size(); ++i) {
    if (level_db[i] < -which.below_db) {
      unfelt.push_back({plate.model.frequency_hz[i], level_db[i]});
    }
  }
  return unfelt;
}

core::ModalModel rendered_model(const protocols::Protocol& protocol,
                                const protocols::PresentedStimulus& stimulus,
                                core::ModalModel model) {
  if (!protocol.drop_modes || model.frequency_hz.size() == 0) {
    return model;
  }
  const core::VibratingPlate plate = vibrating_plate(stimulus.plate->shape, std::move(model));
  const Eigen::ArrayXd level_db =
      levels_of_modes_db(plate, stimulus, protocol.drop_modes->within_m);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < level_db.size(); ++i) {
    if (level_db[i] >= -protocol.drop_modes->below_db) {
      kept.push_back(i);
    }
  }
  if (kept.empty()) {  // no place moves: that is told elsewhere
    return plate.model;
  }
  core::ModalModel fewer = plate.model;
  fewer.frequency_hz = plate.model.frequency_hz(kept).eval();
  fewer.damping_ratio = plate.model.damping_ratio(kept).eval();
  fewer.shape = plate.model.shape(Eigen::all, kept).eval();
  return fewer;
}

std::string describe(const std::vector<UnfeltMode>& modes) {
  constexpr double silent_db = -200.0;
  std::vector<std::string> words;
  for (const UnfeltMode& mode : modes) {
    words.push_back(mode.level_db < silent_db
                        ? fmt::format("{:.4g} Hz (below {} dB)", mode.frequency_hz, silent_db)
                        : fmt::format("{:.4g} Hz ({:.0f} dB)", mode.frequency_hz, mode.level_db));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}
}  // namespace tapstudy::runner
