#include "runner/terminal/line_input.hpp"

#include <pty.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <string>

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
  input.forget_typed_ahead();
  CHECK(line_of(input) == "nothing");
  type(terminal.keyboard, "4\n");
  CHECK(line_of(input) == "4");
}

TEST_CASE("what a file holds is not typed ahead", "[runner][terminal]") {
  std::array<int, 2> ends{};
  REQUIRE(pipe(ends.data()) == 0);
  runner::LineInput input{ends[0]};
  type(ends[1], "1\n2\n");
  close(ends[1]);
  CHECK(line_of(input) == "1");
  input.forget_typed_ahead();
  CHECK(line_of(input) == "2");
  CHECK(line_of(input) == "nothing");
  close(ends[0]);
}
