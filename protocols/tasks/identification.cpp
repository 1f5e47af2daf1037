#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <ranges>

#include "protocols/protocol.hpp"
#include "protocols/reader/read_sections.hpp"
#include "protocols/schedule/catch_trials.hpp"
#include "protocols/schedule/ordering.hpp"
#include "protocols/tasks/shared_keys.hpp"
#include "protocols/tasks/task.hpp"
#include "protocols/tasks/task_parts.hpp"
namespace tapstudy::protocols {
namespace {
// Its levels among these stimuli, in their order.
std::vector<std::string> levels_of(const std::string& factor, const Protocol& protocol,
                                   const std::vector<std::string>& stimuli) {
  std::vector<std::string> levels;
  for (const Stimulus& stimulus : protocol.stimuli) {
    const auto level = stimulus.factors.find(factor);
    if (level != stimulus.factors.end() &&
        std::ranges::find(stimuli, stimulus.name) != stimuli.end() &&
        std::ranges::find(levels, level->second) == levels.end()) {
      levels.push_back(level->second);
    }
  }
  return levels;
}

Key responses_key() {
  return {
      "responses",
      "identification only: allowed answers, at least 2: stimuli, those presented among them, or "
      "levels of response_factor; unset: the stimuli, or their levels"};
}

// Levels are refused with the factor that is to be named.
void read_stimuli_as_responses(MapReader& reader, const std::vector<std::string>& factors,
                               const Protocol& protocol, Block& block) {
  const std::vector<std::string> stimuli = stimulus_names(protocol);
  std::map<std::string, std::string> factor_of;  // by level
  std::vector<std::string> known = stimuli;
  for (const std::string& factor : factors) {
    for (const std::string& level : levels_of(factor, protocol, stimuli)) {
      factor_of.emplace(level, factor);
      known.push_back(level);
    }
  }
  block.responses = reader.words(responses_key(), "stimulus", known, block.stimuli);
  for (const std::string& response : block.responses) {
    if (std::ranges::find(stimuli, response) == stimuli.end()) {
      reader.reject("responses", fmt::format("'{0}' is a level of the factor '{1}': add "
                                             "response_factor: {1}",
                                             response, factor_of.at(response)));
      block.responses = block.stimuli;
      return;
    }
  }
}

void read_responses(MapReader& reader, const Protocol& protocol, Block& block) {
  const std::vector<std::string> factors = protocol.stimuli.empty()
                                               ? std::vector<std::string>{}
                                               : keys_of(protocol.stimuli.front().factors);
  if (!reader.has("response_factor")) {
    read_stimuli_as_responses(reader, factors, protocol, block);
    return;
  }
  block.response_factor =
      reader.word({"response_factor",
                   "identification only: the factor that is asked for (which material?), whose "
                   "levels are the answers; unset: the stimulus"},
                  "factor", factors);
  block.responses =
      reader.words(responses_key(), "level",
                   levels_of(block.response_factor, protocol, stimulus_names(protocol)),
                   levels_of(block.response_factor, protocol, block.stimuli));
  read_response_labels(reader, block.responses, block);
}

// Of those that were not rejected already.
std::map<std::string, std::string> right_responses(const Protocol& protocol, const Block& block) {
  std::map<std::string, std::string> right;
  for (const Stimulus& stimulus : protocol.stimuli) {
    if (std::ranges::find(block.stimuli, stimulus.name) == block.stimuli.end()) {
      continue;
    }
    const auto level = stimulus.factors.find(block.response_factor);
    right[stimulus.name] = block.response_factor.empty()     ? stimulus.name
                           : level == stimulus.factors.end() ? std::string{}
                                                             : level->second;
  }
  return right;
}

std::string label_of(const std::string& response, const Block& block, const Protocol& protocol) {
  const auto stimulus = std::ranges::find(protocol.stimuli, response, &Stimulus::name);
  if (block.response_factor.empty()) {
    return stimulus == protocol.stimuli.end() ? response : stimulus->label;
  }
  const auto label = block.response_labels.find(response);
  return label == block.response_labels.end() ? response : label->second;
}

const std::vector<std::string>& known_stimuli(const Block& block) {
  return block.response_factor.empty() ? block.responses : block.stimuli;
}

class Identification final : public Task {
 public:
  std::string_view name() const override { return "identification"; }
  std::string_view statistic(const Block& /*block*/) const override { return "confusion"; }
  std::optional<Claim> claim() const override { return Claim::accuracy_above_chance; }
  bool needs_reference() const override { return false; }
  bool has_correct_answer() const override { return true; }
  bool uses_order() const override { return true; }
  bool can_present_real_plates() const override { return true; }
  int counted_answers(const Block& block) const override {
    return block.repetitions * static_cast<int>(block.stimuli.size());
  }
  std::string_view success() const override { return "be right"; }

  void read(MapReader& reader, const Protocol& protocol, Block& block) const override {
    read_responses(reader, protocol, block);
    block.right_response = right_responses(protocol, block);
    reader.check("responses", block.responses.size() >= 2, R"({"minItems": 2})",
                 "an identification needs at least two possible answers");
    for (const auto& [stimulus, right] : block.right_response) {
      if (std::ranges::find(block.responses, right) == block.responses.end()) {
        reader.reject("responses", fmt::format("'{}' is presented, but '{}' cannot be answered",
                                               stimulus, right));
      }
    }
    block.catch_trials = read_catch_trials(reader, protocol, block);
  }

  std::vector<PlannedTrial> trials(const Block& block, const Draw& draw) const override {
    return with_catch_trials(ordered_trials(*this, block, draw), block, draw);
  }
  std::size_t trials_per_repetition(const Block& block) const override {
    return block.stimuli.size();
  }

  Answers answers(const Block& block, const Protocol& protocol) const override {
    std::vector<Option> all;
    for (const std::string& response : block.responses) {
      all.push_back({response, label_of(response, block, protocol)});
    }
    return one_of(std::move(all));
  }
  std::vector<std::string> alternative_labels(const PlannedTrial& /*trial*/) const override {
    return {};
  }
  std::optional<bool> is_correct(const PlannedTrial& trial, const Block& block,
                                 const std::string& response) const override {
    // a trial from a store may be of a block without such trials
    if (trial.alternatives.empty() || (trial.is_catch && !block.catch_trials)) {
      return std::nullopt;
    }
    const auto& right = trial.is_catch ? block.catch_trials->expected : block.right_response;
    const auto found = right.find(trial.alternatives.front().stimulus);
    return found == right.end() ? std::nullopt : std::optional{response == found->second};
  }

  // Asked for a factor, all that was presented is remembered: its levels are no plates.
  std::vector<Remembered> remembered(const Block& block,
                                     const Simulation& /*simulation*/) const override {
    std::vector<Remembered> all;
    for (const std::string& name : known_stimuli(block)) {
      all.push_back({name, name});
    }
    return all;
  }
  int visits(const Block& /*block*/, const SimulatedTapSettings& /*taps*/) const override {
    return 1;
  }
  std::string simulated_answer(const Block& block, const Simulation& /*simulation*/,
                               SimulatedTouch& touch) const override {
    touch.visit(0);
    const std::vector<std::string>& stimuli = known_stimuli(block);
    const std::string& felt = stimuli.at(touch.most_similar_stimulus(stimuli));
    return block.response_factor.empty() ? felt : block.right_response.at(felt);
  }
};
}  // namespace

const Task& identification() {
  static const Identification task;
  return task;
}
}  // namespace tapstudy::protocols
