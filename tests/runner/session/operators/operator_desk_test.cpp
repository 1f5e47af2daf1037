#include "runner/session/operators/operator_desk.hpp"

#include <fmt/format.h>

#include <chrono>
#include <future>

#include "core/error.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "results/store/recorder.hpp"
#include "results/store/study_queries.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/session/engine/trial_engine.hpp"
#include "support/catch.hpp"
#include "support/no_real_plates.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::runner;

TEST_CASE("an operator's command is a word and what belongs to it", "[runner][operator]") {
  CHECK(parse_operator_command("  note  she coughed \n").text == "she coughed");
  CHECK(parse_operator_command("switch 2").action == OperatorAction::switch_to);
  CHECK(parse_operator_command("pause").text.empty());
  for (const char* const wrong : {"", "nothing", "note", "end  ", "resume now", "Pause"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(parse_operator_command(wrong), core::InvalidInput);
  }
  CHECK_THROWS_AS(parse_operator_command("note " + std::string(3000, 'x')), core::InvalidInput);
  CHECK(parse_operator_command("skip @4 the string broke").trial == 4);
  CHECK(parse_operator_command("skip @4 the string broke").text == "the string broke");
  CHECK(parse_operator_command("note @home").text == "@home");
}

namespace {
// Alternatives are felt for ever; the operator acts while they are.
class Endless final : public TrialLoop {
 public:
  class Feeling final : public Exploration {
   public:
    void request_position(std::size_t position) override { position_ = position; }
    void request_silence(bool /*is_silent*/) override {}
    bool is_as_requested() const override { return true; }
    std::size_t position() const { return position_; }
    void pass_time(double /*seconds*/) override {}
    bool is_running() const override { return true; }
    bool is_rendering() const override { return true; }
    double time_s() const override { return 1.0; }
    int contacts(std::size_t /*position*/) const override { return 5; }

   private:
    std::size_t position_{0};
  };
  TrialResult run(const Rendered& /*rendered*/, const Explore& explore) override {
    Feeling feeling;
    explore(feeling);
    felt_last = feeling.position();
    return {};
  }
  std::size_t felt_last{0};
};

// Does one thing in each presentation: an operator's command, or an answer where it is empty.
class Scripted final : public Participant {
 public:
  explicit Scripted(std::vector<std::string> commands) : commands_{std::move(commands)} {}
  OperatorDesk* desk{nullptr};
  std::optional<std::string> perform(const TrialPrompt& prompt, TrialControl& control) override {
    const std::string command = next_ < commands_.size() ? commands_[next_] : "";
    ++next_;
    try {
      if (!command.empty()) {
        desk->post(parse_operator_command(command)).stored.get();
      }
    } catch (const core::InvalidInput& error) {
      refusals.emplace_back(error.what());
    }
    return control.poll() ? std::optional{prompt.answers.options.front().name} : std::nullopt;
  }
  void wait_while(const std::function<bool()>& is_paused) override {
    ++pauses;
    CHECK(is_paused());
    desk->post({OperatorAction::resume}).stored.get();
    CHECK_FALSE(is_paused());
  }
  int pauses{0};
  std::vector<std::string> refusals;

 private:
  std::vector<std::string> commands_;
  std::size_t next_{0};
};

struct Attended {
  explicit Attended(std::vector<std::string> commands) : participant{std::move(commands)} {
    session.participant_id = "P01";
    store.add_session(session);
    results::Recorder recorder{store};
    const auto now_s = [] { return 2.5; };
    SessionStates states{session.id, now_s};
    OperatorDesk desk{{protocol, session.id, false, now_s}, recorder};
    participant.desk = &desk;
    testing::NoRealPlates no_plates;
    TrialEngine engine{{protocol, models, loop, no_plates, participant, desk, states}, recorder};
    CHECK_FALSE(engine.run(schedule, done));
    if (after) {
      after(desk);
    }
  }
  std::vector<std::string> texts(const std::string& query) {
    results::Database database{directory / "out/study.db", results::Database::Access::read};
    results::Statement row{database, query};
    std::vector<std::string> found;
    while (row.step()) {
      found.push_back(row.text(0));
    }
    return found;
  }
  testing::TempDirectory directory;
  protocols::Protocol protocol{protocols::parse_protocol(
      testing::contents(testing::shipped("paper/reality_finger.yaml")), "study.yaml")};
  results::Store store{
      results::Store::open_or_create(directory / "out", study_row(protocol, "study.yaml"))};
  results::SessionRow session;
  protocols::Schedule schedule{protocols::make_schedule(protocol, 1, 0)};
  ModelLibrary models;
  Endless loop;
  Scripted participant;
  std::set<int> done;
  std::function<void(OperatorDesk&)> after;
};
using Texts = std::vector<std::string>;
}  // namespace

TEST_CASE("a paused or repeated trial is stored and presented again, a skipped one is not",
          "[runner][operator][threads]") {
  Attended paused{{"pause the phone rang"}};
  CHECK(paused.participant.pauses == 1);
  CHECK(paused.texts("SELECT status FROM trial WHERE number = 1 ORDER BY attempt") ==
        Texts{"interrupted", "answered"});
  CHECK(paused.texts("SELECT state FROM session_event WHERE number = 1") ==
        Texts{"ready", "exploring", "paused", "ready", "exploring", "confirmed", "saved"});
  CHECK(paused.texts("SELECT action || ' ' || detail FROM operator_action") ==
        Texts{"pause the phone rang", "resume "});

  Attended repeated{{"repeat"}};
  CHECK(repeated.texts("SELECT status FROM trial WHERE number = 1 ORDER BY attempt") ==
        Texts{"repeated", "answered"});

  Attended skipped{{"skip the string broke"}};
  CHECK(skipped.texts("SELECT status FROM trial WHERE number = 1") == Texts{"skipped"});
  CHECK(skipped.done.size() == skipped.schedule.size());
  CHECK(results::stored_answers(skipped.store).size() == skipped.schedule.size() - 1);
}

TEST_CASE("the operator switches what is rendered; each action is a row with trial and time",
          "[runner][operator]") {
  Attended attended{{"switch 2"}};
  CHECK(attended.texts("SELECT action || detail || number || ' ' || t_s FROM operator_action") ==
        Texts{"switch21 2.5"});
}

TEST_CASE("a command that means a trial that is over is refused", "[runner][operator]") {
  Attended stale{{"skip @2"}};
  CHECK(stale.participant.refusals == Texts{"trial 2 is over"});
  CHECK(stale.texts("SELECT status FROM trial WHERE number = 1") == Texts{"answered"});
  Attended meant{{"skip @1"}};
  CHECK(meant.texts("SELECT status FROM trial WHERE number = 1") == Texts{"skipped"});
}

TEST_CASE("what cannot be done now is refused and not stored", "[runner][operator]") {
  const testing::TempDirectory directory;
  const auto protocol = protocols::parse_protocol(
      testing::contents(testing::shipped("paper/reality_finger.yaml")), "study.yaml");
  results::Store store =
      results::Store::open_or_create(directory / "out", study_row(protocol, "study.yaml"));
  results::SessionRow session;
  session.participant_id = "P01";
  store.add_session(session);
  {
    results::Recorder recorder{store};
    OperatorDesk desk{{protocol, session.id, false, [] { return 0.0; }}, recorder};
    for (const char* const command :
         {"resume", "repeat", "skip", "switch 1", "correct 1", "include"}) {
      CAPTURE(command);
      CHECK_THROWS_AS(desk.post(parse_operator_command(command)), core::InvalidInput);
    }
    desk.post({OperatorAction::note, "quiet"}).stored.get();
    CHECK(desk.view().log.size() == 1);
    CHECK(desk.view().log.front().is_stored);
  }
  CHECK(store.entries_for_journal().actions.size() == 1);
}

TEST_CASE("an answer that waits for its confidence is not mistaken for the one before",
          "[runner][operator]") {
  std::string refused;
  Attended study{{}};
  results::Recorder recorder{study.store};
  OperatorDesk desk{{study.protocol, study.session.id, false, [] { return 3.0; }}, recorder};
  const protocols::PlannedTrial& trial = study.schedule.front();
  desk.answer_is_stored({trial,
                         trial.task->answers(study.protocol.block(trial.block), study.protocol),
                         trial.alternatives.front().stimulus});
  desk.answer_is_given(trial.number + 1);
  try {
    desk.post(parse_operator_command("correct 1"));
  } catch (const core::InvalidInput& error) {
    refused = error.what();
  }
  CHECK_THAT(refused, Contains("once its confidence is given"));
  CHECK_NOTHROW(desk.post(parse_operator_command(fmt::format("correct @{} 1", trial.number))));
}

// Its teller holds the recorder, for which a command waits that is being stored.
TEST_CASE("what a device says waits for no command", "[runner][operator][threads]") {
  Attended study{{}};
  results::Recorder recorder{study.store};
  OperatorDesk* told = nullptr;
  std::future<void> saying;
  bool is_said = false;
  const auto now_s = [&] {  // asked by a command on its way
    saying = std::async(std::launch::async, [&] { told->device_says("warm"); });
    is_said = saying.wait_for(std::chrono::seconds{10}) == std::future_status::ready;
    return 3.0;
  };
  OperatorDesk desk{{study.protocol, study.session.id, false, now_s}, recorder};
  told = &desk;
  desk.post({OperatorAction::note, "is it hot?"}).stored.get();
  CHECK(is_said);
  CHECK(desk.view().device_says == "warm");
}
