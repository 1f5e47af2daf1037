#include "runner/only_one.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <memory>

#include "core/error.hpp"
using namespace tapstudy;
using runner::OnlyOne;

TEST_CASE("what one holds no other gets, until it is let go", "[runner][only_one]") {
  auto first = std::make_unique<OnlyOne>("study P01", "taken");
  CHECK_THROWS_WITH((OnlyOne{"study P01", "taken"}), "taken");
  CHECK_NOTHROW(OnlyOne{"study P02", "taken"});
  first.reset();
  CHECK_NOTHROW(OnlyOne{"study P01", "taken"});
}

TEST_CASE("a process that was killed holds nothing", "[runner][only_one]") {
  const pid_t other = fork();
  if (other == 0) {
    const OnlyOne held{"study P03", "taken"};
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  REQUIRE(waitpid(other, &status, 0) == other);
  CHECK_NOTHROW(OnlyOne{"study P03", "taken"});
}
