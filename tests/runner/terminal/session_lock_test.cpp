#include "runner/terminal/session_lock.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <memory>

#include "core/error.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
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
