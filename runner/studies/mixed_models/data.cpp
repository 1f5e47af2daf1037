#include "runner/studies/mixed_models/data.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "analysis/report/summary.hpp"
#include "core/text/plain_text.hpp"
#include "protocols/tasks/task.hpp"
#include "runner/studies/stored_study.hpp"
#include "runner/studies/study_summary.hpp"
namespace tapstudy::runner {
namespace {
using protocols::Block;
using protocols::Protocol;
using results::AnswerRow;
using results::Cell;
using Predictors = std::map<std::string, std::string>;

// Counted alike.
struct ModelledCell {
  std::string block;
  std::string kind;  // as the script names them
  std::string participant;
  Predictors predictors;
  std::optional<double> outcome{};  // a ratio is missing where the answers do not tell it
};
struct CountedCell {
  ModelledCell cell;
  std::int64_t count{1};
};

constexpr const char* right_or_wrong = "right_or_wrong";
constexpr const char* rating_steps = "steps";
constexpr const char* ratio = "ratio";

// Of a trial with one stimulus that one; else what is compared with the standard; else all of them.
std::vector<std::string> stimuli_asked_about(const AnswerRow& answer) {
  if (!answer.stimulus.empty()) {
    return {answer.stimulus};
  }
  std::set<std::string> compared;
  std::set<std::string> all;
  for (const results::AlternativeRow& alternative : answer.alternatives) {
    all.insert(alternative.stimulus);
    if (alternative.is_comparison) {
      compared.insert(alternative.stimulus);
    }
  }
  const std::set<std::string>& asked = compared.empty() ? all : compared;
  return {asked.begin(), asked.end()};
}

// The levels of its factors, and its technique beside them.
Predictors factors_of_stimulus(const protocols::Stimulus& stimulus) {
  Predictors levels;
  for (const auto& [factor, level] : stimulus.factors) {
    levels.emplace("factor_" + factor, level);
  }
  if (!levels.empty()) {
    levels.emplace("technique", stimulus.technique->name);
  }
  return levels;
}

// Factors where all stimuli of the block have the same ones, else the stimulus.
Predictors condition_of(const Protocol& protocol, const Block& block, const AnswerRow& answer) {
  const std::vector<std::string> stimuli = stimuli_asked_about(answer);
  std::set<std::vector<std::string>> named;
  for (const std::string& name : protocols::all_presented(block)) {
    std::vector<std::string> keys;
    for (const auto& [key, level] : factors_of_stimulus(protocol.stimulus(name))) {
      keys.push_back(key);
    }
    named.insert(keys);
  }
  const bool has_factors = named.size() == 1 && !named.begin()->empty();
  if (has_factors && stimuli.size() == 1) {
    return factors_of_stimulus(protocol.stimulus(stimuli.front()));
  }
  return {{"condition", fmt::format("{}", fmt::join(stimuli, " | "))}};
}

std::map<std::string, std::string> groups_of(const std::vector<results::SessionRow>& sessions) {
  std::map<std::string, std::string> groups;
  for (const results::SessionRow& session : sessions) {
    if (session.group) {
      groups.emplace(session.participant_id, session.group->name);
    }
  }
  return groups;
}

void add_person(const std::map<std::string, std::string>& groups, const Block& block,
                ModelledCell& cell) {
  if (const auto group = groups.find(cell.participant); group != groups.end()) {
    cell.predictors.emplace("group", group->second);
  }
  if (!block.session.empty()) {
    cell.predictors.emplace("session", block.session);
  }
}

// Unset where the answer is of no kind that is fitted.
std::optional<std::pair<const char*, double>> outcome_of(const Block& block,
                                                         const AnswerRow& answer) {
  if (answer.is_correct && !block.comparison) {
    return std::pair{right_or_wrong, *answer.is_correct ? 1.0 : 0.0};
  }
  if (block.rating && block.rating->kind == protocols::ScaleKind::likert) {
    if (const auto step = core::number_in<int>(answer.response)) {
      return std::pair{rating_steps, static_cast<double>(*step)};
    }
  }
  return std::nullopt;
}

void count_answers(const Protocol& protocol, const std::vector<AnswerRow>& answers,
                   const std::map<std::string, std::string>& groups,
                   std::vector<CountedCell>& cells) {
  std::map<std::tuple<std::string, std::string, Predictors, double>, std::size_t> places;
  for (const AnswerRow& answer : answers) {
    const Block* const block = protocol.find_block(answer.block);
    const auto outcome = block == nullptr ? std::nullopt : outcome_of(*block, answer);
    if (!outcome) {
      continue;
    }
    ModelledCell cell{block->measure, outcome->first, answer.participant_id,
                      condition_of(protocol, *block, answer), outcome->second};
    add_person(groups, *block, cell);
    const auto [place, is_new] = places.try_emplace(
        {cell.block, cell.participant, cell.predictors, outcome->second}, cells.size());
    if (is_new) {
      cells.push_back({std::move(cell)});
    } else {
      ++cells[place->second].count;
    }
  }
}

// A block's factors where all that it presents has the same levels: then they say what it is.
Predictors condition_of(const Protocol& protocol, const Block& block,
                        const analysis::BlockSummary& summary) {
  std::set<Predictors> levels;
  for (const std::string& name : protocols::all_presented(block)) {
    levels.insert(factors_of_stimulus(protocol.stimulus(name)));
  }
  const bool is_part = !summary.part_of.empty();
  if (levels.size() == 1 && !levels.begin()->empty() && !is_part) {
    return *levels.begin();
  }
  return {{"condition", is_part ? summary.block : block.measure}};
}

void add_ratios(const Protocol& protocol,
                const std::vector<std::shared_ptr<const analysis::BlockSummary>>& blocks,
                const std::map<std::string, std::string>& groups, std::vector<CountedCell>& cells) {
  for (const auto& summary : blocks) {
    const Block* const block =
        protocol.find_block(summary->part_of.empty() ? summary->block : summary->part_of);
    if (block == nullptr || !summary->personal || !summary->personal->is_ratio) {
      continue;
    }
    for (const std::string& participant : analysis::participants_of(*summary->personal)) {
      const auto value = summary->personal->by_participant.find(participant);
      ModelledCell cell{
          summary->personal->measure, ratio, participant, condition_of(protocol, *block, *summary),
          value == summary->personal->by_participant.end() ? std::nullopt
                                                           : std::optional{value->second}};
      add_person(groups, *block, cell);
      cells.push_back({std::move(cell)});
    }
  }
}

std::vector<std::string> predictors_in(const std::vector<CountedCell>& cells) {
  std::set<std::string> names;
  for (const CountedCell& counted : cells) {
    for (const auto& [name, value] : counted.cell.predictors) {
      names.insert(name);
    }
  }
  return {names.begin(), names.end()};
}

std::vector<results::Column> columns_of_data(const std::vector<std::string>& predictors) {
  using enum results::CellType;
  std::vector<results::Column> columns = results::known_columns("block");
  columns.push_back(
      {"kind", text, "",
       "right_or_wrong (outcome 1 or 0), steps (of a rating), ratio (a threshold, say)"});
  columns.push_back(results::known_columns("participant_id").front());
  columns.push_back({"outcome", real, "", "The answer, or a participant's value"});
  columns.push_back({"count", integer, "", "How many answers the row stands for"});
  for (const std::string& name : predictors) {
    columns.push_back({name, text, "", "Predictor; missing where the block has no such one"});
  }
  return columns;
}

std::vector<results::Row> rows_of_data(const std::vector<CountedCell>& cells,
                                       const std::vector<std::string>& predictors) {
  std::vector<results::Row> rows;
  for (const auto& [cell, count] : cells) {
    results::Row row{cell.block, cell.kind, cell.participant,
                     cell.outcome ? Cell{*cell.outcome} : Cell{}, count};
    for (const std::string& name : predictors) {
      const auto value = cell.predictors.find(name);
      row.push_back(value == cell.predictors.end() ? Cell{} : Cell{value->second});
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

bool has_enough_people(const std::vector<CountedCell>& cells) {
  std::map<std::string, std::set<std::string>> people;  // by block
  for (const CountedCell& counted : cells) {
    people[counted.cell.block].insert(counted.cell.participant);
  }
  return std::ranges::any_of(people, [](const auto& of_block) {
    return of_block.second.size() >= fewest_modelled_participants;
  });
}
}  // namespace

std::optional<results::Table> mixed_models_data(
    const Protocol& protocol, const std::vector<AnswerRow>& answers,
    const std::vector<std::shared_ptr<const analysis::BlockSummary>>& blocks,
    const std::vector<results::SessionRow>& sessions) {
  const std::map<std::string, std::string> groups = groups_of(sessions);
  std::vector<CountedCell> cells;
  count_answers(protocol, answers, groups, cells);
  add_ratios(protocol, blocks, groups, cells);
  if (!has_enough_people(cells)) {
    return std::nullopt;
  }
  const std::vector<std::string> predictors = predictors_in(cells);
  return results::table_of("mixed_models_data",
                           "What mixed_models.R fits: one row per answer or value of a participant "
                           "in a condition of a block.",
                           columns_of_data(predictors), rows_of_data(cells, predictors));
}

std::optional<results::Table> stored_mixed_models_data(results::Store& store,
                                                       const Protocol& protocol) {
  const std::vector<results::SessionRow> sessions = store.sessions();
  const results::Mode mode = mode_to_report(sessions);
  const std::vector<AnswerRow> answers = counted_answers(store, mode);
  std::set<std::string> people;
  for (const AnswerRow& answer : answers) {
    people.insert(answer.participant_id);
  }
  if (people.size() < fewest_modelled_participants) {
    return std::nullopt;  // before thresholds are estimated, which takes long
  }
  analysis::StudyDesign design = design_of(protocol, mode);
  std::erase_if(design.blocks, [](const analysis::BlockDesign& block) {
    return !block.axis && !block.adjusted;  // that may have ratios
  });
  return mixed_models_data(protocol, answers, analysis::summarise(design, answers, {}).blocks,
                           sessions);
}
}  // namespace tapstudy::runner
