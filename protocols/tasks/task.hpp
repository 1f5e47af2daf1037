#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/rng.hpp"
namespace tapstudy::protocols {
class MapReader;
class Task;
struct Block;
struct Protocol;
struct SimulatedTapSettings;
struct Simulation;

// What a hypothesis may say of a block.
enum class Claim { accuracy_above_chance, chosen_above_chance };

struct PlannedTrial {
  int number{};  // from 1, in the order presented
  std::string block;
  const Task* task{};
  bool is_practice{false};
  int repetition{};  // from 1
  // What can be rendered in the trial, in the order of its alternatives.
  std::vector<std::string> stimuli;
};

// Whose order a block's trials are drawn for.
struct Draw {
  std::uint64_t participant_seed{};
  int participant_index{};  // from 0; counterbalancing goes by it
  std::size_t block_index{};
};

// An allowed answer: its name for those who compare, what a person reads.
struct Option {
  std::string name;
  std::string label;
};

// What a simulated participant can do in a trial. It is never told which stimulus is rendered.
class SimulatedTouch {
 public:
  virtual ~SimulatedTouch() = default;
  // Switches to an alternative, if there are several, and taps there for one visit.
  virtual void visit(std::size_t alternative) = 0;
  // Which of these remembered plates is the first alternative most like?
  virtual std::size_t most_similar_plate(const std::vector<std::string>& plates) = 0;
  // Which of the alternatives is most like this remembered plate?
  virtual std::size_t most_similar_alternative(const std::string& plate) = 0;
  virtual core::Rng& rng() = 0;  // of the hand
};

// One way to ask: what is presented, which answers are allowed, what is right, what is stored. A
// block's summary is a statistic of analysis, named here. Adding one: a file beside this with its
// class, and a row in task_table.cpp; nothing else knows a task by its name.
class Task {
 public:
  virtual ~Task() = default;
  virtual std::string_view name() const = 0;       // in protocols and stores
  virtual std::string_view statistic() const = 0;  // that summarises a block of it

  // Its own keys of a block; problems go to the reader. The common keys are read already.
  virtual void read(MapReader& reader, const Protocol& protocol, Block& block) const = 0;
  virtual Claim claim() const = 0;
  // Whether simulated participants need simulation.observer.reference.
  virtual bool needs_reference() const = 0;
  // Whether the block's order, Williams's among others, decides what is presented when.
  virtual bool uses_order() const = 0;

  // The block's trials, numbers left open.
  virtual std::vector<PlannedTrial> trials(const Block& block, const Draw& draw) const = 0;
  virtual std::size_t trials_per_repetition(const Block& block) const = 0;

  // Allowed answers; what each is in the store; what a person calls each alternative of a trial, by
  // which it is switched to (empty: nothing to switch).
  virtual std::vector<Option> options(const Block& block, const Protocol& protocol) const = 0;
  virtual std::string response(const PlannedTrial& trial, const Block& block,
                               std::size_t option) const = 0;
  virtual std::vector<std::string> alternative_labels(const PlannedTrial& trial) const = 0;
  // Nothing where no answer is more right than another.
  virtual std::optional<bool> is_correct(const PlannedTrial& trial,
                                         const std::string& response) const = 0;
  // "of 80 answers 27 must …"
  virtual std::string_view success() const = 0;

  // Which real plates a simulated participant has to remember, how many visits a trial takes it,
  // and how it comes to its answer, the index of an option.
  virtual std::vector<std::string> remembered_plates(const Block& block,
                                                     const Simulation& simulation) const = 0;
  virtual int visits(const Block& block, const SimulatedTapSettings& taps) const = 0;
  virtual std::size_t simulated_answer(const std::vector<Option>& options,
                                       const Simulation& simulation,
                                       SimulatedTouch& touch) const = 0;
};

// All there are. nullptr if there is none of that name.
const std::vector<const Task*>& tasks();
const Task* find_task(std::string_view name);

// "A", "B", … for alternatives that must not be known by name.
std::string blind_label(std::size_t position);
}  // namespace tapstudy::protocols
