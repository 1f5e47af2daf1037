#include "runner/session/engine/trial_engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <utility>

#include "device/hand/prescribed_hand.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "results/store/store.hpp"
#include "results/store/study_queries.hpp"
#include "runner/session/devices/rigs.hpp"
#include "runner/session/engine/between_trials.hpp"
#include "runner/session/engine/remaining_trials.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/session/engine/session_states.hpp"
#include "runner/session/engine/trial_record.hpp"
#include "runner/session/trial_loop/live_trial_loop.hpp"
#include "runner/terminal/process_exit.hpp"
#include "support/catch.hpp"
#include "support/no_real_plates.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
// A loop whose first trials each have an impact just after a late tick, or stall when answered; or
// whose every trial ends in a fault after the answer.
struct Troubles {
  int late_trials{0};
  int stalled_trials{0};
  core::TickFault fault{core::TickFault::none};
};
class TroubledTrialLoop final : public runner::TrialLoop {
 public:
  explicit TroubledTrialLoop(Troubles troubles) : troubles_{troubles} {}
  runner::TrialResult run(const runner::Rendered& /*rendered*/,
                          const runner::Explore& explore) override {
    struct Nothing final : runner::Exploration {
      bool is_stalled{};
      void request_position(std::size_t /*position*/) override {}
      void request_silence(bool /*is_silent*/) override {}
      bool is_as_requested() const override { return true; }
      void pass_time(double /*seconds*/) override {}
      bool is_running() const override { return true; }
      bool is_rendering() const override { return !is_stalled; }
      double time_s() const override { return 1.0; }
      int contacts(std::size_t /*position*/) const override { return 1; }
    } exploration;
    exploration.is_stalled = troubles_.stalled_trials-- > 0;
    explore(exploration);
    runner::TrialResult result;
    result.trace.events = {{0.5, "impact", 0.3}};
    if (troubles_.late_trials-- > 0) {
      result.trace.events.push_back({0.5, "late_impact", 0.3});
    }
    result.loop.stopped_by = troubles_.fault;
    return result;
  }

 private:
  Troubles troubles_;
};

class FirstOption final : public runner::Participant {
 public:
  std::optional<std::string> perform(const runner::TrialPrompt& prompt,
                                     runner::TrialControl& /*control*/) override {
    return prompt.answers.options.front().name;
  }
  void repeats(const runner::TrialPrompt& /*prompt*/) override { ++repeats_told; }
  int repeats_told{0};
};

// A study of choices, and what is stored when its schedule is run on a troubled loop.
struct Study {
  explicit Study(int max_late_impact_repeats)
      : protocol{protocols::parse_protocol(
            testing::replaced(testing::contents(testing::shipped("paper/reality_finger.yaml")),
                              "task: choice",
                              fmt::format("task: choice\n    max_late_impact_repeats: {}",
                                          max_late_impact_repeats)),
            "study.yaml")} {
    session.participant_id = "P01";
    store.add_session(session);
  }
  void run(Troubles troubles) {
    std::set<int> done;
    CHECK_FALSE(run(troubles, done));
    CHECK(done.size() == schedule.size());
  }
  std::optional<runner::Interruption> run(Troubles troubles, std::set<int>& done) {
    TroubledTrialLoop loop{troubles};
    results::Recorder recorder{store};
    runner::SessionStates states{session.id, [] { return 0.0; }};
    runner::Operator nobody;
    testing::NoRealPlates no_plates;
    runner::TrialEngine engine{{protocol, models, loop, no_plates, participant, nobody, states},
                               recorder};
    return engine.run(schedule, done);
  }

  testing::TempDirectory directory;
  protocols::Protocol protocol;
  results::Store store{
      results::Store::open_or_create(directory / "out", runner::study_row(protocol, "study.yaml"))};
  results::SessionRow session;
  protocols::Schedule schedule{protocols::make_schedule(protocol, 1, 0)};
  runner::ModelLibrary models;
  FirstOption participant;
};
}  // namespace

TEST_CASE(
    "a trial with an impact just after a late tick is presented again where the block says so",
    "[runner][session][threads]") {
  const int allowed = GENERATE(0, 2);
  const int late_trials = GENERATE(0, 1, 5);
  CAPTURE(allowed, late_trials);
  Study study{allowed};
  study.run({.late_trials = late_trials});
  CHECK(study.participant.repeats_told == std::min(allowed, late_trials));
  const auto answers = results::stored_answers(study.store);
  REQUIRE(answers.size() == study.schedule.size());  // the repeated ones do not count
  CHECK(answers.front().impacts == 1);
  CHECK(answers.front().late_impacts == (late_trials > allowed ? 1 : 0));
}

namespace {
// A plate that is touched once in every second, in a time that passes with each answer.
class PassingTime final : public runner::TrialLoop {
 public:
  explicit PassingTime(double touches_per_s) : touches_per_s_{touches_per_s} {}
  runner::TrialResult run(const runner::Rendered& /*rendered*/,
                          const runner::Explore& explore) override {
    struct Passing final : runner::Exploration {
      double now_s{0.0};
      double touches_per_s{};
      void request_position(std::size_t /*position*/) override {}
      void request_silence(bool /*is_silent*/) override {}
      bool is_as_requested() const override { return true; }
      void pass_time(double seconds) override { now_s += seconds; }
      bool is_running() const override { return true; }
      bool is_rendering() const override { return true; }
      double time_s() const override { return now_s; }
      int contacts(std::size_t position) const override {
        return std::max(0, static_cast<int>(touches_per_s * now_s) - static_cast<int>(position));
      }
    } exploration;
    exploration.touches_per_s = touches_per_s_;
    explore(exploration);
    return {};
  }

 private:
  double touches_per_s_;
};

// Answers at once, and a second later again.
class Hasty final : public runner::Participant {
 public:
  std::optional<std::string> perform(const runner::TrialPrompt& prompt,
                                     runner::TrialControl& control) override {
    if (!control.poll()) {
      return std::nullopt;
    }
    control.pass_time(1.0);
    return control.poll() ? std::optional{prompt.answers.options.front().name} : std::nullopt;
  }
  void refused(const runner::TrialPrompt& /*prompt*/, const runner::TooEarly& why) override {
    reasons.push_back(to_text(why));
  }
  void timed_out(const runner::TrialPrompt& prompt, bool is_presented_again) override {
    ended.emplace_back(prompt.number, is_presented_again);
  }
  std::vector<std::string> reasons;
  std::vector<std::pair<int, bool>> ended;
};

struct HastySession {
  HastySession(const std::string& explore, double touches_per_s) {
    const protocols::Protocol protocol = protocols::parse_protocol(
        testing::replaced(testing::contents(testing::shipped("paper/reality_finger.yaml")),
                          "task: choice", "task: choice\n    repetitions: 2\n    " + explore),
        "study.yaml");
    results::Store store = results::Store::open_or_create(
        directory / "out", runner::study_row(protocol, "study.yaml"));
    results::SessionRow session;
    session.participant_id = "P01";
    store.add_session(session);
    {
      PassingTime loop{touches_per_s};
      results::Recorder recorder{store};
      runner::ModelLibrary models;
      runner::SessionStates states{session.id, [] { return 0.0; }};
      runner::Operator nobody;
      testing::NoRealPlates no_plates;
      runner::TrialEngine engine{{protocol, models, loop, no_plates, participant, nobody, states},
                                 recorder};
      CHECK_FALSE(engine.run(protocols::make_schedule(protocol, 1, 0), done));
    }
    answers = results::stored_answers(store);
    for (const results::UnansweredTrial& trial : store.unanswered_trials("P01")) {
      timed_out.push_back(trial.number);
    }
  }
  testing::TempDirectory directory;
  Hasty participant;
  std::set<int> done;
  std::vector<results::AnswerRow> answers;
  std::vector<int> timed_out;
};
}  // namespace

TEST_CASE("a choice is refused until every alternative was tapped, then taken",
          "[runner][session][threads]") {
  const HastySession hasty{"explore: {}", 1.0};
  REQUIRE(hasty.answers.size() == 2);
  // alternative i is tapped i + 1 seconds on
  REQUIRE(hasty.participant.reasons.size() == 4);
  CHECK(hasty.participant.reasons.at(0) == "please tap B, C first");
  CHECK(hasty.participant.reasons.at(1) == "please tap C first");
  CHECK(hasty.answers.front().response_time_s == 3.0);
}

TEST_CASE("nothing is asked of the hand where the block says so", "[runner][session][threads]") {
  const HastySession hasty{"explore: {min_contacts: 0, min_seconds: 2}", 0.0};
  CHECK(hasty.participant.reasons ==
        std::vector<std::string>{"please take 2 s at least", "please take 2 s at least"});
  CHECK(hasty.answers.size() == 2);
}

TEST_CASE("a trial whose time is over comes again, or is stored without an answer",
          "[runner][session][threads]") {
  const HastySession given_up{"explore: {max_seconds: 5, at_limit: give_up}", 0.0};
  CHECK(given_up.participant.ended == std::vector<std::pair<int, bool>>{{1, false}, {2, false}});
  CHECK(given_up.answers.empty());
  CHECK(given_up.done.size() == 2);
  CHECK(given_up.timed_out == std::vector<int>{1, 2});
}

TEST_CASE(
    "an answer before a fault that is found late is none, since nobody knows what was felt; one "
    "before any other fault is kept",
    "[runner][session][threads]") {
  using enum core::TickFault;
  const auto [fault, is_kept] = GENERATE(table<core::TickFault, bool>({{no_reply, true},
                                                                       {device_gone, true},
                                                                       {stop_unconfirmed, true},
                                                                       {position_frozen, false},
                                                                       {force_not_followed, false},
                                                                       {velocity_wrong, false},
                                                                       {periods_missed, false},
                                                                       {too_late, false},
                                                                       {actuator_gaps, false},
                                                                       {actuator_lost, false},
                                                                       {amplifier_off, false}}));
  CAPTURE(core::to_text(fault));
  Study study{0};
  std::set<int> done;
  const auto interruption = study.run({.fault = fault}, done);
  REQUIRE(interruption);
  CHECK(interruption->fault == fault);
  CHECK(interruption->is_answered == is_kept);
  CHECK(done.size() == (is_kept ? 1U : 0U));
  CHECK(results::stored_answers(study.store).size() == done.size());
}

TEST_CASE("an answer given while nothing is rendered is no answer: the trial is presented again",
          "[runner][session][threads]") {
  Study study{0};
  study.run({.stalled_trials = 2});
  CHECK(study.participant.repeats_told == 2);
  CHECK(results::stored_answers(study.store).size() == study.schedule.size());
}

namespace {
protocols::Schedule two_blocks() {
  protocols::Schedule schedule;
  for (int number = 1; number <= 6; ++number) {
    protocols::PlannedTrial trial;
    trial.number = number;
    trial.block = number <= 4 ? "first" : "second";
    schedule.push_back(trial);
  }
  return schedule;
}
std::vector<int> numbers_of(const std::deque<protocols::PlannedTrial>& trials) {
  std::vector<int> numbers;
  for (const protocols::PlannedTrial& trial : trials) {
    numbers.push_back(trial.number);
  }
  return numbers;
}
}  // namespace

TEST_CASE("a session that is resumed presents requeued trials where it would have gone on to",
          "[runner][session]") {
  const protocols::Schedule schedule = two_blocks();
  auto waiting = runner::waiting_trials(schedule, {}, {});
  for (const int number : {1, 2}) {
    const protocols::PlannedTrial trial = waiting.front();
    REQUIRE(trial.number == number);
    waiting.pop_front();
    runner::put_at_end_of_block(trial, waiting);
  }
  CHECK(numbers_of(waiting) == std::vector{3, 4, 1, 2, 5, 6});
  CHECK(numbers_of(runner::waiting_trials(schedule, {}, {1, 2})) == numbers_of(waiting));
  // requeued once more, in the other order; what is done is not presented
  CHECK(numbers_of(runner::waiting_trials(schedule, {3, 4}, {2, 1})) == std::vector{2, 1, 5, 6});
  CHECK(numbers_of(runner::waiting_trials(schedule, {1, 2, 3}, {2, 4})) == std::vector{4, 5, 6});
  CHECK(numbers_of(runner::waiting_trials(schedule, {}, {6, 5})) == std::vector{1, 2, 3, 4, 6, 5});
}

TEST_CASE("what is left takes as long a trial as what was presented, once that is known",
          "[runner][session]") {
  protocols::Protocol protocol;
  for (const char* const name : {"first", "second"}) {
    protocol.blocks.emplace_back().name = name;
  }
  const protocols::Schedule schedule = two_blocks();
  using Progress = runner::SessionProgress;
  CHECK_FALSE(Progress(schedule, {1, 2}, protocol).left_s(20.0, 2));
  CHECK(Progress(schedule, {1, 2}, protocol).left_s(30.0, 3) == 40.0);
  protocol.blocks[1].criterion = protocols::PracticeCriterion{1, 1};
  CHECK_FALSE(Progress(schedule, {1, 2}, protocol).left_s(30.0, 3));
  CHECK(Progress(schedule, {1, 2, 3, 4, 5, 6}, protocol).left_s(30.0, 3) == 0.0);
}

TEST_CASE("progress that is kept trial by trial is that counted anew", "[runner][session]") {
  protocols::Protocol protocol;
  for (const char* const name : {"first", "second"}) {
    protocol.blocks.emplace_back().name = name;
  }
  protocol.blocks[0].is_practice = true;
  protocol.blocks[0].criterion = protocols::PracticeCriterion{1, 1};
  const protocols::Schedule schedule = two_blocks();
  runner::SessionProgress kept{schedule, {}, protocol};
  std::set<int> done;
  for (const int number : {2, 1, 5, 4, 3, 6}) {
    const auto trial = std::ranges::find(schedule, number, &protocols::PlannedTrial::number);
    kept.note_done(*trial);
    done.insert(number);
    const runner::SessionProgress anew{schedule, done, protocol};
    for (const protocols::PlannedTrial& other : schedule) {
      CHECK(kept.before(other).done == anew.before(other).done);
      CHECK(kept.before(other).total == (other.block == "first" ? 4 : 2));
    }
    CHECK(kept.left_s(30.0, 3) == anew.left_s(30.0, 3));
    CHECK(kept.left_s(30.0, 3).has_value() == (done.contains(3) && done.contains(4)));
  }
}

namespace {
class CountedRests final : public runner::Participant {
 public:
  explicit CountedRests(double& now_s) : now_s_{now_s} {}
  std::optional<std::string> perform(const runner::TrialPrompt& /*prompt*/,
                                     runner::TrialControl& /*control*/) override {
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
                                       runner::TrialControl& /*control*/) override {
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

namespace {
// Notes what is read and which forms are filled in.
struct Reading final : runner::Participant {
  std::optional<std::string> perform(const runner::TrialPrompt& /*prompt*/,
                                     runner::TrialControl& /*control*/) override {
    return std::nullopt;
  }
  void read(const std::string& text, const std::optional<protocols::Picture>&) override {
    done.push_back(text);
  }
  bool fills_in_forms() const override { return true; }
  protocols::FormAnswers fill_in(const protocols::Form& form) override {
    done.push_back(form.title);
    return {};
  }
  std::vector<std::string> done;
};

// Each block with instructions and a form.
protocols::Protocol with_forms_after(const std::vector<std::string>& blocks) {
  protocols::Protocol protocol;
  protocol.forms["load"].name = "load";
  protocol.forms["load"].title = "form";
  protocol.forms["load"].items.emplace_back().is_required = false;
  for (const std::string& name : blocks) {
    protocols::Block& block = protocol.blocks.emplace_back();
    block.name = block.measure = name;
    block.instructions = "read " + name;
    block.forms_after = {"load"};
  }
  return protocol;
}

protocols::Schedule trials_of(const std::vector<std::string>& blocks) {
  protocols::Schedule schedule;
  for (const std::string& block : blocks) {
    schedule.emplace_back().block = block;
  }
  return schedule;
}
}  // namespace

TEST_CASE("a block's questionnaire that an interruption left open is asked before the next block",
          "[runner][session]") {
  const protocols::Protocol protocol = with_forms_after({"first", "second"});
  Reading person;
  runner::SessionStates states{1, [] { return 0.0; }};
  runner::BetweenTrials between{{protocol, person, states, [](auto) {}, [] {}}, {}};
  const protocols::Schedule schedule = trials_of({"first", "second"});
  between.before(schedule[1], schedule);
  between.before(schedule[1], schedule);
  CHECK(person.done == std::vector<std::string>{"form", "read second"});
}

TEST_CASE("instructions of mixed blocks are read before the first of them, forms follow the last",
          "[runner][session]") {
  protocols::Protocol protocol = with_forms_after({"a", "b", "c"});
  protocol.blocks[1].mixed_with = "a";
  Reading person;
  runner::SessionStates states{1, [] { return 0.0; }};
  runner::BetweenTrials between{{protocol, person, states, [](auto) {}, [] {}}, {}};
  const protocols::Schedule schedule = trials_of({"b", "a", "b", "c"});
  for (const protocols::PlannedTrial& trial : schedule) {
    between.before(trial, schedule);
  }
  CHECK(person.done == std::vector<std::string>{"read a", "read b", "form", "form", "read c"});
}

TEST_CASE("a requeued trial of a resumed session follows the last of its block, mixed or not",
          "[runner][session]") {
  protocols::Schedule schedule = trials_of({"a", "b", "a", "b", "c"});
  for (std::size_t i = 0; i < schedule.size(); ++i) {
    schedule[i].number = static_cast<int>(i) + 1;
  }
  std::vector<int> numbers;
  for (const protocols::PlannedTrial& trial : runner::waiting_trials(schedule, {}, {1})) {
    numbers.push_back(trial.number);
  }
  CHECK(numbers == std::vector<int>{2, 3, 1, 4, 5});
}

namespace {
// Answers every form with the same.
struct Willing final : runner::Participant {
  explicit Willing(protocols::FormAnswers answers) : answers_{std::move(answers)} {}
  std::optional<std::string> perform(const runner::TrialPrompt& /*prompt*/,
                                     runner::TrialControl& /*control*/) override {
    return std::nullopt;
  }
  bool fills_in_forms() const override { return true; }
  protocols::FormAnswers fill_in(const protocols::Form& form) override {
    asked_.push_back(form.name);
    return answers_;
  }
  protocols::FormAnswers answers_;
  std::vector<std::string> asked_;
};

protocols::Protocol with_consent() {
  protocols::Protocol protocol;
  protocols::Form& consent = protocol.forms["consent"];
  consent.name = "consent";
  protocols::FormItem item;
  item.kind = protocols::ItemKind::single_choice;
  item.options = {{"yes", "Yes"}, {"no", "No"}};
  item.name = "agree";
  item.ends_session = {"no"};
  consent.items.push_back(item);
  item.name = "hand";
  item.ends_session = {};
  consent.items.push_back(item);
  protocol.forms["about"].name = "about";
  protocol.forms["about"].items.push_back(item);
  protocol.forms_before = {"consent", "about"};
  for (const char* const name : {"yes", "no", "all"}) {
    protocols::Block& block = protocol.blocks.emplace_back();
    block.name = name;
    if (block.name != "all") {
      block.presented_if = protocols::AnswerCondition{"consent", "hand", {name}};
    }
  }
  return protocol;
}

std::function<void(std::vector<results::FormAnswerRow>)> added_to(
    std::vector<results::FormAnswerRow>& stored) {
  return [&stored](const std::vector<results::FormAnswerRow>& rows) {
    stored.insert(stored.end(), rows.begin(), rows.end());
  };
}
}  // namespace

TEST_CASE("of who takes no part nothing is asked or stored but the answer that says so",
          "[runner][session]") {
  const protocols::Protocol protocol = with_consent();
  Willing person{{{"agree", "no"}, {"hand", "yes"}}};
  runner::SessionStates states{1, [] { return 0.0; }};
  std::vector<results::FormAnswerRow> stored;
  runner::BetweenTrials between{
      {protocol, person, states,
       [&](std::vector<results::FormAnswerRow> rows) { stored = std::move(rows); }, [] {}},
      {}};
  CHECK_THROWS_AS(between.begin(true), runner::TookNoPart);
  CHECK(person.asked_ == std::vector<std::string>{"consent"});
  REQUIRE(stored.size() == 1);
  CHECK(stored[0].item == "agree");
  CHECK(stored[0].answer == "no");
  CHECK(runner::ending_answer(protocol, stored) == "no to 'agree' of form 'consent'");
}

TEST_CASE("a block is presented to those who answered so, now or in an earlier session",
          "[runner][session]") {
  const protocols::Protocol protocol = with_consent();
  const protocols::Schedule schedule = trials_of({"yes", "no", "all"});
  const auto presented = [&](runner::BetweenTrials& between) {
    std::vector<std::string> blocks;
    for (const protocols::PlannedTrial& trial : between.presented(schedule)) {
      blocks.push_back(trial.block);
    }
    return blocks;
  };
  runner::SessionStates states{1, [] { return 0.0; }};
  std::vector<results::FormAnswerRow> stored;
  const auto store = added_to(stored);
  Willing person{{{"agree", "yes"}, {"hand", "no"}}};
  runner::BetweenTrials now{{protocol, person, states, store, [] {}}, {}};
  now.begin(true);
  CHECK(presented(now) == std::vector<std::string>{"no", "all"});
  Willing again{{{"agree", "yes"}, {"hand", "yes"}}};
  runner::BetweenTrials later{{protocol, again, states, store, [] {}}, stored};
  later.begin(true);
  CHECK(again.asked_.empty());
  CHECK(presented(later) == std::vector<std::string>{"no", "all"});
}

TEST_CASE("what is presented rests on answers before the first trial, whatever is answered later",
          "[runner][session]") {
  protocols::Protocol protocol = with_consent();
  protocol.blocks[1].forms_after = {"consent"};
  const protocols::Schedule schedule = trials_of({"yes", "no", "all"});
  runner::SessionStates states{1, [] { return 0.0; }};
  std::vector<results::FormAnswerRow> stored;
  const auto store = added_to(stored);
  Willing person{{{"agree", "yes"}, {"hand", "no"}}};
  runner::BetweenTrials now{{protocol, person, states, store, [] {}}, {}};
  now.begin(true);
  const protocols::Schedule presented = now.presented(schedule);
  REQUIRE(presented.size() == 2);
  person.answers_["hand"] = "yes";
  now.before(presented[0], presented);
  now.before(presented[1], presented);
  CHECK(person.asked_ == std::vector<std::string>{"consent", "about", "consent"});
  const runner::BetweenTrials later{{protocol, person, states, store, [] {}}, stored};
  for (const runner::BetweenTrials* const session : {&std::as_const(now), &later}) {
    CHECK(session->presented(schedule).front().block == "no");
  }
}

using namespace tapstudy::runner;

TEST_CASE("a session's changes of state are kept in order with their times", "[runner][session]") {
  double now_s = 0.0;
  SessionStates states{7, [&] { return now_s; }};
  now_s = 1.5;
  states.enter(SessionState::ready, 3);
  now_s = 2.0;
  states.enter(SessionState::exploring, 3);
  const auto events = states.take_events();
  REQUIRE(events.size() == 3);
  CHECK(events[0].state == "begun");
  CHECK(events[1].state == "ready");
  CHECK(events[1].number == 3);
  CHECK(events[2].t_s == 2.0);
  CHECK(events[2].session_id == 7);
  CHECK(states.take_events().empty());
}

TEST_CASE("how long trials take does not depend on how long the operator paused",
          "[runner][session]") {
  double now_s = 0.0;
  SessionStates states{1, [&] { return now_s; }};
  states.enter(SessionState::ready, 1);
  now_s = 10.0;
  CHECK(states.unpaused_s() == 10.0);
  for (const double pause_s : {600.0, 60.0}) {
    const double before_s = states.unpaused_s();
    states.enter(SessionState::exploring, 1);
    states.enter(SessionState::paused);
    now_s += pause_s;
    CHECK(states.unpaused_s() == before_s);
    states.enter(SessionState::ready, 1);
    now_s += 5.0;
    CHECK(states.unpaused_s() == before_s + 5.0);
  }
  CHECK(states.now_s() == 680.0);
}

TEST_CASE("nothing is rendered before the participant is ready, nothing follows the end",
          "[runner][session]") {
  SessionStates states{1, [] { return 0.0; }};
  CHECK_THROWS_AS(states.enter(SessionState::exploring), std::logic_error);
  states.enter(SessionState::ended);
  CHECK_THROWS_AS(states.enter(SessionState::ready), std::logic_error);
}

TEST_CASE("an answer is asked for its confidence before it is saved, and told right after",
          "[runner][session]") {
  CHECK(may_follow(SessionState::confidence, SessionState::saved));
  CHECK_FALSE(may_follow(SessionState::saved, SessionState::confidence));
  CHECK(may_follow(SessionState::saved, SessionState::feedback));
  CHECK_FALSE(may_follow(SessionState::exploring, SessionState::feedback));
}

TEST_CASE("an answer may be changed until it is confirmed, and counts only once it is",
          "[runner][session]") {
  CHECK(may_follow(SessionState::exploring, SessionState::answering));
  CHECK(may_follow(SessionState::answering, SessionState::answering));
  CHECK(may_follow(SessionState::answering, SessionState::confirmed));
  CHECK(may_follow(SessionState::answering, SessionState::timed_out));
  CHECK_FALSE(may_follow(SessionState::exploring, SessionState::saved));
  CHECK_FALSE(may_follow(SessionState::answering, SessionState::saved));
  CHECK_FALSE(may_follow(SessionState::confirmed, SessionState::answering));
  CHECK_FALSE(may_follow(SessionState::confirmed, SessionState::timed_out));
}

namespace {
// Each period comes after its buffer has run empty.
class GappyCard final : public device::PcmSink {
 public:
  double rate_hz() const override { return 48'000.0; }
  std::size_t period_frames() const override { return 48; }
  std::size_t buffer_frames() const override { return 144; }
  void begin() noexcept override {}
  device::PcmOutcome write(std::span<const float> /*period*/) noexcept override {
    return device::PcmOutcome::underrun;
  }
  void end() noexcept override {}
  std::string failure() const override { return ""; }
};

// Explores for as long as the loop runs, and has no answer.
class Exploring final : public runner::Participant {
 public:
  std::optional<std::string> perform(const runner::TrialPrompt& /*prompt*/,
                                     runner::TrialControl& control) override {
    constexpr double longer_than_any_fault_takes_s = 10.0;
    control.pass_time(longer_than_any_fault_takes_s);
    return std::nullopt;
  }
};
}  // namespace

TEST_CASE("a card that goes on having gaps ends the trial, which is stored as interrupted",
          "[runner][session][threads][actuator]") {
  Study study{0};
  device::ActuatorPlayer player{
      std::make_unique<GappyCard>(),
      device::ActuatorPlayer::Settings{1.0, {}, 1e-3, 3, {0, false, std::nullopt}}};
  device::ReplayHand hand{{{{0.0, 0.1, 0.0}, core::Vec3::Zero()}}, "nowhere"};
  std::set<int> done;
  std::optional<runner::Interruption> interruption;
  {
    results::Recorder recorder{study.store};
    runner::LiveTrialLoop loop{hand,
                               runner::loop_settings(study.protocol, runner::simulated_rig()),
                               {0, false, std::nullopt},
                               recorder};
    loop.use(player);
    runner::SessionStates states{study.session.id, [] { return 0.0; }};
    runner::Operator nobody;
    testing::NoRealPlates no_plates;
    Exploring participant;
    runner::TrialEngine engine{
        {study.protocol, study.models, loop, no_plates, participant, nobody, states}, recorder};
    interruption = engine.run(study.schedule, done);
  }
  REQUIRE(interruption);
  CHECK(interruption->fault == core::TickFault::actuator_gaps);
  CHECK_THAT(runner::to_text(*interruption), Contains("actuator.max_gaps"));
  CHECK(done.empty());
  auto stored = study.store.query(
      "SELECT status, fault, value FROM trial JOIN tick_statistics USING (trial_id) "
      "JOIN event USING (trial_id) WHERE kind = 'actuator_underrun'");
  REQUIRE(stored.step());
  CHECK(stored.text(0) == "interrupted");
  CHECK(stored.text(1) == core::to_text(core::TickFault::actuator_gaps));
  CHECK(stored.real(2) >= 4.0);
}
