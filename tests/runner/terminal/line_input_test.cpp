#include "runner/terminal/line_input.hpp"

#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include <array>
#include <string>
#include <vector>

#include "runner/terminal/no_flow_control.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
namespace {
struct Terminal {
  int keyboard{};
  int program{};
  Terminal() { REQUIRE(openpty(&keyboard, &program, nullptr, nullptr, nullptr) == 0); }
  ~Terminal() {
    close(keyboard);
    close(program);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  Terminal(Terminal&&) = delete;
  Terminal& operator=(Terminal&&) = delete;
};

void type(int descriptor, const std::string& text) {
  REQUIRE(write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
}

// The next line, if one comes within a few glances.
std::string line_of(runner::LineInput& input) {
  int glances = 5;
  return input.next([&] { return glances-- > 0; }).value_or("nothing");
}
}  // namespace

TEST_CASE("what was typed at a terminal before the question does not answer it",
          "[runner][terminal]") {
  const Terminal terminal;
  runner::LineInput input{terminal.program};
  type(terminal.keyboard, "1\n2\n3\n");
  REQUIRE(line_of(input) == "1");
  CHECK_FALSE(input.forget_typed_ahead().has_quit);
  CHECK(line_of(input) == "nothing");
  type(terminal.keyboard, "4\n");
  CHECK(line_of(input) == "4");
}

TEST_CASE(
    "the last line of a script need not end; what a person had only begun to type is no answer",
    "[runner][terminal]") {
  std::array<int, 2> pipe_ends{};
  REQUIRE(pipe(pipe_ends.data()) == 0);
  runner::LineInput script{pipe_ends[0]};
  type(pipe_ends[1], "1\n2");
  close(pipe_ends[1]);
  CHECK(line_of(script) == "1");
  CHECK(line_of(script) == "2");
  CHECK(line_of(script) == "nothing");
  close(pipe_ends[0]);

  int keyboard{};
  int program{};
  REQUIRE(openpty(&keyboard, &program, nullptr, nullptr, nullptr) == 0);
  runner::LineInput person{program};
  type(keyboard, "1");
  close(keyboard);
  CHECK(line_of(person) == "nothing");
  close(program);
}

TEST_CASE("quit typed ahead is heeded, whatever else was", "[runner][terminal]") {
  const Terminal terminal;
  runner::LineInput input{terminal.program};
  type(terminal.keyboard, "1\n Quit \n3");
  CHECK(input.forget_typed_ahead().has_quit);
  CHECK_FALSE(input.forget_typed_ahead().has_quit);
}

TEST_CASE("the operator's lines are not dropped with what was typed ahead", "[runner][terminal]") {
  const Terminal terminal;
  runner::LineInput input{terminal.program};
  type(terminal.keyboard, "1\n:pause\n2\n:note she coughed\n");
  CHECK(input.forget_typed_ahead().of_operator ==
        std::vector<std::string>{":pause", ":note she coughed"});
  CHECK(line_of(input) == "nothing");
}

TEST_CASE("half a line of the operator's is kept until its end comes, half an answer is not",
          "[runner][terminal]") {
  const Terminal terminal;
  runner::LineInput input{terminal.program};
  type(terminal.keyboard, ":correct @1 ");
  CHECK(input.forget_typed_ahead().of_operator.empty());
  type(terminal.keyboard, "2\n");
  CHECK(line_of(input) == ":correct @1 2");
  type(terminal.keyboard, "1");
  CHECK(input.forget_typed_ahead().of_operator.empty());
  type(terminal.keyboard, "\n");
  CHECK(line_of(input).empty());
}

TEST_CASE("a line that is too long is no answer, nor is its tail", "[runner][terminal]") {
  std::array<int, 2> ends{};
  REQUIRE(pipe(ends.data()) == 0);
  runner::LineInput input{ends[0]};
  std::string text(9000, 'x');
  text += "\n2\n";
  type(ends[1], text);
  close(ends[1]);
  const auto next = [&] { return input.next([] { return true; }).value_or("nothing"); };
  CHECK_THAT(next(), Contains("too long"));
  CHECK(next() == "2");
  close(ends[0]);
}

TEST_CASE("what a file holds is not typed ahead", "[runner][terminal]") {
  std::array<int, 2> ends{};
  REQUIRE(pipe(ends.data()) == 0);
  runner::LineInput input{ends[0]};
  type(ends[1], "1\n2\n");
  close(ends[1]);
  CHECK(line_of(input) == "1");
  CHECK_FALSE(input.forget_typed_ahead().has_quit);
  CHECK(line_of(input) == "2");
  CHECK(line_of(input) == "nothing");
  close(ends[0]);
}

TEST_CASE("Ctrl-S at the terminal does not stop the program's output", "[runner][terminal]") {
  const Terminal terminal;
  const auto is_output_taken = [&] {
    type(terminal.keyboard, "\x13");
    pollfd writable{terminal.program, POLLOUT, 0};
    const bool is_taken = poll(&writable, 1, 0) == 1 && (writable.revents & POLLOUT) != 0;
    type(terminal.keyboard, "\x11");
    return is_taken;
  };
  {
    const runner::NoFlowControl during_a_session{terminal.program};
    CHECK(is_output_taken());
  }
  CHECK_FALSE(is_output_taken());
}
