#include "runner/session/between_trials.hpp"

#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
class CountedRests final : public runner::Participant {
 public:
  explicit CountedRests(double& now_s) : now_s_{now_s} {}
  std::optional<std::string> perform(const runner::TrialPrompt& /*prompt*/,
                                     runner::Exploration& /*exploration*/) override {
    return std::nullopt;
  }
  void rest(const protocols::Breaks& /*breaks*/) override {
    rested_at_s.push_back(now_s_);
    now_s_ += 60.0;  // a long one
  }
  std::vector<double> rested_at_s;

 private:
  double& now_s_;
};

// When rests come in a block of ten trials of 10 s each.
std::vector<double> rests(const protocols::Breaks& breaks) {
  protocols::Protocol protocol;
  protocol.blocks.emplace_back();
  protocol.blocks.front().name = "only";
  protocol.blocks.front().breaks = breaks;
  double now_s = 100.0;
  CountedRests participant{now_s};
  runner::SessionStates states{1, [&] { return now_s; }};
  runner::BetweenTrials between{{protocol, participant, states, [](auto) {}, [] {}}, {}};
  protocols::PlannedTrial trial;
  trial.block = "only";
  for (trial.number = 1; trial.number <= 10; ++trial.number) {
    between.before(trial, {trial});
    states.enter(runner::SessionState::ready, trial.number);
    states.enter(runner::SessionState::exploring, trial.number);
    states.enter(runner::SessionState::confirmed, trial.number);
    states.enter(runner::SessionState::saved, trial.number);
    now_s += 10.0;
  }
  return participant.rested_at_s;
}
}  // namespace

TEST_CASE("the end of practice is said before trials that count, unless their instructions do",
          "[runner][session]") {
  struct Person final : runner::Participant {
    std::optional<std::string> perform(const runner::TrialPrompt& /*prompt*/,
                                       runner::Exploration& /*exploration*/) override {
      return std::nullopt;
    }
    void practice_is_over() override { ++times_said; }
    int times_said{0};
  };
  const auto times_said = [](std::vector<protocols::Block> blocks) {
    protocols::Protocol protocol;
    protocol.blocks = std::move(blocks);
    Person person;
    runner::SessionStates states{1, [] { return 0.0; }};
    runner::BetweenTrials between{{protocol, person, states, [](auto) {}, [] {}}, {}};
    protocols::Schedule schedule(protocol.blocks.size());
    for (std::size_t trial = 0; trial < schedule.size(); ++trial) {
      schedule[trial].block = protocol.blocks[trial].name;
    }
    for (const protocols::PlannedTrial& trial : schedule) {
      between.before(trial, schedule);
      between.before(trial, schedule);
    }
    return person.times_said;
  };
  const auto block = [](std::string name, bool is_practice, std::string instructions = "") {
    protocols::Block made;
    made.name = std::move(name);
    made.is_practice = is_practice;
    made.instructions = std::move(instructions);
    return made;
  };
  CHECK(times_said({block("a", true), block("b", true), block("c", false), block("d", false)}) ==
        1);
  CHECK(times_said({block("a", true), block("b", false, "It counts.")}) == 0);
  CHECK(times_said({block("a", false), block("b", true)}) == 0);
}

TEST_CASE("rests come after so many trials", "[runner][session]") {
  CHECK(rests({.every_trials = 4}) == std::vector{140.0, 240.0});
}

TEST_CASE("rests come after so much time since the last one, between two trials",
          "[runner][session]") {
  CHECK(rests({.every_seconds = 35.0}) == std::vector{140.0, 240.0});
  CHECK(rests({.every_seconds = 1000.0}).empty());
}

TEST_CASE("of trials and time whichever is first brings the rest", "[runner][session]") {
  CHECK(rests({.every_trials = 2, .every_seconds = 35.0}) ==
        std::vector{120.0, 200.0, 280.0, 360.0});
  CHECK(rests({.every_trials = 9, .every_seconds = 35.0}) == std::vector{140.0, 240.0});
}

TEST_CASE("a block's questionnaire that an interruption left open is asked before the next block",
          "[runner][session]") {
  struct Person final : runner::Participant {
    explicit Person(std::vector<std::string>& done) : done_{done} {}
    std::optional<std::string> perform(const runner::TrialPrompt& /*prompt*/,
                                       runner::Exploration& /*exploration*/) override {
      return std::nullopt;
    }
    void read(const std::string& text) override { done_.push_back(text); }
    bool fills_in_forms() const override { return true; }
    FormAnswers fill_in(const protocols::Form& form) override {
      done_.push_back(form.title);
      return {};
    }
    std::vector<std::string>& done_;
  };
  protocols::Protocol protocol;
  protocol.forms["load"].title = "form";
  for (const char* const name : {"first", "second"}) {
    protocols::Block& block = protocol.blocks.emplace_back();
    block.name = name;
    block.instructions = std::string{"read "} + name;
    block.forms_after = {"load"};
  }
  std::vector<std::string> done;
  Person person{done};
  runner::SessionStates states{1, [] { return 0.0; }};
  runner::BetweenTrials between{{protocol, person, states, [](auto) {}, [] {}}, {}};
  protocols::Schedule schedule(2);
  schedule[0].block = "first";
  schedule[1].block = "second";
  between.before(schedule[1], schedule);
  between.before(schedule[1], schedule);
  CHECK(done == std::vector<std::string>{"form", "read second"});
}
