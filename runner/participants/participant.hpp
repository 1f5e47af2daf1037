#pragma once
#include <optional>
#include <string>
#include <vector>

#include "protocols/tasks/task.hpp"
#include "runner/trial_loop/exploration.hpp"
namespace tapstudy::runner {
// A trial as presented to the participant. Does not disclose the rendered stimulus.
struct TrialPrompt {
  int number{};
  int total{};
  bool is_practice{};
  const protocols::Task* task{};
  std::string question;
  std::vector<protocols::Option> options;  // the allowed answers
  std::vector<std::string>
      alternative_labels;  // to switch among; empty: there is nothing to switch
};

// A participant: a person at the terminal, or a simulation.
class Participant {
 public:
  virtual ~Participant() = default;
  // Before the trial's loop starts.
  virtual void get_ready(const TrialPrompt& /*prompt*/) {}
  // Explores and answers: the index of an option, or nullopt if the trial could not be finished.
  virtual std::optional<std::size_t> perform(const TrialPrompt& prompt,
                                             Exploration& exploration) = 0;
  // Called once the answer is stored.
  virtual void saved(const TrialPrompt& /*prompt*/) {}
};
}  // namespace tapstudy::runner
