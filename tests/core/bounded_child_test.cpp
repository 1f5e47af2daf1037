#include "core/bounded_child.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <vector>

#include "core/error.hpp"
#include "support/sanitized.hpp"
using namespace tapstudy;
using core::in_bounded_child;

TEST_CASE("a child's bytes arrive whole, and its errors as what they were", "[core][child]") {
  const std::string bytes(3'000'000, 'x');
  CHECK(in_bounded_child("work", [&] { return bytes; }) == bytes);
  CHECK_THROWS_AS(in_bounded_child("work", []() -> std::string { throw core::InvalidInput{"a"}; }),
                  core::InvalidInput);
  CHECK_THROWS_WITH(in_bounded_child("work", []() -> std::string { throw core::ModelError{"b"}; }),
                    "b");
}

TEST_CASE("whatever kills a child, it is one error here", "[core][child]") {
  const int signal = GENERATE(SIGSEGV, SIGABRT, SIGKILL, SIGFPE);
  CHECK_THROWS_AS(in_bounded_child("work",
                                   [&]() -> std::string {
                                     raise(signal);
                                     return "alive";
                                   }),
                  core::ModelError);
}

TEST_CASE("a child that never ends is ended", "[core][child]") {
  const bool is_busy = GENERATE(true, false);
  CHECK_THROWS_WITH(in_bounded_child("work",
                                     [&]() -> std::string {
                                       while (true) {
                                         if (!is_busy || getppid() == 0) {
                                           pause();
                                         }
                                       }
                                     },
                                     {1, 1'000'000'000}),
                    "work: it took too long, or too much memory");
}

#if !TAPSTUDY_SANITIZED  // whose allocator ends the process instead
TEST_CASE("a child that takes too much memory is refused it", "[core][child]") {
  CHECK_THROWS_WITH(
      in_bounded_child("work",
                       [] { return std::string(std::vector<char>(2'000'000'000, 'x').data(), 1); },
                       {5, 100'000'000}),
      "work: not enough memory");
}
#endif
