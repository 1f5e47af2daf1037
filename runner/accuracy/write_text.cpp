#include <fmt/format.h>

#include "runner/accuracy/writers.hpp"
namespace tapstudy::runner {
namespace {
std::string row(const Evaluation& one) {
  const Setting& setting = one.setting;
  return fmt::format(
      "{:>5} {:>6} {:>7.0f} {:>5} {:>10} {:>7.0f} {:>8.3f} {:>7.0f} {:>7.2f} {:>9.1f} {:>7} "
      "{:>8.1f} {:>8.1f} {:>7.0f}",
      setting.mesh.order, one.tets, setting.band_limit_hz, one.modes, name(setting.integrator),
      setting.rate_hz, one.build_s, one.tick_ns, one.cost_s, 100.0 * one.frequency_error,
      fmt::format("-{} +{}", one.missing_modes, one.extra_modes), one.level_error_db,
      one.decay_error_db, 100.0 * one.force_error);
}

void print_reference(const Reference& reference, const Tolerance& tolerance) {
  fmt::print(
      "reference: {} quadratic tetrahedra, {} dof, {} modes below {:.0f} Hz, exact, built in "
      "{:.1f} s\n"
      "  a mesh of {} tetrahedra moves its frequencies by {:.2g} %, its force by {:.2g} %, its "
      "third octaves by {:.2g} dB\n",
      reference.tets, reference.dofs, reference.modes, reference.band_limit_hz, reference.build_s,
      reference.coarser_tets, 100.0 * reference.moved_frequency, 100.0 * reference.moved_force,
      reference.moved_level_db);
  if (reference.force_beyond > 0.0) {
    fmt::print("  its band omits {:.2g} % of the force below twice that\n",
               100.0 * reference.force_beyond);
  }
  if (!reference.has_settled(tolerance)) {
    fmt::print(
        "  warning: it has not converged itself, so nothing is recommended, and the errors below "
        "are\n  underestimated (a body held at single points does not converge: hold discs or "
        "sides)\n");
  }
  fmt::print("\n");
}

char mark_of(const Evaluation& one, bool is_cheapest) {
  if (is_cheapest) {
    return '>';
  }
  return one.is_on_front ? '*' : ' ';
}

void print_settings(const Trade& trade) {
  fmt::print(
      "  order   tets band_hz modes integrator rate_hz  build_s tick_ns  cost_s "
      "frequency%   modes level_db decay_db  force%\n");
  int place = 0;
  for (const Evaluation& one : trade.settings) {
    const bool is_cheapest = place++ == trade.cheapest;
    if (one.is_on_front || one.setting.is_protocols || is_cheapest) {
      fmt::print("{} {}{}{}\n", mark_of(one, is_cheapest), row(one),
                 one.setting.is_protocols ? "  the protocol's own" : "",
                 is_cheapest ? "  cheapest within the tolerance" : "");
    }
  }
}

void print_refused(const std::vector<Refused>& all) {
  for (const Refused& one : all) {
    fmt::print("  not built: {}order {}, {}, band {:.0f} Hz: {}\n",
               one.is_protocols ? "the protocol's own, " : "", one.mesh.order,
               one.mesh.size.max_tet_volume_m3
                   ? fmt::format("{:.2g} m3 per tetrahedron", *one.mesh.size.max_tet_volume_m3)
                   : std::string{"as coarse as possible"},
               one.band_limit_hz, one.words);
  }
}

void print_stability(const Stability& stability) {
  fmt::print("\nstability: the simulated hand rests on a penalty stiffness of up to {:.0f} N/m\n",
             stability.penalty_limit_n_per_m);
  for (const StabilityCase& one : stability.cases) {
    fmt::print("  {:<26}{:>18.13g}  {:<8}  {}\n", one.property, one.value, name(one.outcome),
               one.words);
  }
}
}  // namespace

void print(const Trade& trade, const Stability& stability, const std::string& directory) {
  fmt::print("{}: speed against accuracy\n\n", trade.stimulus);
  print_reference(trade.reference, trade.tolerance);
  print_settings(trade);
  fmt::print(
      "\n  * no cheaper setting has a smaller force error, and silence has not; {} settings were "
      "measured{}\n"
      "  modes: -n the reference has and this has not, +n the other way round; decay: level after "
      "40 ms beside\n  the level before\n"
      "  tolerance: {:.0f} % of frequency, {} dB of any third octave and of the decay (by default "
      "the smallest\n  just noticeable differences at the fingerpad, Israr & Tan 2006)\n",
      trade.settings.size(),
      directory.empty() ? " (--out DIR writes all)" : fmt::format(", all in {}", directory),
      100.0 * trade.tolerance.frequency, trade.tolerance.level_db);
  print_refused(trade.refused);
  if (trade.cheapest < 0) {
    fmt::print("  {}\n", trade.reference.has_settled(trade.tolerance)
                             ? "no setting is within the tolerance"
                             : "no setting is recommended: the reference has not converged");
  }
  print_stability(stability);
}

}  // namespace tapstudy::runner
