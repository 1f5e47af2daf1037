#include "runner/laboratory/trade/trade.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/model/cubic_elements.hpp"
#include "core/model/element_order.hpp"
#include "core/model/plate_model.hpp"
#include "core/model/progress.hpp"
#include "core/model/shape/shape.hpp"
#include "protocols/protocol.hpp"
#include "runner/laboratory/trade/rendering_accuracy.hpp"
#include "runner/session/stimuli/model_library.hpp"
namespace tapstudy::runner {
// One stimulus, to be built and struck with various settings.
class Workbench {
 public:
  // Throws InvalidInput if no tapping point is on the plate.
  Workbench(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus,
            core::ProgressHook progress);

  const core::PlateSpec& spec() const { return spec_; }
  core::BodyModes solve(const core::Meshing& mesh, double band_limit_hz) const;
  // Damping given as two ratios depends on the modes of each model; fixes its Rayleigh coefficients
  // to those of this body, in the protocol's band.
  void fix_damping(const core::BodyModes& body);
  core::ModalModel model_of(const core::BodyModes& body, double band_limit_hz) const;
  core::VibratingPlate plate_of(core::ModalModel model) const;
  // Forces for 0.3 s after a strike on each tapping point, at the protocol's ticks whatever the
  // rate, which must be a whole multiple of the protocol's.
  Forces forces_n(const core::VibratingPlate& plate, core::Integrator integrator,
                  double rate_hz) const;
  double tick_ns(const core::VibratingPlate& plate) const;
  // Mode shapes on a grid over the body, seen from above; the same points for every mesh.
  SampledModes sampled(const core::VibratingPlate& plate) const;

 private:
  const protocols::Protocol& protocol_;
  core::RenderSettings rendering_;  // the stimulus's
  core::PlateSpec spec_;
  core::ProgressHook progress_;
  std::vector<Strike> strikes_;
};

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
  if (spec_.joints || ratios == nullptr) {
    return;
  }
  if (const auto rayleigh = model_of(body, spec_.band_limit_hz).damping) {
    spec_.material.damping = *rayleigh;
  } else {  // of a single mode
    spec_.material.damping = core::ConstantDamping{ratios->first_ratio};
  }
}

core::ModalModel Workbench::model_of(const core::BodyModes& body, double band_limit_hz) const {
  return core::model_of(body, spec_.material, band_limit_hz, spec_.joints.get());
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

namespace {
constexpr double session_s = 600.0;
// Ascending: the last is the reference, the last but one its check.
constexpr std::array<double, 4> tets_of_meshes{200.0, 700.0, 2500.0, 8000.0};
constexpr std::array<double, 3> rates_tried{1.0, 2.0, 4.0};  // of the protocol's
constexpr double max_rate_hz = 10000.0;

// The widest band tried is the reference's. An impulse excites all frequencies, so the force does
// not converge with increasing band: what lies beyond is not counted as error but shown separately.
struct Bands {
  std::vector<double> tried_hz;
  double beyond_hz;
};

// Beyond the protocol's band only if damping ratios are available there.
Bands bands_of(const core::PlateSpec& plate) {
  const double own = plate.band_limit_hz;
  const auto* modal = std::get_if<core::ModalDamping>(&plate.material.damping);
  if (modal != nullptr && !modal->further_ratio) {
    return {{0.5 * own, own}, own};
  }
  return {{0.5 * own, own, 2.0 * own}, 4.0 * own};
}

core::Meshing mesh_of(const core::PlateSpec& plate, int order, double tets) {
  core::Meshing mesh = plate.mesh;
  mesh.order = order;
  mesh.accuracy.reset();
  mesh.is_automatic = false;
  mesh.shell_width_m.reset();
  mesh.size.max_tet_volume_m3 = std::abs(core::volume_m3(plate.shape)) / tets;
  return mesh;
}

// Applies the zero-order hold's gain to a model. A mode shape enters a force twice, at the impact
// and at the finger, so it is scaled by the square root.
core::ModalModel held_from_tick_to_tick(core::ModalModel model, double rate_hz) {
  model.shape *= held_gain(model.frequency_hz, rate_hz).sqrt().matrix().asDiagonal();
  return model;
}

// A sparse factorisation's time grows with a power of the number of unknowns, some five times as
// many with quadratic elements, and fifteen with cubic ones.
double work_of(int order, double tets) {
  constexpr double growth = 1.34;
  const double more = order == core::cubic_order ? 15.0 : order == 2 ? 5.0 : 1.0;
  return std::pow(more * tets, growth);
}

// The share of the work that is done, and the time the rest will take.
class Estimate {
 public:
  void plan(double work) { planned_ += work; }
  void finish(double work) { done_ += work; }
  std::string words() const {
    if (done_ <= 0.0) {
      return "";
    }
    const double left_s = watch_.elapsed_s() * std::max(0.0, planned_ - done_) / done_;
    return fmt::format(", about {:.0f} s left", std::ceil(left_s));
  }

 private:
  double planned_{0.0};
  double done_{0.0};
  core::Stopwatch watch_;
};

class Tradeoff {
 public:
  Tradeoff(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus, Effort effort,
           const core::ProgressHook& progress)
      : protocol_{protocol},
        bench_{protocol, stimulus,
               [this, progress](std::string_view stage) {
                 core::tell(progress, fmt::format("{}{}, {}", building_, left_.words(), stage));
               }},
        bands_{bands_of(bench_.spec())},
        tets_{tets_of_meshes.begin(), tets_of_meshes.end() - (effort == Effort::quick ? 1 : 0)} {
    const auto bands = static_cast<double>(bands_.tried_hz.size());
    for (const double tets : tets_) {
      left_.plan(tets < tets_.back() ? bands * (work_of(1, tets) + work_of(2, tets))
                                     : work_of(2, tets));
    }
    left_.plan(work_of(2, tets_[tets_.size() - 2]));
  }

  Reference make_reference() {
    const double band_hz = bands_.tried_hz.back();
    const core::BodyModes fine = solved(tets_.back());
    bench_.fix_damping(fine);
    const core::BodyModes coarser = solved(tets_[tets_.size() - 2]);
    modes_ = sampled(fine);
    const Eigen::Index modes = (modes_.frequency_hz < band_hz).count();
    if (modes == 0) {
      throw core::ModelError{fmt::format("nothing vibrates below {} Hz", band_hz)};
    }
    forces_n_ = exact_forces(fine, band_hz);
    return {fine.report.tets,
            fine.report.dofs,
            band_hz,
            static_cast<int>(modes),
            fine.report.cost.total_s(),
            coarser.report.tets,
            match_modes(modes_, sampled(coarser), band_hz).frequency_error,
            force_error(forces_n_, exact_forces(coarser, band_hz)),
            level_error_db(forces_n_, exact_forces(coarser, band_hz), protocol_.rate_hz,
                           protocol_.band_limit_hz),
            force_error(exact_forces(fine, bands_.beyond_hz), forces_n_)};
  }

  void try_all(Trade& trade) {
    std::vector<core::Meshing> meshes{bench_.spec().mesh};
    for (const int order : {1, 2}) {
      for (std::size_t i = 0; i + 1 < tets_.size(); ++i) {
        meshes.push_back(mesh_of(bench_.spec(), order, tets_[i]));
      }
    }
    std::size_t number = 0;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      for (const double band_hz : bands_.tried_hz) {
        building_ = fmt::format("model {} of {}", ++number, meshes.size() * bands_.tried_hz.size());
        try_model(meshes[i], band_hz, i == 0, trade);
        if (i > 0) {  // the protocol's own mesh is not planned for
          left_.finish(work_of(meshes[i].order, tets_[(i - 1) % (tets_.size() - 1)]));
        }
      }
    }
  }

 private:
  core::BodyModes solved(double tets) {
    core::BodyModes body = bench_.solve(mesh_of(bench_.spec(), 2, tets), bands_.beyond_hz);
    left_.finish(work_of(2, tets));
    return body;
  }
  SampledModes sampled(const core::BodyModes& body) const {
    return bench_.sampled(bench_.plate_of(bench_.model_of(body, bands_.beyond_hz)));
  }
  Forces exact_forces(const core::BodyModes& body, double band_hz) const {
    return bench_.forces_n(bench_.plate_of(bench_.model_of(body, band_hz)), core::Integrator::exact,
                           protocol_.rate_hz);
  }

  void try_model(const core::Meshing& mesh, double band_hz, bool is_own, Trade& trade) {
    const bool is_protocols = is_own && band_hz == protocol_.band_limit_hz;
    try {
      const core::BodyModes body = bench_.solve(mesh, band_hz);
      const core::VibratingPlate plate = bench_.plate_of(bench_.model_of(body, band_hz));
      if (plate.model.frequency_hz.size() == 0) {
        throw core::ModelError{"no mode lies inside the band"};  // silence is no setting
      }
      Evaluation built;
      built.setting.mesh = mesh;
      built.setting.mesh.order = body.report.order();
      built.setting.band_limit_hz = band_hz;
      built.setting.is_protocols = is_protocols;
      built.tets = body.report.tets;
      built.dofs = body.report.dofs;
      built.modes = static_cast<int>(plate.model.frequency_hz.size());
      built.build_s = body.report.cost.total_s();
      built.tick_ns = bench_.tick_ns(plate);
      try_rates(built, plate, trade.settings);
    } catch (const core::ModelError& error) {
      core::Meshing refused = mesh;
      refused.order = mesh.order == core::chosen_order ? 2 : mesh.order;
      trade.refused.push_back({refused, band_hz, is_protocols, error.what()});
    }
  }

  void try_rates(const Evaluation& built, const core::VibratingPlate& plate,
                 std::vector<Evaluation>& all) const {
    for (const double times : rates_tried) {
      const double rate_hz = times * protocol_.rate_hz;
      if (rate_hz > max_rate_hz || built.setting.band_limit_hz >= 0.5 * rate_hz) {
        continue;
      }
      const core::VibratingPlate held =
          bench_.plate_of(held_from_tick_to_tick(plate.model, rate_hz));
      for (const auto integrator : {core::Integrator::exact, core::Integrator::newmark}) {
        Evaluation one = built;
        one.setting.integrator = integrator;
        one.setting.rate_hz = rate_hz;
        one.setting.is_protocols = built.setting.is_protocols && times == 1.0 &&
                                   integrator == protocol_.rendering.integrator;
        measure(plate, held, one);
        all.push_back(one);
      }
    }
  }

  void measure(const core::VibratingPlate& plate, const core::VibratingPlate& held,
               Evaluation& one) const {
    const Setting& setting = one.setting;
    one.cost_s = one.build_s + 1e-9 * one.tick_ns * setting.rate_hz * session_s;
    SampledModes modes = bench_.sampled(plate);
    modes.frequency_hz =
        numerical_frequency_hz(plate.model.frequency_hz, setting.integrator, setting.rate_hz);
    const ModeMatch match = match_modes(modes_, modes, protocol_.band_limit_hz);
    one.frequency_error = match.frequency_error;
    one.missing_modes = match.missing;
    one.extra_modes = match.extra;
    one.force_error =
        force_error(forces_n_, bench_.forces_n(plate, setting.integrator, setting.rate_hz));
    const Forces felt_n = bench_.forces_n(held, setting.integrator, setting.rate_hz);
    one.level_error_db =
        level_error_db(forces_n_, felt_n, protocol_.rate_hz, protocol_.band_limit_hz);
    one.decay_error_db =
        decay_error_db(forces_n_, felt_n, protocol_.rate_hz, protocol_.band_limit_hz);
  }

  const protocols::Protocol& protocol_;
  std::string building_{"reference"};  // for the progress
  Workbench bench_;
  Bands bands_;
  std::vector<double> tets_;
  Estimate left_;
  SampledModes modes_;  // of the reference's body, beyond its band too
  Forces forces_n_;     // of the reference
};
}  // namespace

Trade measure_trade(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus,
                    const Tolerance& tolerance, Effort effort, const core::ProgressHook& progress) {
  if (!stimulus.technique->needs_model() || stimulus.technique->needs_beam()) {
    throw core::InvalidInput{
        fmt::format("stimulus '{}': technique '{}' has no finite elements to trade accuracy of",
                    stimulus.name, stimulus.technique->name)};
  }
  Tradeoff tradeoff{protocol, stimulus, effort, progress};
  Trade trade;
  trade.stimulus = stimulus.name;
  trade.tolerance = tolerance;
  trade.reference = tradeoff.make_reference();
  tradeoff.try_all(trade);
  mark_pareto_front(trade);
  return trade;
}

void mark_pareto_front(Trade& trade) {
  std::ranges::stable_sort(trade.settings, {}, &Evaluation::cost_s);
  trade.cheapest = -1;
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < trade.settings.size(); ++i) {
    Evaluation& one = trade.settings[i];
    one.is_on_front = one.force_error < best && !one.is_worse_than_silence();
    best = std::min(best, one.force_error);
    one.is_inside_tolerance = one.frequency_error <= trade.tolerance.frequency &&
                              one.level_error_db <= trade.tolerance.level_db &&
                              one.decay_error_db <= trade.tolerance.level_db;
    const bool is_known = trade.reference.has_settled(trade.tolerance);
    if (is_known && one.is_inside_tolerance && trade.cheapest < 0) {
      trade.cheapest = static_cast<int>(i);
    }
  }
}
}  // namespace tapstudy::runner
