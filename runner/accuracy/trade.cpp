#include "runner/accuracy/trade.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "runner/accuracy/errors.hpp"
#include "runner/accuracy/workbench.hpp"
namespace tapstudy::runner {
namespace {
constexpr double session_s = 600.0;
constexpr std::array<double, 3> tets_tried{200.0, 700.0, 2500.0};
constexpr double tets_of_reference = 8000.0;
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
  if (std::holds_alternative<core::ModalDamping>(plate.material.damping)) {
    return {{0.5 * own, own}, own};
  }
  return {{0.5 * own, own, 2.0 * own}, 4.0 * own};
}

core::Meshing mesh_of(const core::PlateSpec& plate, int order, double tets) {
  core::Meshing mesh = plate.mesh;
  mesh.order = order;
  mesh.accuracy.reset();
  mesh.size.max_tet_volume_m3 = std::abs(core::volume_m3(plate.shape)) / tets;
  return mesh;
}

// Applies the zero-order hold's gain to a model. A mode shape enters a force twice, at the impact
// and at the finger, so it is scaled by the square root.
core::ModalModel held_from_tick_to_tick(core::ModalModel model, double rate_hz) {
  model.shape *= held_gain(model.frequency_hz, rate_hz).sqrt().matrix().asDiagonal();
  return model;
}

class Tradeoff {
 public:
  Tradeoff(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus,
           const core::ProgressHook& progress)
      : protocol_{protocol},
        bench_{protocol, stimulus,
               [this, progress](std::string_view stage) {
                 core::tell(progress, fmt::format("{}, {}", building_, stage));
               }},
        bands_{bands_of(bench_.spec())} {}

  Reference make_reference() {
    const double band_hz = bands_.tried_hz.back();
    const core::BodyModes fine = solved(tets_of_reference);
    bench_.fix_damping(fine);
    const core::BodyModes coarser = solved(tets_tried.back());
    frequency_hz_ = bench_.model_of(fine, bands_.beyond_hz).frequency_hz;
    const Eigen::Index modes = (frequency_hz_ < band_hz).count();
    if (modes == 0) {
      throw core::ModelError{fmt::format("nothing vibrates below {} Hz", band_hz)};
    }
    forces_n_ = exact_forces(fine, band_hz);
    const Eigen::ArrayXd coarser_hz = bench_.model_of(coarser, band_hz).frequency_hz;
    return {fine.report.tets,
            fine.report.dofs,
            band_hz,
            static_cast<int>(modes),
            fine.report.cost.total_s(),
            coarser.report.tets,
            frequency_error(frequency_hz_, coarser_hz, band_hz),
            force_error(forces_n_, exact_forces(coarser, band_hz)),
            force_error(exact_forces(fine, bands_.beyond_hz), forces_n_)};
  }

  void try_all(Trade& trade) {
    std::vector<core::Meshing> meshes{bench_.spec().mesh};
    for (const int order : {1, 2}) {
      for (const double tets : tets_tried) {
        meshes.push_back(mesh_of(bench_.spec(), order, tets));
      }
    }
    std::size_t number = 0;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      for (const double band_hz : bands_.tried_hz) {
        building_ = fmt::format("model {} of {}", ++number, meshes.size() * bands_.tried_hz.size());
        try_model(meshes[i], band_hz, i == 0, trade);
      }
    }
  }

 private:
  core::BodyModes solved(double tets) const {
    return bench_.solve(mesh_of(bench_.spec(), 2, tets), bands_.beyond_hz);
  }
  Forces exact_forces(const core::BodyModes& body, double band_hz) const {
    return bench_.forces_n(bench_.plate_of(bench_.model_of(body, band_hz)), core::Integrator::exact,
                           protocol_.rate_hz);
  }

  void try_model(const core::Meshing& mesh, double band_hz, bool is_own, Trade& trade) const {
    const bool is_protocols = is_own && band_hz == protocol_.band_limit_hz;
    try {
      const core::BodyModes body = bench_.solve(mesh, band_hz);
      const core::VibratingPlate plate = bench_.plate_of(bench_.model_of(body, band_hz));
      if (plate.model.frequency_hz.size() == 0) {
        throw core::ModelError{"no mode lies inside the band"};  // silence is no setting
      }
      Evaluation built;
      built.setting.mesh = mesh;
      built.setting.band_limit_hz = band_hz;
      built.setting.is_protocols = is_protocols;
      built.tets = body.report.tets;
      built.dofs = body.report.dofs;
      built.modes = static_cast<int>(plate.model.frequency_hz.size());
      built.build_s = body.report.cost.total_s();
      built.tick_ns = bench_.tick_ns(plate);
      try_rates(built, plate, trade.settings);
    } catch (const core::ModelError& error) {
      trade.refused.push_back({mesh, band_hz, is_protocols, error.what()});
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
    one.frequency_error = frequency_error(
        frequency_hz_,
        numerical_frequency_hz(plate.model.frequency_hz, setting.integrator, setting.rate_hz),
        setting.band_limit_hz);
    one.force_error =
        force_error(forces_n_, bench_.forces_n(plate, setting.integrator, setting.rate_hz));
    one.level_error_db =
        level_error_db(forces_n_, bench_.forces_n(held, setting.integrator, setting.rate_hz));
  }

  const protocols::Protocol& protocol_;
  std::string building_{"reference"};  // for the progress
  Workbench bench_;
  Bands bands_;
  Eigen::ArrayXd frequency_hz_;  // of the reference's body, beyond its band too
  Forces forces_n_;              // of the reference
};
}  // namespace

Trade measure_trade(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus,
                    const Tolerance& tolerance, const core::ProgressHook& progress) {
  if (!stimulus.technique->needs_model()) {
    throw core::InvalidInput{
        fmt::format("stimulus '{}': technique '{}' has no model to trade accuracy of",
                    stimulus.name, stimulus.technique->name)};
  }
  Tradeoff tradeoff{protocol, stimulus, progress};
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
    one.is_on_front = one.force_error < best;
    best = std::min(best, one.force_error);
    one.is_inside_tolerance = one.frequency_error <= trade.tolerance.frequency &&
                              one.level_error_db <= trade.tolerance.level_db;
    if (one.is_inside_tolerance && trade.cheapest < 0) {
      trade.cheapest = static_cast<int>(i);
    }
  }
}
}  // namespace tapstudy::runner
