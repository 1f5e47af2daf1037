#include "runner/accuracy/trade.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/model/stopwatch.hpp"
#include "runner/accuracy/errors.hpp"
#include "runner/accuracy/workbench.hpp"
namespace tapstudy::runner {
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
  mesh.size.max_tet_volume_m3 = std::abs(core::volume_m3(plate.shape)) / tets;
  return mesh;
}

// Applies the zero-order hold's gain to a model. A mode shape enters a force twice, at the impact
// and at the finger, so it is scaled by the square root.
core::ModalModel held_from_tick_to_tick(core::ModalModel model, double rate_hz) {
  model.shape *= held_gain(model.frequency_hz, rate_hz).sqrt().matrix().asDiagonal();
  return model;
}

// A sparse factorisation's time grows with a power of the number of nodes, some five times as many
// with quadratic elements.
double work_of(int order, double tets) {
  constexpr double growth = 1.34;
  return std::pow(order == 2 ? 5.0 * tets : tets, growth);
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
