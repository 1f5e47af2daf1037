#include "protocols/tasks/task_parts.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "core/error.hpp"
#include "protocols/schedule/ordering.hpp"
#include "protocols/tasks/task.hpp"
namespace tapstudy::protocols {
const std::vector<const Task*>& tasks() {
  static const std::vector<const Task*> table{&identification(), &choice(),          &comparison(),
                                              &same_different(), &odd_one_out(),     &abx(),
                                              &paired(),         &ranking(),         &rating(),
                                              &magnitude(),      &match_to_sample(), &adjustment()};
  return table;
}

const Task* find_task(std::string_view name) {
  const auto found = std::ranges::find(tasks(), name, &Task::name);
  return found == tasks().end() ? nullptr : *found;
}

std::string blind_label(std::size_t position) {
  return {static_cast<char>('A' + static_cast<char>(position))};
}

std::optional<std::size_t> Task::outcome(const PlannedTrial& trial, const Block& block,
                                         const std::string& response) const {
  const std::optional<bool> is_right = is_correct(trial, block, response);
  return is_right ? std::optional<std::size_t>{*is_right ? 1 : 0} : std::nullopt;
}

std::vector<Alternative> rendered(const PlannedTrial& trial, const Block& block) {
  std::vector<Alternative> all = trial.alternatives;
  if (const auto settings = trial.task->settings(trial, block)) {
    const Alternative adjusted = all.back();
    all.pop_back();
    for (const AxisValues& values : settings->values) {
      all.push_back({adjusted.stimulus, values, adjusted.is_comparison});
    }
  }
  return all;
}

double Task::chance_level(const Block& block, const Protocol& protocol) const {
  return 1.0 / static_cast<double>(answers(block, protocol).options.size());
}

double Task::guess_rate(const Block& block, const Protocol& protocol) const {
  return has_correct_answer() ? chance_level(block, protocol) : 0.0;
}

void visit_all(std::size_t alternatives, const Simulation& simulation, SimulatedTouch& touch) {
  std::vector<std::size_t> order(alternatives);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (int visit = 0; visit < simulation.taps.visits; ++visit) {
    touch.rng().shuffle(order);
    for (const std::size_t alternative : order) {
      touch.visit(alternative);
    }
  }
}

std::vector<std::string> blind_labels(const PlannedTrial& trial) {
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < trial.alternatives.size(); ++i) {
    labels.push_back(blind_label(i));
  }
  return labels;
}

std::vector<Option> blind_options(std::size_t count) {
  std::vector<Option> options;
  for (std::size_t i = 0; i < count; ++i) {
    options.push_back({blind_label(i), blind_label(i)});
  }
  return options;
}

Answers one_of(std::vector<Option> options) {
  return {AnswerKind::option, std::move(options)};
}

const Alternative& labelled(const PlannedTrial& trial, const std::string& label) {
  for (std::size_t i = 0; i < trial.alternatives.size(); ++i) {
    if (blind_label(i) == label) {
      return trial.alternatives[i];
    }
  }
  throw core::InvalidInput{"trial " + std::to_string(trial.number) + ": the answer '" + label +
                           "' names no alternative"};
}

std::vector<PlannedTrial> ordered_trials(const Task& task, const Block& block, const Draw& draw) {
  std::vector<PlannedTrial> all;
  for (const OrderedCondition& next : ordered_conditions(block, draw)) {
    const std::string& stimulus = block.stimuli.at(stimulus_of(block, next.condition));
    all.push_back({0,
                   block.name,
                   &task,
                   block.is_practice,
                   next.repetition,
                   {{stimulus, values_of(block, next.condition)}}});
  }
  return all;
}

std::vector<PlannedTrial> shuffled_repetitions(
    const Block& block, core::Rng& rng,
    const std::function<std::vector<PlannedTrial>(int repetition)>& trials_of) {
  std::vector<PlannedTrial> all;
  for (int repetition = 1; repetition <= block.repetitions; ++repetition) {
    std::vector<PlannedTrial> part = trials_of(repetition);
    rng.shuffle(part);
    std::ranges::move(part, std::back_inserter(all));
  }
  return all;
}

std::vector<std::pair<std::size_t, std::size_t>> pairs_of(std::size_t count) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t first = 0; first < count; ++first) {
    for (std::size_t second = first + 1; second < count; ++second) {
      pairs.emplace_back(first, second);
    }
  }
  return pairs;
}
}  // namespace tapstudy::protocols
