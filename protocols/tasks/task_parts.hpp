#pragma once
#include <functional>

#include "core/random/rng.hpp"
#include "protocols/protocol.hpp"
// What several tasks share.
namespace tapstudy::protocols {
// Every alternative a few times, in a new random order each time.
void visit_all(std::size_t alternatives, const Simulation& simulation, SimulatedTouch& touch);

// Blind labels of all alternatives of a trial; the names and labels of the first so many.
std::vector<std::string> blind_labels(const PlannedTrial& trial);
std::vector<Option> blind_options(std::size_t count);
// The answers of a trial in which one of these is picked.
Answers one_of(std::vector<Option> options);

// The alternative that a blind label names. Throws InvalidInput if none has it.
const Alternative& labelled(const PlannedTrial& trial, const std::string& label);

// A trial of each of the block's conditions in their order, with this one alternative.
std::vector<PlannedTrial> ordered_trials(const Task& task, const Block& block, const Draw& draw);
// What `trials_of` makes of each repetition, shuffled within it.
std::vector<PlannedTrial> shuffled_repetitions(
    const Block& block, core::Rng& rng,
    const std::function<std::vector<PlannedTrial>(int repetition)>& trials_of);

// Of `count` things taken two at a time, each with a smaller and a greater place.
std::vector<std::pair<std::size_t, std::size_t>> pairs_of(std::size_t count);

// No answer is right: participants say what they prefer, or how much. Simulated ones compare with
// the stimulus that the protocol takes for reality.
class PreferenceTask : public Task {
 public:
  bool needs_reference() const override { return true; }
  bool has_correct_answer() const override { return false; }
  int counted_answers(const Block& /*block*/) const override { return 1; }  // a vote
  std::optional<bool> is_correct(const PlannedTrial& /*trial*/, const Block& /*block*/,
                                 const std::string& /*response*/) const override {
    return std::nullopt;
  }
  std::vector<Remembered> remembered(const Block& /*block*/,
                                     const Simulation& simulation) const override {
    return {{simulation.observer.reference, simulation.observer.reference}};
  }
};
}  // namespace tapstudy::protocols
