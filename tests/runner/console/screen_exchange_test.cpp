#include "runner/console/screen_exchange.hpp"

#include "core/error.hpp"
#include "protocols/nasa_tlx.hpp"
#include "support/catch.hpp"
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
