// A session that tells others what it does.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <iomanip>
#include <sstream>

#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using Catch::Matchers::Contains;
using testing::TempDirectory;

namespace {
constexpr const char* answers = "1\n2\n3\n4\n1\n2\n3\n4\n";

std::vector<std::string> session_line(const TempDirectory& directory, const std::string& markers) {
  testing::write(directory / "rig.yaml",
                 testing::contents(testing::shipped("rigs/simulated_hand.yaml")) +
                     "\nmarkers: " + markers + "\n");
  return {"run",           testing::shipped("paper/discrimination.yaml").string(),
          "--participant", "P01",
          "--seed",        "5",
          "--out",         directory / "the_study",
          "--rig",         directory / "rig.yaml"};
}
testing::ProgramResult session(const TempDirectory& directory, const std::string& markers) {
  return testing::tapstudy(session_line(directory, markers), answers);
}
// Python rounds as IEEE 754 asks; sqlite3's printf does not.
std::string stored_changes(const TempDirectory& directory) {
  const std::string script =
      "import sqlite3, sys\n"
      "for t_s, state, number, detail in sqlite3.connect(sys.argv[1]).execute(\n"
      "    'SELECT t_s, state, coalesce(number, -1), detail FROM session_event ORDER BY rowid'):\n"
      "    print(f'{t_s:.6f}\\t{state}\\t{number}\\t{detail}')\n";
  return testing::run_program(
             {"/usr/bin/python3", "-c", script, (directory / "the_study") + "/study.db"})
      .standard_output;
}
}  // namespace

TEST_CASE("the lines of a session are the rows of its changes of state",
          "[end_to_end][markers][threads]") {
  const TempDirectory directory;
  const auto result = session(directory, "{osc: {port: 9}, lines: markers.tsv}");
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  const std::string lines = testing::contents(directory / "markers.tsv");
  CHECK(std::ranges::count(lines, '\n') == 1 + 4 * 8 + 1);
  CHECK(lines == stored_changes(directory));
}

TEST_CASE("liblo's own oscdump reads the changes of state that are stored",
          "[end_to_end][markers][threads]") {
  const TempDirectory directory;
  const std::string port = std::to_string(20'000 + getpid() % 20'000);
  std::vector<std::string> line{
      "/bin/sh",
      "-c",
      "oscdump -L $0 >$1 & reader=$!; dump=$1; shift\n"
      "hexadecimal=$(printf ':%04X ' $0)\n"
      "for i in $(seq 300); do grep -q $hexadecimal /proc/net/udp* && break; sleep 0.1; done\n"
      "\"$@\"\n"
      "for i in $(seq 100); do grep -q /tapstudy/ended $dump && break; sleep 0.1; done\n"
      "kill $reader",
      port,
      directory / "dump",
      TAPSTUDY_PROGRAM};
  std::ranges::copy(session_line(directory, "{osc: {port: " + port + "}}"),
                    std::back_inserter(line));
  const auto run = testing::run_program(line, answers);
  INFO(run.standard_error);
  std::istringstream dump{testing::contents(directory / "dump")};
  std::string read;
  for (std::string time, address, types, t_s, number, detail;
       dump >> time >> address >> types >> t_s >> number >> std::quoted(detail);) {
    CHECK(types == "dis");
    read += fmt::format("{}\t{}\t{}\t{}\n", t_s, address.substr(std::strlen("/tapstudy/")), number,
                        detail);
  }
  CHECK(std::ranges::count(read, '\n') == 1 + 4 * 8 + 1);
  CHECK(read == stored_changes(directory));
}

TEST_CASE("a session whose markers nobody reads goes on, and says so once",
          "[end_to_end][markers][threads]") {
  const TempDirectory directory;
  REQUIRE(testing::run_program({"/usr/bin/mkfifo", directory / "pipe"}).exit_code == 0);
  const auto result = session(directory, "{lines: pipe}");
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.standard_error, Contains("'begun' is lost (nobody takes it)"));
  CHECK_THAT(result.standard_error, Contains("34 were lost"));
  CHECK_THAT(result.standard_error, !Contains("'ready' is lost"));
}

TEST_CASE("a port for markers that is not there is refused before anything is stored",
          "[end_to_end][markers]") {
  const TempDirectory directory;
  const auto result = session(directory, "{lines: /dev/no_such_port}");
  CHECK(result.exit_code == 3);
  CHECK_THAT(result.standard_error,
             Contains("markers.lines: '/dev/no_such_port' cannot be opened"));
  CHECK_FALSE(std::filesystem::exists(directory / "the_study"));
}
