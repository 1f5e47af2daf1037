#include "runner/laboratory/trade/trade_report.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "analysis/report/document/formats.hpp"
#include "core/error.hpp"
#include "core/files/output_files.hpp"
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
    fmt::print("  {:<26}{:>18.13g}  {:<14}  {}\n", one.property, one.value, name(one.outcome),
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

namespace {
using analysis::count;
using analysis::flag;
using analysis::number;
using analysis::ReportTable;
using analysis::word;

// Every row has the same keys.
void add_row(ReportTable& table, const std::vector<std::pair<const char*, analysis::Cell>>& cells) {
  const bool is_first = table.rows.empty();
  table.rows.emplace_back();
  for (const auto& [key, cell] : cells) {
    table.rows.back().push_back(cell);
    if (is_first) {
      table.columns.push_back(analysis::column("", key));
    }
  }
}

ReportTable settings_table(const Trade& trade) {
  ReportTable table{"settings", "", {}};
  for (const Evaluation& one : trade.settings) {
    const double volume_m3 = one.setting.mesh.size.max_tet_volume_m3.value_or(0.0);
    add_row(table, {{"order", count(one.setting.mesh.order)},
                    {"max_tet_volume_m3", number(volume_m3)},
                    {"elements", count(one.tets)},
                    {"dof", count(one.dofs)},
                    {"band_limit_hz", number(one.setting.band_limit_hz)},
                    {"modes", count(one.modes)},
                    {"integrator", word(std::string{name(one.setting.integrator)})},
                    {"rate_hz", number(one.setting.rate_hz)},
                    {"build_s", number(one.build_s)},
                    {"tick_ns", number(one.tick_ns)},
                    {"cost_s", number(one.cost_s)},
                    {"frequency_error", number(one.frequency_error)},
                    {"missing_modes", count(one.missing_modes)},
                    {"extra_modes", count(one.extra_modes)},
                    {"level_error_db", number(one.level_error_db)},
                    {"decay_error_db", number(one.decay_error_db)},
                    {"force_error", number(one.force_error)},
                    {"is_on_front", flag(one.is_on_front)},
                    {"is_inside_tolerance", flag(one.is_inside_tolerance)},
                    {"is_protocols", flag(one.setting.is_protocols)}});
  }
  return table;
}

ReportTable stability_table(const Stability& stability) {
  ReportTable table{"stability", "", {}};
  for (const StabilityCase& one : stability.cases) {
    add_row(table, {{"property", word(one.property)},
                    {"value", number(one.value)},
                    {"outcome", word(std::string{name(one.outcome)})},
                    {"words", word(one.words)}});
  }
  return table;
}

nlohmann::ordered_json json_of(const Reference& reference) {
  return {{"elements", reference.tets},
          {"dof", reference.dofs},
          {"band_limit_hz", reference.band_limit_hz},
          {"modes", reference.modes},
          {"build_s", reference.build_s},
          {"coarser_elements", reference.coarser_tets},
          {"moved_frequency", reference.moved_frequency},
          {"moved_force", reference.moved_force},
          {"moved_level_db", reference.moved_level_db},
          {"force_beyond", reference.force_beyond}};
}
}  // namespace

std::string json_of(const Trade& trade, const Stability& stability) {
  nlohmann::ordered_json json{{"schema_version", 1}, {"stimulus", trade.stimulus}};
  json["tolerance"] = {{"frequency", trade.tolerance.frequency},
                       {"level_db", trade.tolerance.level_db},
                       {"default_from", "Israr & Tan 2006"}};
  json["reference"] = json_of(trade.reference);
  json["settings"] = analysis::table_json(settings_table(trade));
  json["refused"] = nlohmann::ordered_json::array();
  for (const Refused& one : trade.refused) {
    json["refused"].push_back({{"order", one.mesh.order},
                               {"max_tet_volume_m3", one.mesh.size.max_tet_volume_m3.value_or(0.0)},
                               {"band_limit_hz", one.band_limit_hz},
                               {"is_protocols", one.is_protocols},
                               {"words", one.words}});
  }
  json["cheapest"] = nullptr;
  if (trade.cheapest >= 0) {
    json["cheapest"] = trade.cheapest;
  }
  json["penalty_limit_n_per_m"] = stability.penalty_limit_n_per_m;
  json["stability"] = analysis::table_json(stability_table(stability));
  return json.dump(2);
}

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

namespace {
std::string in(const std::string& directory, const char* name) {
  return (std::filesystem::path{directory} / name).string();
}
}  // namespace

void create_trade_directory(const std::string& directory) {
  core::make_directories(directory);
  for (const char* const name : {"trade.csv", "stability.csv", "trade.json", "trade.svg"}) {
    core::check_is_new(in(directory, name));
  }
}

void write_files(const std::string& directory, const Trade& trade, const Stability& stability) {
  core::write_new_file(in(directory, "trade.csv"), [&](std::ostream& out) {
    analysis::write_table_csv(out, settings_table(trade));
  });
  core::write_new_file(in(directory, "stability.csv"), [&](std::ostream& out) {
    analysis::write_table_csv(out, stability_table(stability));
  });
  core::write_new_file(in(directory, "trade.json"),
                       [&](std::ostream& out) { out << json_of(trade, stability) << '\n'; });
  analysis::draw_svg(figure_of(trade), in(directory, "trade.svg"));
}
}  // namespace tapstudy::runner
