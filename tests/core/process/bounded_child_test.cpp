#include "core/process/bounded_child.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <thread>
#include <vector>

#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
using namespace tapstudy;
using core::ChildJob;
using core::in_bounded_child;
namespace {
const ChildJob echo{"test: echo", [](const std::string& input) { return input; }};
const ChildJob refuse{"test: refuse", [](const std::string& input) -> std::string {
                        if (input == "input") {
                          throw core::InvalidInput{"a"};
                        }
                        throw core::ModelError{"b"};
                      }};
const ChildJob die{"test: die", [](const std::string& input) {
                     raise(std::stoi(input));
                     return input;
                   }};
const ChildJob hang{"test: hang", [](const std::string& input) -> std::string {
                      while (true) {
                        if (input == "idle") {
                          pause();
                        }
                      }
                    }};
const ChildJob print{"test: print", [](const std::string&) {
                       std::puts("what a library says");
                       std::fflush(stdout);
                       return std::string{"result"};
                     }};
const ChildJob take{"test: take", [](const std::string&) {
                      return std::string(std::vector<char>(2'000'000'000, 'x').data(), 1);
                    }};
}  // namespace

TEST_CASE("bytes arrive whole in a child and back, and its errors as what they were",
          "[core][child]") {
  std::string bytes(3'000'000, 'x');
  bytes[1'000'000] = '\0';
  CHECK(in_bounded_child(echo, bytes, "work") == bytes);
  CHECK(in_bounded_child(echo, "", "work").empty());
  CHECK(in_bounded_child(print, "", "work") == "result");
  CHECK_THROWS_AS(in_bounded_child(refuse, "input", "work"), core::InvalidInput);
  CHECK_THROWS_WITH(in_bounded_child(refuse, "", "work"), "b");
}

TEST_CASE("whatever kills a child, it is one error here", "[core][child]") {
  const int signal = GENERATE(SIGSEGV, SIGABRT, SIGKILL, SIGFPE);
  CHECK_THROWS_AS(in_bounded_child(die, std::to_string(signal), "work"), core::ModelError);
}

TEST_CASE("a child that never ends is ended", "[core][child]") {
  const std::string how = GENERATE("busy", "idle");
  CHECK_THROWS_WITH(in_bounded_child(hang, how, "work", {1, 1'000'000'000}),
                    "work: it took too long, or too much memory");
}

TEST_CASE("children start while other threads allocate and start threads", "[core][child]") {
  std::atomic<bool> is_over{false};
  std::thread other{[&] {
    while (!is_over) {
      std::thread{[] { std::vector<int>(1000).clear(); }}.join();
    }
  }};
  for (int i = 0; i < 20; ++i) {
    CHECK(in_bounded_child(echo, "bytes", "work", {5, 1'000'000'000}) == "bytes");
  }
  is_over = true;
  other.join();
}

#if !TAPSTUDY_SANITIZED  // whose allocator ends the process instead
TEST_CASE("a child that takes too much memory is refused it", "[core][child]") {
  CHECK_THROWS_WITH(in_bounded_child(take, "", "work", {5, 100'000'000}),
                    "work: not enough memory");
}
#endif
