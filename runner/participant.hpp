#pragma once
#include <optional>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "runner/presenter.hpp"
namespace tapstudy::runner {
// One trial as a participant meets it. Which stimulus is rendered is not in it.
struct Presentation {
  int number{};
  int total{};
  bool is_practice{};
  protocols::Task task{};
  std::string question;
  // identification: names of the possible answers; choice: the alternatives' blind labels.
  std::vector<std::string> options;
  std::vector<std::string> option_labels;  // what a person reads
};

// Who sits at the study: a person at the terminal, or a simulation.
class Participant {
 public:
  virtual ~Participant() = default;
  // Before the trial's loop starts.
  virtual void get_ready(const Presentation& /*presentation*/) {}
  // Explores and answers: the index of an option, or nothing if the trial could not be finished.
  virtual std::optional<std::size_t> perform(const Presentation& presentation,
                                             Exploration& exploration) = 0;
  // The answer is in the store.
  virtual void saved(const Presentation& /*presentation*/) {}
};
}  // namespace tapstudy::runner
