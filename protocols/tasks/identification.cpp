#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "protocols/ordering.hpp"
#include "protocols/protocol.hpp"
#include "protocols/read_sections.hpp"
#include "protocols/tasks/shipped_tasks.hpp"
namespace tapstudy::protocols {
namespace {
// Two answers that read alike cannot be told apart by who gives them.
void check_labels_differ(MapReader& reader, const Protocol& protocol, const Block& block) {
  std::map<std::string, std::string> name_of_label;
  for (const std::string& response : block.responses) {
    const auto stimulus = std::ranges::find(protocol.stimuli, response, &Stimulus::name);
    if (stimulus == protocol.stimuli.end()) {
      continue;  // rejected already
    }
    const auto [known, is_new] = name_of_label.emplace(stimulus->label, response);
    if (!is_new) {
      reader.reject("responses", fmt::format("'{}' and '{}' have the same label, '{}'",
                                             known->second, response, stimulus->label));
    }
  }
}

class Identification final : public Task {
 public:
  std::string_view name() const override { return "identification"; }
  std::string_view statistic() const override { return "confusion"; }
  Claim claim() const override { return Claim::accuracy_above_chance; }
  bool needs_reference() const override { return false; }
  bool has_correct_answer() const override { return true; }
  bool uses_order() const override { return true; }
  bool is_random(const Block& block) const override { return block.order != Order::listed; }
  int counted_answers(const Block& block) const override {
    return block.repetitions * static_cast<int>(block.stimuli.size());
  }
  std::string_view success() const override { return "be right"; }

  void read(MapReader& reader, const Protocol& protocol, Block& block) const override {
    block.responses =
        reader.words("responses", "stimulus", stimulus_names(protocol), block.stimuli);
    check_labels_differ(reader, protocol, block);
    if (block.responses.size() < 2) {
      reader.reject("responses", "an identification needs at least two possible answers");
    }
    for (const std::string& stimulus : block.stimuli) {
      if (std::ranges::find(block.responses, stimulus) == block.responses.end()) {
        reader.reject("responses",
                      fmt::format("'{}' is presented but cannot be answered", stimulus));
      }
    }
  }

  std::vector<PlannedTrial> trials(const Block& block, const Draw& draw) const override {
    core::Rng rng{
        core::derived_seed(draw.participant_seed, core::Purpose::schedule, draw.block_index)};
    std::vector<PlannedTrial> all;
    for (const OrderedStimulus& next :
         ordered_stimuli(block, rng, {draw.order_index, draw.counterbalancing_seed})) {
      all.push_back({0, block.name, this, block.is_practice, next.repetition, {next.stimulus}});
    }
    return all;
  }
  std::size_t trials_per_repetition(const Block& block) const override {
    return block.stimuli.size();
  }

  std::vector<Option> options(const Block& block, const Protocol& protocol) const override {
    std::vector<Option> all;
    for (const std::string& response : block.responses) {
      all.push_back({response, protocol.stimulus(response).label});
    }
    return all;
  }
  std::string response(const PlannedTrial& /*trial*/, const Block& block,
                       std::size_t option) const override {
    return block.responses.at(option);
  }
  std::vector<std::string> alternative_labels(const PlannedTrial& /*trial*/) const override {
    return {};
  }
  std::optional<bool> is_correct(const PlannedTrial& trial,
                                 const std::string& response) const override {
    return response == trial.stimuli.front();
  }

  std::vector<std::string> remembered_stimuli(const Block& block,
                                              const Simulation& /*simulation*/) const override {
    return block.responses;
  }
  int visits(const Block& /*block*/, const SimulatedTapSettings& /*taps*/) const override {
    return 1;
  }
  std::size_t simulated_answer(const std::vector<Option>& options, const Simulation& /*simulation*/,
                               SimulatedTouch& touch) const override {
    touch.visit(0);
    std::vector<std::string> stimuli;
    std::ranges::transform(options, std::back_inserter(stimuli), &Option::name);
    return touch.most_similar_stimulus(stimuli);
  }
};
}  // namespace

const Task& identification() {
  static const Identification task;
  return task;
}
}  // namespace tapstudy::protocols
