#include <array>
#include <cmath>

#include "runner/accuracy/writers.hpp"
namespace tapstudy::runner {
namespace {
struct Kind {
  const char* label;
  int order;
  core::Integrator integrator;
};
constexpr std::array<Kind, 4> kinds{{{"linear, exact", 1, core::Integrator::exact},
                                     {"linear, Newmark", 1, core::Integrator::newmark},
                                     {"quadratic, exact", 2, core::Integrator::exact},
                                     {"quadratic, Newmark", 2, core::Integrator::newmark}}};

analysis::Panel panel_of(const Trade& trade, const std::string& title,
                         double Evaluation::*const error) {
  analysis::Panel panel{title, {}};
  for (const Kind& kind : kinds) {
    analysis::Series series{kind.label, analysis::Axis::left, {}, {}, analysis::Mark::points};
    for (const Evaluation& one : trade.settings) {
      const bool is_drawn = one.*error > 0.0 && std::isfinite(one.*error);
      if (one.setting.mesh.order == kind.order && one.setting.integrator == kind.integrator &&
          is_drawn) {
        series.x.push_back(one.cost_s);
        series.y.push_back(one.*error);
      }
    }
    panel.series.push_back(series);
  }
  return panel;
}
}  // namespace

analysis::Figure figure_of(const Trade& trade) {
  analysis::Panel force = panel_of(trade, "force at the tapping points", &Evaluation::force_error);
  analysis::Series front{"Pareto front", analysis::Axis::left, {}, {}};
  for (const Evaluation& one : trade.settings) {
    if (one.is_on_front) {
      front.x.push_back(one.cost_s);
      front.y.push_back(one.force_error);
    }
  }
  force.series.push_back(front);
  analysis::Panel frequency =
      panel_of(trade, "frequency of the worst mode", &Evaluation::frequency_error);
  frequency.series.push_back({"tolerance",
                              analysis::Axis::left,
                              {trade.settings.front().cost_s, trade.settings.back().cost_s},
                              {trade.tolerance.frequency, trade.tolerance.frequency}});
  return {"Cost against error: " + trade.stimulus,
          "build and ten minutes of ticks [s]",
          "relative error",
          "",
          2,
          {force, frequency},
          analysis::Scale::logarithmic};
}
}  // namespace tapstudy::runner
