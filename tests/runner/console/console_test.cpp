#include <nlohmann/json.hpp>
#include <set>

#include "core/error.hpp"
#include "core/haptics/haptic_state.hpp"
#include "device/device.hpp"
#include "protocols/form.hpp"
#include "runner/console/console_server.hpp"
#include "runner/console/operator_view.hpp"
#include "runner/console/scenes.hpp"
#include "runner/console/screen.hpp"
#include "support/catch.hpp"
#include "support/study_files.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::runner;

namespace {
Screen trial_screen() {
  TrialPrompt prompt;
  prompt.answers.options = {{"mdf", "MDF"}, {"acrylic", "acrylic"}};
  return {.kind = ScreenKind::trial, .trial = TrialScreen{.prompt = prompt, .notice = {}}};
}
const ScreenInput first{ScreenAction::answer, 0, {}, "1"};
const ScreenInput second{ScreenAction::answer, 0, {}, "2"};
}  // namespace

TEST_CASE("an answer belongs to one screen, is taken once, and may be sent again",
          "[runner][console]") {
  ScreenExchange screens{"en", "a study"};
  const auto instructions = screens.show({.kind = ScreenKind::instructions, .text = "Tap."});
  const auto trial = screens.show(trial_screen());
  CHECK_FALSE(screens.post(instructions, {ScreenAction::go_on, 0}).empty());
  CHECK_FALSE(screens.take(trial));
  CHECK(screens.post(trial, second).empty());
  CHECK(screens.post(trial, second).empty());       // the network lost the reply
  CHECK_FALSE(screens.post(trial, first).empty());  // a second thought comes too late
  REQUIRE(screens.take(trial));
  CHECK_FALSE(screens.take(trial));
  CHECK(screens.post(trial, second).empty());
  CHECK_FALSE(screens.take(trial));
  const auto next = screens.show(trial_screen());
  CHECK_FALSE(screens.post(trial, second).empty());
  CHECK_FALSE(screens.take(next));
}

TEST_CASE("a closed screen hands over what it has accepted and accepts nothing more",
          "[runner][console]") {
  ScreenExchange screens{"en", "a study"};
  const auto answered = screens.show(trial_screen());
  CHECK(screens.post(answered, second).empty());
  CHECK(screens.close() == second);
  CHECK_FALSE(screens.close());
  CHECK(screens.post(answered, second).empty());  // said again by the network
  const auto unanswered = screens.show(trial_screen());
  CHECK_FALSE(screens.close());
  CHECK_FALSE(screens.post(unanswered, second).empty());
}

TEST_CASE("a page was last seen when it last said so, or before it was closed",
          "[runner][console]") {
  using std::chrono::seconds;
  ScreenExchange screens{"en", "a study"};
  const std::chrono::steady_clock::time_point begin{seconds{100}};
  screens.page_opened(begin);
  CHECK(screens.last_seen(begin + seconds{60}) == begin + seconds{60});  // it never says so
  screens.page_is_alive(begin);
  CHECK(screens.last_seen(begin + seconds{4}) == begin);
  screens.page_closed(begin + seconds{4});
  CHECK(screens.last_seen(begin + seconds{6}) == begin);
  screens.page_opened(begin + seconds{7});  // loaded anew
  CHECK(screens.last_seen(begin + seconds{8}) == begin + seconds{7});
}

TEST_CASE("a screen takes what can be done with it and nothing else", "[runner][console]") {
  const Screen trial = trial_screen();
  CHECK(accepts(trial, second));
  for (const char* const text : {"0", "3", "-1", "1.5", "mdf", ""}) {
    CHECK_FALSE(accepts(trial, {ScreenAction::answer, 0, {}, text}));
  }
  CHECK_FALSE(accepts(trial, {ScreenAction::switch_to, 0}));  // there is nothing to switch
  CHECK_FALSE(accepts(trial, {ScreenAction::go_on, 0}));
  const Screen sure{.kind = ScreenKind::confidence, .confidence = protocols::Confidence{}};
  CHECK_FALSE(accepts(sure, {ScreenAction::confidence, 0}));
  CHECK(accepts(sure, {ScreenAction::confidence, 5}));
  CHECK_FALSE(accepts(sure, {ScreenAction::confidence, 6}));
  for (const ScreenKind kind : {ScreenKind::wait, ScreenKind::paused, ScreenKind::ended}) {
    CHECK_FALSE(accepts({.kind = kind}, {ScreenAction::go_on, 0}));
  }
  CHECK_FALSE(accepts({.kind = ScreenKind::message, .message = Message::operator_is_needed},
                      {ScreenAction::go_on, 0}));
}

TEST_CASE("a setting is taken as one of those there are, and answered only as it is",
          "[runner][console]") {
  TrialPrompt prompt;
  prompt.alternative_labels = {"A", "B"};
  prompt.answers = {protocols::AnswerKind::setting};
  prompt.answers.settings = 5;
  const Screen trial{
      .kind = ScreenKind::trial,
      .trial = TrialScreen{.prompt = prompt, .current = 1, .setting = 3, .notice = {}}};
  CHECK(accepts(trial, {ScreenAction::adjust, 4}));
  CHECK_FALSE(accepts(trial, {ScreenAction::adjust, 5}));
  CHECK(accepts(trial, {ScreenAction::answer, 0, {}, "4"}));
  CHECK_FALSE(accepts(trial, {ScreenAction::answer, 0, {}, "3"}));
  CHECK_FALSE(accepts(trial_screen(), {ScreenAction::adjust, 0}));
}

TEST_CASE("a form is taken when all that it requires is answered, and nothing else is",
          "[runner][console][forms]") {
  const Screen form{.kind = ScreenKind::form, .form = protocols::nasa_tlx("en")};
  ScreenInput input{ScreenAction::form, 0, {}};
  for (const protocols::FormItem& item : form.form->items) {
    CHECK_FALSE(accepts(form, input));
    input.answers.emplace(item.name, "0.5");
  }
  CHECK(accepts(form, input));
  input.answers["effort"] = "1.5";
  CHECK_FALSE(accepts(form, input));
  input.answers["effort"] = "1";
  input.answers["another"] = "1";
  CHECK_FALSE(accepts(form, input));
}

TEST_CASE(
    "of a form the answer that ends the session is taken alone, and what is not asked is not taken",
    "[runner][console][forms]") {
  protocols::Form consent;
  consent.name = "consent";
  for (const char* const name : {"agree", "hurt", "where"}) {
    protocols::FormItem& item = consent.items.emplace_back();
    item.name = name;
    item.kind = protocols::ItemKind::single_choice;
    item.options = {{"yes", "Yes"}, {"no", "No"}};
  }
  consent.items[0].ends_session = {"no"};
  consent.items[2].asked_if = protocols::AnswerCondition{"consent", "hurt", {"yes"}};
  const Screen screen{.kind = ScreenKind::form, .form = consent};
  const auto takes = [&](const protocols::FormAnswers& answers) {
    return accepts(screen, {ScreenAction::form, 0, answers});
  };
  CHECK(takes({{"agree", "no"}}));
  CHECK_FALSE(takes({{"agree", "no"}, {"hurt", "no"}}));
  CHECK_FALSE(takes({{"agree", "yes"}}));
  CHECK(takes({{"agree", "yes"}, {"hurt", "no"}}));
  CHECK_FALSE(takes({{"agree", "yes"}, {"hurt", "no"}, {"where", "no"}}));
  CHECK_FALSE(takes({{"agree", "yes"}, {"hurt", "yes"}}));
  CHECK(takes({{"agree", "yes"}, {"hurt", "yes"}, {"where", "no"}}));
}

TEST_CASE("what is no input is refused, whatever it is", "[runner][console]") {
  std::int64_t screen = 0;
  CHECK(parse_input(R"({"screen":7,"action":"switch","value":1})", screen).value == 1);
  CHECK(parse_input(R"({"screen":7,"action":"answer","value":"12.5"})", screen).text == "12.5");
  CHECK(screen == 7);
  for (const char* const text :
       {"", "{", "[]", "null", R"({"screen":7})", R"({"screen":7,"action":"quit"})",
        R"({"screen":"7","action":"go_on"})", R"({"screen":7,"action":"answer"})",
        R"({"screen":7,"action":"switch","value":-1})",
        R"({"screen":7,"action":"switch","value":1.5})",
        R"({"screen":7,"action":"answer","value":1})",
        R"({"screen":7,"action":["answer"],"value":1})", R"({"screen":7,"action":"form"})",
        R"({"screen":7,"action":"form","value":{"a":null}})",
        R"({"screen":7,"action":"form","value":{"a":{"b":1}}})"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(parse_input(text, screen), core::InvalidInput);
  }
}

using runner::LiveView;

namespace {
// One tick of a millisecond: pressed into the plate with so much force.
core::TraceSample tick(std::int64_t number, double force_n, double height_m) {
  core::TraceSample sample{};
  sample.t_ns = number * 1'000'000;
  sample.position_m = {0.0, height_m, 0.0};
  sample.force_n = {0.0, force_n, 0.0};
  sample.touching = height_m < 0.0;
  return sample;
}
}  // namespace

TEST_CASE("a screen's step has the largest force and the lowest position of its ticks",
          "[runner][console]") {
  LiveView live;
  live.begin_trial();
  for (int i = 0; i < 25; ++i) {
    live.add(tick(i, i == 5 ? 3.0 : 1.0, i == 15 ? -0.002 : 0.01));
  }
  const LiveView::Steps steps = live.since(-1);
  REQUIRE(steps.steps.size() == 2);  // the third is not over
  CHECK(steps.steps[0].force_n == 3.0);
  CHECK(core::along_normal(steps.steps[0].lowest_m) == 0.01);
  CHECK(steps.steps[1].force_n == 1.0);
  CHECK(core::along_normal(steps.steps[1].lowest_m) == -0.002);
  CHECK(live.since(steps.end).steps.empty());
  CHECK(live.totals().contacts == 1);
  CHECK(live.totals().ticks == 25);
  live.begin_trial();
  CHECK(live.totals().contacts == 0);
}

TEST_CASE("a late tick is seen in the longest interval of its step, a pause between trials in none",
          "[runner][console]") {
  LiveView live;
  live.begin_trial();
  constexpr std::int64_t late_ns = 700'000;
  for (int i = 0; i < 25; ++i) {
    core::TraceSample sample = tick(i, 0.0, 0.01);
    sample.t_ns += i == 15 ? late_ns : 0;
    live.add(sample);
  }
  live.begin_trial();
  for (int i = 1000; i < 1025; ++i) {
    live.add(tick(i, 0.0, 0.01));
  }
  const auto steps = live.since(-1).steps;
  REQUIRE(steps.size() == 4);
  CHECK(steps[0].interval_s == Approx(0.001));
  CHECK(steps[1].interval_s == Approx(0.0017));
  CHECK(steps[2].interval_s == Approx(0.001));
}

TEST_CASE("a page that was away for long gets the latest steps, as many as are kept",
          "[runner][console]") {
  LiveView live;
  live.begin_trial();
  for (int i = 0; i < 100'000; ++i) {
    live.add(tick(i, i, 0.01));
  }
  const LiveView::Steps steps = live.since(3);
  CHECK(steps.steps.size() == 600);
  CHECK(steps.steps.back().force_n == 99'989.0);
}

TEST_CASE("a tick with a fault moves no pointer", "[runner][console]") {
  LiveView live;
  live.add(tick(0, 0.0, 0.01));
  core::TraceSample faulty = tick(1, 0.0, std::nan(""));
  faulty.fault = core::TickFault::device_gone;
  live.add(faulty);
  CHECK(live.pointer().position_m.y() == 0.01);
}

namespace {
runner::DeskView desk_with(const protocols::Block& block) {
  runner::DeskView desk;
  runner::TrialInView view;
  view.trial.number = 3;
  view.trial.block = block.name;
  view.trial.alternatives = {{"mdf_two"}, {"acrylic_two"}};
  view.prompt.number = 3;
  view.prompt.total = 8;
  view.prompt.block = &block;
  view.prompt.alternative_labels = {"A", "B"};
  view.attempt = 2;
  desk.trial = view;
  desk.current = 1;
  desk.last_answer = runner::AnswerInView{view.trial, {}, "mdf_two"};
  desk.last_answer->trial.number = 2;
  desk.force = runner::ForceState::on;
  return desk;
}

runner::SessionInView session_in_view(bool is_blind) {
  runner::SessionInView session;
  session.participant_id = "P01";
  session.mode = "pilot";
  session.device = "simulated hand";
  session.is_blind = is_blind;
  session.state = "exploring";
  session.has_participant_page = true;
  session.masking = runner::MaskingInView{true, -20.0, 3};
  return session;
}

std::string status(bool is_blind, runner::ForceState force = runner::ForceState::on) {
  protocols::Block block;
  block.name = "control";
  auto desk = desk_with(block);
  desk.force = force;
  return runner::status_text(session_in_view(is_blind), desk, {12345, 2, 4});
}
}  // namespace

TEST_CASE("the operator's terminal says what the operator's page shows", "[runner][console]") {
  const std::string text = status(false);
  for (const char* part : {"P01 (pilot), exploring", "trial 3 of 8, 'control', attempt 2",
                           "A mdf_two; B acrylic_two (felt)", "last answer: trial 2, mdf_two",
                           "contacts: 4", "late ticks: 2 of 12345", "simulated hand: force on",
                           "masking noise: playing, -20.0 dB FS, 3 underruns"}) {
    CHECK_THAT(text, Contains(part));
  }
}

TEST_CASE("a force that nobody confirmed to be off is never called off", "[runner][console]") {
  const std::string text = status(false, runner::ForceState::unknown);
  CHECK_THAT(text, Contains(device::force_may_be_on) && !Contains("force off"));
}

TEST_CASE("what a device says to the operator is at the page and at the terminal",
          "[runner][console]") {
  const runner::SessionInView session = session_in_view(false);
  runner::DeskView desk;
  CHECK_THAT(runner::state_json(session, desk, {}), Contains(R"("warnings":[])"));
  desk.device_says = "the motors are hot";
  CHECK_THAT(runner::status_text(session, desk, {}),
             Contains("The device says: the motors are hot"));
  CHECK_THAT(runner::state_json(session, desk, {}),
             Contains(R"("warnings":["The device says: the motors are hot"])"));
}

TEST_CASE("who is waited for is told to go on by resume", "[runner][console]") {
  runner::DeskView desk;
  desk.held_by = "Mount the real plate 'mdf'.";
  const runner::SessionInView session = session_in_view(false);
  CHECK_THAT(
      runner::state_json(session, desk, {}),
      Contains(R"("waits_for":"Mount the real plate 'mdf'.")") && Contains(R"("warnings":[])"));
  CHECK_THAT(runner::status_text(session, desk, {}),
             Contains("Mount the real plate 'mdf'. (then: resume)"));
}

TEST_CASE("a blind operator's terminal names no stimulus", "[runner][console]") {
  CHECK_THAT(status(true), Contains("presented: A; B (felt)"));
  CHECK_THAT(status(true), !Contains("mdf") && !Contains("acrylic"));
}

TEST_CASE("a live line has the extremes of its steps in newtons, millimetres and milliseconds",
          "[runner][console]") {
  runner::LiveView::Steps steps;
  for (int i = 0; i < 100; ++i) {
    core::Vec3 lowest_m = core::Vec3::Zero();
    lowest_m[core::normal_axis] = i == 99 ? 0.099 : 0.101;
    steps.steps.push_back({i == 50 ? 3.0 : 1.0, lowest_m, i == 7 ? 0.004 : 0.001});
  }
  const std::string line = runner::live_line(steps, {0, 1, 2}, 0.1);
  CHECK_THAT(line, Contains("▁▁▁▁▁▁▁▁▁▁▁▁█▁▁▁▁▁▁▁▁▁▁▁▁ up to 3.00 N"));
  CHECK_THAT(line, Contains("-1.0 to 1.0 mm, contacts 2, late 1, longest interval 4.0 ms"));
  CHECK_THAT(runner::live_line({}, {}, 0.0), Contains("at rest"));
}

// The catalogue of what the pages say.
using Json = nlohmann::json;

TEST_CASE("every language of the pages has the same messages, each once", "[runner][console]") {
  std::vector<std::set<std::string>> open_maps;
  const auto note = [&](int /*depth*/, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start) {
      open_maps.emplace_back();
    } else if (event == Json::parse_event_t::object_end) {
      open_maps.pop_back();
    } else if (event == Json::parse_event_t::key) {
      CAPTURE(parsed.dump());
      CHECK(open_maps.back().insert(parsed.get<std::string>()).second);
    }
    return true;
  };
  const Json catalogue =
      Json::parse(testing::contents(testing::source("runner/console/pages/messages.json")), note);
  REQUIRE(catalogue.size() == 3);
  for (const Json& language : catalogue) {
    REQUIRE(language.size() == catalogue.front().size());
    for (const auto& [key, text] : language.items()) {
      CAPTURE(key);
      CHECK(catalogue.front().contains(key));
    }
  }
}

using namespace std::chrono_literals;

TEST_CASE("a burst passes without delay, and what follows it at the rate", "[runner][console]") {
  RateLimit limit{10.0, 5.0};
  const RateLimit::Time begin{1h};
  for (int i = 0; i < 5; ++i) {
    CHECK(limit.delay_of(1.0, begin) == 0s);
  }
  CHECK(limit.delay_of(1.0, begin) == 100ms);
  CHECK(limit.delay_of(2.0, begin) == 300ms);
  CHECK(limit.delay_of(1.0, begin + 1s) == 0s);
}

TEST_CASE(
    "who asks no faster than the rate never waits, and idleness saves up no more than a burst",
    "[runner][console]") {
  RateLimit limit{10.0, 5.0};
  RateLimit::Time now{1h};
  for (int i = 0; i < 100; ++i, now += 100ms) {
    CHECK(limit.delay_of(1.0, now) == 0s);
  }
  now += 1h;
  CHECK(limit.delay_of(5.0, now) == 0s);
  CHECK(limit.delay_of(1.0, now) == 100ms);
}

TEST_CASE("one who asks too much delays nobody else, and strangers fill no memory",
          "[runner][console]") {
  ClientLimits limits;
  const RateLimit::Time now{1h};
  for (int i = 0; i < 200; ++i) {
    limits.of("participant 127.0.0.1").requests.delay_of(1.0, now);
  }
  CHECK(limits.of("participant 127.0.0.1").requests.delay_of(1.0, now) > 0s);
  CHECK(limits.of("operator 127.0.0.1").requests.delay_of(1.0, now) == 0s);
  for (std::size_t i = 0; i < ClientLimits::max_clients; ++i) {
    limits.of(std::to_string(i));
  }
  CHECK(&limits.of("one more") == &limits.of("another"));
  CHECK(&limits.of("operator 127.0.0.1") != &limits.of("another"));
}

// Which plate a participant's page draws: never one that tells the answer, or that is not felt.
TEST_CASE("a plate is drawn unless its size varies, for the picture would be of another one",
          "[runner][console]") {
  const auto is_drawn = [](const std::string& axis) {
    const protocols::Protocol protocol = testing::varied_study({axis});
    protocols::Block block;
    block.stimuli = {"a"};
    return runner::Scenes{protocol, protocol.placement}.number_of("a", block).has_value();
  };
  CHECK(is_drawn("youngs_modulus_pa: {from: 1e9, to: 5e9}"));
  CHECK(is_drawn("poissons_ratio: {values: [0.2, 0.3]}"));
  CHECK_FALSE(is_drawn("thickness_m: {values: [0.02, 0.03]}"));
  CHECK_FALSE(is_drawn("lateral_size_m: {values: [0.6, 0.7]}"));
}
