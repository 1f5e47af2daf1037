#include "runner/session/trial_engine.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "protocols/read_protocol.hpp"
#include "results/store.hpp"
#include "results/stored_answers.hpp"
#include "runner/session/session_row.hpp"
#include "support/catch.hpp"
#include "support/no_real_plates.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
// A loop whose first trials each have an impact just after a late tick, or stall when answered.
struct Troubles {
  int late_trials{0};
  int stalled_trials{0};
};
class TroubledTrialLoop final : public runner::TrialLoop {
 public:
  explicit TroubledTrialLoop(Troubles troubles) : troubles_{troubles} {}
  runner::TrialResult run(const runner::Rendered& /*rendered*/,
                          const runner::Explore& explore) override {
    struct Nothing final : runner::Exploration {
      bool is_stalled{};
      void switch_to(std::size_t /*alternative*/) override {}
      void pass_time(double /*seconds*/) override {}
      bool is_running() const override { return true; }
      bool is_rendering() const override { return !is_stalled; }
      double time_s() const override { return 1.0; }
      int contacts(std::size_t /*alternative*/) const override { return 1; }
    } exploration;
    exploration.is_stalled = troubles_.stalled_trials-- > 0;
    explore(exploration);
    runner::TrialResult result;
    result.trace.events = {{0.5, "impact", 0.3}};
    if (troubles_.late_trials-- > 0) {
      result.trace.events.push_back({0.5, "late_impact", 0.3});
    }
    return result;
  }

 private:
  Troubles troubles_;
};

class FirstOption final : public runner::Participant {
 public:
  std::optional<std::string> perform(const runner::TrialPrompt& prompt,
                                     runner::Exploration& /*exploration*/) override {
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
    TroubledTrialLoop loop{troubles};
    std::set<int> done;
    results::Recorder recorder{store};
    runner::SessionStates states{session.id, [] { return 0.0; }};
    runner::Operator nobody;
    testing::NoRealPlates no_plates;
    runner::TrialEngine engine{{protocol, models, loop, no_plates, participant, nobody, states},
                               recorder};
    CHECK_FALSE(engine.run(schedule, done));
    CHECK(done.size() == schedule.size());
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
      void switch_to(std::size_t /*alternative*/) override {}
      void pass_time(double seconds) override { now_s += seconds; }
      bool is_running() const override { return true; }
      double time_s() const override { return now_s; }
      int contacts(std::size_t alternative) const override {
        return std::max(0, static_cast<int>(touches_per_s * now_s) - static_cast<int>(alternative));
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
                                     runner::Exploration& exploration) override {
    if (!exploration.is_running()) {
      return std::nullopt;
    }
    exploration.pass_time(1.0);
    return exploration.is_running() ? std::optional{prompt.answers.options.front().name}
                                    : std::nullopt;
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

TEST_CASE("an answer given while nothing is rendered is no answer: the trial is presented again",
          "[runner][session][threads]") {
  Study study{0};
  study.run({.stalled_trials = 2});
  CHECK(study.participant.repeats_told == 2);
  CHECK(results::stored_answers(study.store).size() == study.schedule.size());
}
