// What the operator is asked, and what counts as an answer.
#include "runner/terminal/operator_prompt.hpp"

#include <unistd.h>

#include <array>
#include <string>

#include "runner/terminal/exit_code.hpp"
#include "runner/terminal/operator_at_terminal.hpp"
#include "support/catch.hpp"
using namespace tapstudy;

namespace {
// Somebody who has typed all this, and then left.
class Typed {
 public:
  explicit Typed(const std::string& text) {
    std::array<int, 2> ends{};
    REQUIRE(pipe(ends.data()) == 0);
    REQUIRE(write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size()));
    close(ends[1]);
    end_ = ends[0];
  }
  ~Typed() { close(end_); }
  Typed(const Typed&) = delete;
  Typed& operator=(const Typed&) = delete;
  Typed(Typed&&) = delete;
  Typed& operator=(Typed&&) = delete;
  int end() const { return end_; }

 private:
  int end_{-1};
};
bool is_done(const std::string& typed, const std::string& word = "") {
  const Typed operator_typed{typed};
  runner::LineInput input{operator_typed.end()};
  runner::TypedCommands commands;
  return runner::asked_and_done(input, commands, "Do it and", word);
}
double measured(const std::string& typed) {
  const Typed operator_typed{typed};
  runner::LineInput input{operator_typed.end()};
  runner::OperatorAtTerminal person{input};
  return person.how_much("How long is it", 0.5, [] {});
}
}  // namespace

TEST_CASE("Enter alone says that it is done; quit and the end of the input that it is not",
          "[runner][terminal]") {
  CHECK(is_done("\n"));
  CHECK(is_done("what?\n\n"));  // asked again
  CHECK_FALSE(is_done("quit\n\n"));
  CHECK_FALSE(is_done("what?\nquit\n\n"));
  CHECK_FALSE(is_done(""));
}

TEST_CASE("where a word is asked for, Enter alone does not say that it is done",
          "[runner][terminal]") {
  CHECK(is_done("mounted\n", "mounted"));
  CHECK(is_done("\n\nmounted\n", "mounted"));
  CHECK_FALSE(is_done("\n\n", "mounted"));
  CHECK_FALSE(is_done("quit\nmounted\n", "mounted"));
}

TEST_CASE("the operator's commands are obeyed at a prompt, and what could not be stored is said",
          "[runner][terminal]") {
  const Typed typed{":note a scratch\n:note nonsense\nmounted\n"};
  runner::LineInput input{typed.end()};
  std::vector<std::string> given;
  runner::TypedCommands commands{[&](const std::string& command) {
    given.push_back(command);
    std::promise<void> stored;
    stored.set_value();
    return runner::PostedCommand{command, stored.get_future().share()};
  }};
  CHECK(runner::asked_and_done(input, commands, "Mount it and", "mounted"));
  CHECK(given == std::vector<std::string>{"note a scratch", "note nonsense"});
}

TEST_CASE("a measurement is a number in its range, asked for until it is one",
          "[runner][terminal]") {
  CHECK(measured("0.1\n") == 0.1);
  CHECK(measured("ten\n-1\n0\n0.6\nnan\n0.1 m\n0.25\n") == 0.25);
  CHECK_THROWS_AS(measured("quit\n0.1\n"), runner::Stopped);
  CHECK_THROWS_AS(measured("ten\n"), runner::Stopped);
}
