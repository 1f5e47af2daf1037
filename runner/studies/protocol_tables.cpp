#include "runner/studies/protocol_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <optional>
#include <set>
#include <utility>

#include "core/error.hpp"
#include "protocols/tasks/task.hpp"
#include "results/export/table.hpp"
#include "runner/session/stimuli/model_library.hpp"
namespace tapstudy::runner {
namespace {
using protocols::AnswerKind;

// Blind labels are not: what they stood for in the trial is stored.
std::vector<protocols::Option> stored_as_given(const protocols::Answers& answers,
                                               const protocols::Block& block) {
  const auto trials = block.task->trials(block, {});
  if (answers.kind != AnswerKind::option || trials.empty()) {
    return {};
  }
  std::vector<protocols::Option> options = answers.options;
  std::erase_if(options, [&](const protocols::Option& option) {
    return block.task->response(trials.front(), block, option.name) != option.name;
  });
  return options;
}
}  // namespace

std::vector<std::pair<std::string, std::string>> response_meanings(
    const protocols::Block& block, const protocols::Protocol& protocol) {
  const protocols::Answers answers = block.task->answers(block, protocol);
  if (answers.kind == AnswerKind::line) {
    return {{"0", answers.ends.low}, {"1", answers.ends.high}};
  }
  if (answers.kind == AnswerKind::number || answers.kind == AnswerKind::setting) {
    return {};
  }
  std::vector<std::pair<std::string, std::string>> meanings;
  for (const protocols::Option& option : stored_as_given(answers, block)) {
    meanings.emplace_back(option.name, option.label);
  }
  if (meanings.size() < answers.options.size()) {
    for (const std::string& stimulus : protocols::all_presented(block)) {
      meanings.emplace_back(stimulus, protocol.stimulus(stimulus).label);
    }
  }
  return meanings;
}

results::Table response_meanings_table(const protocols::Protocol& protocol) {
  std::vector<results::Row> rows;
  for (const protocols::Block& block : protocol.blocks) {
    for (const auto& [response, meaning] : response_meanings(block, protocol)) {
      rows.push_back({block.name, response, meaning});
    }
  }
  return results::table_of(
      "response_meanings", "A row an answer of a block that has a meaning of its own.",
      results::known_columns("block response response_meaning"), std::move(rows));
}

namespace {
using protocols::Protocol;
using protocols::Stimulus;
using results::Cell;
using results::CellType;
using results::Column;
using results::Row;

std::set<std::string> factors_of(const Protocol& protocol) {
  std::set<std::string> factors;
  for (const Stimulus& stimulus : protocol.stimuli) {
    for (const auto& [factor, level] : stimulus.factors) {
      factors.insert(factor);
    }
  }
  return factors;
}

std::string varied_axes(const Stimulus& stimulus) {
  std::vector<std::string> names;
  for (const protocols::AxisRange& range : stimulus.vary) {
    names.emplace_back(range.axis->name);
  }
  return fmt::format("{}", fmt::join(names, " "));
}

// Empty where a material is isotropic.
Cell describe_orthotropy(const core::Material& material) {
  if (!material.orthotropy) {
    return {};
  }
  const core::Orthotropy& elasticity = *material.orthotropy;
  std::array<double, 3> shear_moduli_pa = elasticity.shear_moduli;
  for (double& modulus : shear_moduli_pa) {
    modulus *= material.youngs_modulus_pa;
  }
  return Cell{fmt::format(
      "E {:.6g} Pa; nu {:.6g}; G {:.6g} Pa; turned by {:.6g} rad",
      fmt::join(youngs_moduli_pa(material), " "), fmt::join(elasticity.poissons_ratios, " "),
      fmt::join(shear_moduli_pa, " "), fmt::join(elasticity.rotation_rad, " "))};
}

Row row_of(const Stimulus& stimulus, const std::set<std::string>& factors) {
  const core::Vec3 size_m = core::bounds(stimulus.plate->shape).size_m();
  Row row{stimulus.name,
          stimulus.label,
          std::string{stimulus.technique->name},
          stimulus.material->youngs_modulus_pa,
          stimulus.material->density_kg_per_m3,
          stimulus.material->orthotropy ? Cell{} : Cell{stimulus.material->poissons_ratio},
          describe_orthotropy(*stimulus.material),
          size_m.x(),
          size_m.y(),
          size_m.z(),
          static_cast<std::int64_t>(stimulus.plate->fixations.size()),
          varied_axes(stimulus)};
  for (const std::string& factor : factors) {
    const auto level = stimulus.factors.find(factor);
    row.push_back(level == stimulus.factors.end() ? Cell{} : Cell{level->second});
  }
  return row;
}

results::Table stimuli_table(const Protocol& protocol) {
  std::vector<Column> columns = results::known_columns(
      "stimulus label technique youngs_modulus_pa density_kg_per_m3 poissons_ratio orthotropy "
      "size_x_m size_y_m size_z_m fixations varied_axes plate material in_contact");
  const std::set<std::string> factors = factors_of(protocol);
  const std::size_t own = columns.size() - 3;
  for (const std::string& factor : factors) {
    columns.push_back({"factor_" + factor, CellType::text, "", "Level of the factor " + factor});
  }
  std::vector<Row> rows;
  for (const Stimulus& stimulus : protocol.stimuli) {
    Row row = row_of(stimulus, factors);
    row.insert(
        row.begin() + static_cast<std::ptrdiff_t>(own),
        {name_in(protocol.plates, stimulus.plate), name_in(protocol.materials, stimulus.material),
         stimulus.contacts ? Cell{name_in(protocol.contacts, stimulus.contacts)} : Cell{}});
    rows.push_back(std::move(row));
  }
  return results::table_of("stimuli", "One row per stimulus of the protocol.", std::move(columns),
                           std::move(rows));
}

void add_modes(const std::string& stimulus, const core::ModalModel& model, std::vector<Row>& rows) {
  for (Eigen::Index i = 0; i < model.frequency_hz.size(); ++i) {
    rows.push_back({stimulus, static_cast<std::int64_t>(i + 1), model.frequency_hz[i],
                    model.damping_ratio[i]});
  }
}

std::string options_of(const protocols::FormItem& item) {
  std::vector<std::string> lines;
  for (const protocols::Option& option : item.options) {
    lines.push_back(option.name + "=" + option.label);
  }
  return fmt::format("{}", fmt::join(lines, "\n"));
}

results::Table items_table(const Protocol& protocol) {
  std::vector<Row> rows;
  for (const auto& [name, form] : protocol.forms) {
    for (const protocols::FormItem& item : form.items) {
      const bool is_likert = item.kind == protocols::ItemKind::likert;
      rows.push_back({name, item.name, std::string{protocols::name(item.kind)}, item.question,
                      is_likert ? Cell{std::int64_t{item.steps}} : Cell{}, item.low, item.high,
                      options_of(item)});
    }
  }
  return results::table_of(
      "questionnaire_items", "One row per item of the protocol's questionnaires.",
      results::known_columns("form item item_kind question steps low high options"),
      std::move(rows));
}
}  // namespace

StimulusTables stimulus_tables(const Protocol& protocol, const core::ModelCache& cache) {
  std::vector<std::string> without_model;
  std::vector<Row> modes;
  for (const Stimulus& stimulus : protocol.stimuli) {
    if (!stimulus.technique->needs_model()) {
      continue;
    }
    if (const auto model = cached_model(protocol, stimulus, cache)) {
      add_modes(stimulus.name, model->modal, modes);
    } else {
      without_model.push_back(stimulus.name);
    }
  }
  return {{stimuli_table(protocol),
           results::table_of(
               "modes", "One row per mode of vibration of a stimulus, below the band limit.",
               results::known_columns("stimulus mode_number frequency_hz damping_ratio"),
               std::move(modes)),
           items_table(protocol), response_meanings_table(protocol)},
          without_model};
}
}  // namespace tapstudy::runner
