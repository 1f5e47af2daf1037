// What is installed beside the program: its manual page, its completions, its protocols.
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>

#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
namespace fs = std::filesystem;
using Names = std::set<std::string>;

namespace {
Names all_matches(const std::string& text, const std::regex& pattern) {
  Names found;
  for (std::sregex_iterator at{text.begin(), text.end(), pattern}; at != std::sregex_iterator{};
       ++at) {
    found.insert(at->str(1));
  }
  return found;
}

Names options_in_help(const std::string& command) {
  return all_matches(testing::tapstudy({command, "--help"}).standard_output,
                     std::regex{R"re((?:\n  |,)(--[a-z-]+))re"});
}

Names completed_by_bash(const std::string& script, const std::string& words) {
  const auto run = testing::run_program({"/bin/bash", "-c",
                                         ". " + script + "; COMP_WORDS=(tapstudy " + words +
                                             "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _tapstudy; "
                                             "printf '%s\\n' \"${COMPREPLY[@]}\""});
  std::istringstream lines{run.standard_output};
  Names found;
  for (std::string line; std::getline(lines, line);) {
    found.insert(line);
  }
  return found;
}

// Between the heading of the command and the next one.
std::string part_of(const std::string& text, const std::string& heading, const std::string& next) {
  const auto begin = text.find(heading);
  REQUIRE(begin != std::string::npos);
  return text.substr(begin, text.find(next, begin + heading.size()) - begin);
}
}  // namespace

TEST_CASE("the manual page and both completions name every option that a command's help names",
          "[end_to_end][install]") {
  const testing::TempDirectory directory;
  REQUIRE(testing::tapstudy({"--documents", directory / "."}).exit_code == 0);
  const std::string page =
      std::regex_replace(testing::contents(directory / "tapstudy.1"), std::regex{R"(\\-)"}, "-");
  const std::string zsh = testing::contents(directory / "_tapstudy");
  const std::string bash = directory / "tapstudy.bash";
  const Names commands = completed_by_bash(bash, "''");
  Names in_help = all_matches(testing::tapstudy({"--help"}).standard_output,
                              std::regex{R"re(\n  ([a-z][a-z-]+) )re"});
  in_help.insert({"--help", "--version"});
  CHECK(commands == in_help);
  for (const std::string& command : commands) {
    if (command.starts_with('-')) {
      continue;
    }
    CAPTURE(command);
    const Names options = options_in_help(command);
    CHECK(options.contains("--help"));
    CHECK(completed_by_bash(bash, command + " --") == options);
    const std::string in_page = part_of(page, ".SS tapstudy " + command, ".SS");
    CHECK(all_matches(in_page, std::regex{R"re(\n\\fB(?:-h, )?(--[a-z-]+)\\fR)re"}) == options);
    const std::string in_zsh = part_of(zsh, "    " + command + ")\n", ";;");
    CHECK(all_matches(in_zsh, std::regex{R"re('\*?(--[a-z-]+)\[)re"}) == options);
  }
  CHECK(completed_by_bash(bash, "export --format ''") == Names{"bids", "csv", "hdf5"});
}

TEST_CASE("the schema that the first line of a shipped file names is installed beside its folder",
          "[end_to_end][install]") {
  const testing::TempDirectory directory;
  REQUIRE(testing::tapstudy({"--documents", directory / "."}).exit_code == 0);
  int named = 0;
  for (const auto& entry : fs::recursive_directory_iterator{testing::shipped("")}) {
    std::smatch line;
    const std::string text = entry.path().extension() == ".yaml" ? testing::contents(entry) : "";
    if (std::regex_search(text, line, std::regex{"^# .*[$]schema=\\.\\./(.*)\n"})) {
      ++named;
      CAPTURE(entry.path());
      CHECK(fs::exists(fs::path{directory / "."} / line[1].str()));
    }
  }
  CHECK(named > 20);
  CHECK(testing::contents(directory / "schema/protocol.schema.json") ==
        testing::tapstudy({"schema", "protocol"}).standard_output);
}

TEST_CASE("a protocol that is no file is the one of that name installed with the program",
          "[end_to_end][install]") {
  const testing::TempDirectory directory;
  const fs::path prefix{directory / "prefix"};
  fs::create_directories(prefix / "bin");
  fs::create_directories(prefix / "share/tapstudy/shipped");
  fs::copy(testing::tapstudy_program(), prefix / "bin/tapstudy");
  const auto check = [&] {
    return testing::run_program({prefix / "bin/tapstudy", "check", "shipped/study.yaml"}).exit_code;
  };
  CHECK(check() == 2);
  fs::copy(testing::shipped("paper/discrimination.yaml"),
           prefix / "share/tapstudy/shipped/study.yaml");
  CHECK(check() == 0);
}
