#include "runner/session/session_states.hpp"

#include <stdexcept>

#include "support/catch.hpp"
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
