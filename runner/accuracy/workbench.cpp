#include "runner/accuracy/workbench.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "core/model/shape/top_height.hpp"
#include "runner/stimuli/model_library.hpp"
namespace tapstudy::runner {
namespace {
constexpr double compared_s = 0.3;

core::SurfacePoint under_finger(const core::VibratingPlate& plate, const core::Vec3& at_m,
                                double margin_m) {
  core::Contact contact;
  contact.god_object_m = at_m;
  if (plate.triangles) {
    const core::Vec3 up{0.0, 0.0, margin_m};
    contact.triangle = plate.triangles->first_entered(at_m + up, at_m - up, 0.0).triangle;
    if (contact.triangle == core::TriangleTree::none) {
      return {};
    }
    contact.barycentric = plate.triangles->barycentric(contact.triangle, at_m);
  }
  return plate.place_of(contact);
}

// Displacement per unit of each modal coordinate: x, y, z by mode.
Eigen::MatrixXd shape_at(const core::ModalModel& model, const core::SurfacePoint& point) {
  Eigen::MatrixXd shape = Eigen::MatrixXd::Zero(3, model.frequency_hz.size());
  for (std::size_t i = 0; i < point.count; ++i) {
    shape += point.weights[i] * model.shape.middleRows<3>(3 * point.nodes[i]);
  }
  return shape;
}
}  // namespace

Workbench::Workbench(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus,
                     core::ProgressHook progress)
    : protocol_{protocol},
      rendering_{stimulus_with(protocol, stimulus).rendering},
      spec_{plate_spec(protocol, stimulus_with(protocol, stimulus))},
      progress_{std::move(progress)} {
  const core::TopHeight top{spec_.shape};
  for (const auto& [name, at_m] : stimulus.plate->tapping_points_m) {
    if (const auto z_m = top.at_m(at_m)) {
      strikes_.push_back({{at_m.x(), at_m.y(), *z_m}, protocol.simulation.taps.speed_m_s});
    }
  }
  if (strikes_.empty()) {
    throw core::InvalidInput{
        fmt::format("stimulus '{}': no tapping point lies on its plate", stimulus.name)};
  }
}

core::BodyModes Workbench::solve(const core::Meshing& mesh, double band_limit_hz) const {
  core::PlateSpec spec = spec_;
  spec.mesh = mesh;
  spec.band_limit_hz = band_limit_hz;
  return core::solve_body(core::body_of(spec), progress_).modes;
}

void Workbench::fix_damping(const core::BodyModes& body) {
  const auto* ratios = std::get_if<core::TwoRatioDamping>(&spec_.material.damping);
  if (spec_.contacts || ratios == nullptr) {
    return;
  }
  if (const auto rayleigh = model_of(body, spec_.band_limit_hz).damping) {
    spec_.material.damping = *rayleigh;
  } else {  // of a single mode
    spec_.material.damping = core::ConstantDamping{ratios->first_ratio};
  }
}

core::ModalModel Workbench::model_of(const core::BodyModes& body, double band_limit_hz) const {
  return core::model_of(body, spec_.material, band_limit_hz, spec_.contacts.get());
}

core::VibratingPlate Workbench::plate_of(core::ModalModel model) const {
  return vibrating_plate(spec_.shape, std::move(model));
}

Forces Workbench::forces_n(const core::VibratingPlate& plate, core::Integrator integrator,
                           double rate_hz) const {
  core::RenderSettings settings = rendering_;
  settings.integrator = integrator;
  settings.dt_s = 1.0 / rate_hz;
  const auto stride = static_cast<Eigen::Index>(std::lround(rate_hz / protocol_.rate_hz));
  const Eigen::Index rows = std::lround(compared_s * protocol_.rate_hz);
  Forces forces{rows, strikes_.size()};
  for (std::size_t i = 0; i < strikes_.size(); ++i) {
    const Eigen::ArrayXd force =
        felt_force_n(plate, spec_.shape, settings, strikes_[i], rows * stride);
    forces.col(static_cast<Eigen::Index>(i)) = force(Eigen::seqN(0, rows, stride));
  }
  return forces;
}

SampledModes Workbench::sampled(const core::VibratingPlate& plate) const {
  constexpr int grid = 9;
  const core::TopHeight top{spec_.shape};
  const core::Bounds body = core::bounds(spec_.shape);
  std::vector<Eigen::MatrixXd> rows;
  for (int i = 0; i < grid * grid; ++i) {
    const int row = i / grid;
    const Eigen::Array2d share{(i % grid + 0.5) / grid, (row + 0.5) / grid};
    const Eigen::Vector2d at_m =
        body.low_m.head<2>().array() + share * body.size_m().head<2>().array();
    if (const auto z_m = top.at_m(at_m)) {
      rows.push_back(shape_at(
          plate.model, under_finger(plate, {at_m.x(), at_m.y(), *z_m}, body.size_m().norm())));
    }
  }
  SampledModes modes{
      plate.model.frequency_hz,
      Eigen::MatrixXd{3 * static_cast<Eigen::Index>(rows.size()), plate.model.frequency_hz.size()}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    modes.shape.middleRows<3>(3 * static_cast<Eigen::Index>(i)) = rows[i];
  }
  return modes;
}

double Workbench::tick_ns(const core::VibratingPlate& plate) const {
  return runner::tick_ns(plate, spec_.shape, rendering_, strikes_.front());
}
}  // namespace tapstudy::runner
