#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "runner/terminal/operator_dialogue.hpp"
#include "runner/terminal/process_exit.hpp"
#include "runner/terminal/session_lock.hpp"
#include "runner/terminal/terminal_output.hpp"
#include "runner/terminal/typed_input.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
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

using tapstudy::runner::marked_text;

TEST_CASE("A heading and bold words are shown at a terminal without their marks",
          "[runner][terminal]") {
  const std::string text =
      "# Welcome\nTap **once**, then **answer**.\n- a # b\n- 2 ** 3\n# Begin\n";
  CHECK(marked_text(text, false) == "Welcome\nTap once, then answer.\n- a # b\n- 2 ** 3\nBegin\n");
  CHECK(marked_text("# Welcome\nTap **once**.", true) ==
        "\033[1mWelcome\033[0m\nTap \033[1monce\033[0m.");
}

// What the operator is asked, and what counts as an answer.
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

using runner::SessionLock;

TEST_CASE("what one holds no other gets, until it is let go", "[runner][lock]") {
  auto first = std::make_unique<SessionLock>("study P01", "taken");
  CHECK_THROWS_WITH((SessionLock{"study P01", "taken"}), "taken");
  CHECK_NOTHROW(SessionLock{"study P02", "taken"});
  first.reset();
  CHECK_NOTHROW(SessionLock{"study P01", "taken"});
}

TEST_CASE("a process that was killed holds nothing", "[runner][lock]") {
  const pid_t other = fork();
  if (other == 0) {
    const SessionLock held{"study P03", "taken"};
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  REQUIRE(waitpid(other, &status, 0) == other);
  CHECK_NOTHROW(SessionLock{"study P03", "taken"});
}

TEST_CASE("a study has one lock a participant, with and without a slash behind its folder",
          "[runner][lock]") {
  const testing::TempDirectory directory;
  const runner::ParticipantLock held{directory / "out/", "P01"};  // which makes the folder
  CHECK(runner::is_in_session(directory / "out", "P01"));
  std::filesystem::create_directory(directory / "out");
  CHECK(runner::is_in_session(directory / "out", "P01"));
  CHECK(runner::is_in_session(directory / "out/", "P01"));
  CHECK_FALSE(runner::is_in_session(directory / "out", "P02"));
}
