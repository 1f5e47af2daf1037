#include "support/processes.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cstdlib>

#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"

extern char** environ;
namespace tapstudy::testing {
ProgramResult run_program(const std::vector<std::string>& arguments, const std::string& input) {
  const TempDirectory directory;
  write(directory / "in", input);
  posix_spawn_file_actions_t actions{};
  posix_spawn_file_actions_init(&actions);
  const std::string in = directory / "in";
  const std::string out = directory / "out";
  const std::string err = directory / "err";
  posix_spawn_file_actions_addopen(&actions, 0, in.c_str(), O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT, 0600);
  std::vector<std::string> copies = arguments;
  std::vector<char*> words;
  for (std::string& copy : copies) {
    words.push_back(copy.data());
  }
  words.push_back(nullptr);
  pid_t child{};
  REQUIRE(posix_spawn(&child, words.front(), &actions, nullptr, words.data(), environ) == 0);
  posix_spawn_file_actions_destroy(&actions);
  int status{};
  REQUIRE(waitpid(child, &status, 0) == child);
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {code, contents(out), contents(err)};
}

ProgramResult tapstudy(std::vector<std::string> arguments, const std::string& input) {
  arguments.insert(arguments.begin(), tapstudy_program());
  return run_program(arguments, input);
}

ProgramResult run_script(const std::string& script, std::vector<std::string> arguments) {
  setenv("TAPSTUDY_PROGRAM", tapstudy_program().c_str(), 1);
  arguments.insert(arguments.begin(), {"/usr/bin/python3", "-B", source("tests/" + script)});
  return run_program(arguments);
}
}  // namespace tapstudy::testing
