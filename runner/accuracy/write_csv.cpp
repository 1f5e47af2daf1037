#include <fmt/format.h>

#include "analysis/statistics/csv_rows.hpp"
#include "core/print.hpp"
#include "runner/accuracy/writers.hpp"
namespace tapstudy::runner {
void write_csv(std::ostream& out, const Trade& trade) {
  out << "order,elements,dof,band_limit_hz,modes,integrator,rate_hz,build_s,tick_ns,cost_s,"
         "frequency_error,missing_modes,extra_modes,level_error_db,decay_error_db,force_error,is_"
         "on_front,is_inside_tolerance,is_protocols\n";
  for (const Evaluation& one : trade.settings) {
    core::print(out,
                "{},{},{},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.9g},{},{},{:.9g},{:.9g},{:.9g},{:d},{"
                ":d},{:d}\n",
                one.setting.mesh.order, one.tets, one.dofs, one.setting.band_limit_hz, one.modes,
                name(one.setting.integrator), one.setting.rate_hz, one.build_s, one.tick_ns,
                one.cost_s, one.frequency_error, one.missing_modes, one.extra_modes,
                one.level_error_db, one.decay_error_db, one.force_error, one.is_on_front,
                one.is_inside_tolerance, one.setting.is_protocols);
  }
}

void write_csv(std::ostream& out, const Stability& stability) {
  out << "property,value,outcome,words\n";
  for (const StabilityCase& one : stability.cases) {
    core::print(out, "{},{:.17g},{},{}\n", one.property, one.value, name(one.outcome),
                analysis::csv_cell(one.words));
  }
}

}  // namespace tapstudy::runner
