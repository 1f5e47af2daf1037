// A session that tells others what it does.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <iomanip>
#include <sstream>

#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
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
// Without the markers of taps.
std::string changes_among(const std::string& lines) {
  std::istringstream all{lines};
  std::string changes;
  for (std::string line; std::getline(all, line);) {
    const std::size_t begin = line.find('\t') + 1;
    const std::string kind = line.substr(begin, line.find('\t', begin) - begin);
    if (kind != "contact" && kind != "impact" && kind != "late_impact" && kind != "release" &&
        kind != "switch") {
      changes += line + "\n";
    }
  }
  return changes;
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
  const std::string changes = changes_among(lines);
  CHECK(std::ranges::count(changes, '\n') == 1 + 4 * 8 + 1);
  CHECK(changes == stored_changes(directory));
}

TEST_CASE("the taps' markers are the stored events of the taps, as far apart in time",
          "[end_to_end][markers][threads]") {
  const TempDirectory directory;
  const auto result = session(directory, "{lines: markers.tsv}");
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  const auto compared =
      testing::run_program({"/usr/bin/python3", "-c", R"(
import sqlite3, sys
kinds = ("contact", "impact", "late_impact", "release", "switch")
sent, stored = {}, {}
for line in open(sys.argv[1]):
    t_s, kind, trial, value = line.rstrip("\n").split("\t")
    if kind in kinds:
        sent.setdefault(int(trial), []).append((float(t_s), kind, float(value)))
for trial, t_s, kind, value in sqlite3.connect(sys.argv[2]).execute(
        "SELECT number, t_s, kind, value FROM event JOIN trial USING (trial_id) ORDER BY number, "
        "t_s, event.rowid"):
    if kind in kinds:
        stored.setdefault(trial, []).append((t_s, kind, value))
assert sent.keys() == stored.keys() and len(sent) == 8
for trial in sent:
    assert [k for _, k, _ in sent[trial]] == [k for _, k, _ in stored[trial]], trial
    apart = sent[trial][0][0] - stored[trial][0][0]
    for (a, _, x), (b, _, y) in zip(sent[trial], stored[trial]):
        assert abs(a - b - apart) < 2e-6 and abs(x - y) < 1e-5, (a, b, apart, x, y)
)",
                            directory / "markers.tsv", (directory / "the_study") + "/study.db"});
  INFO(compared.standard_error);
  CHECK(compared.exit_code == 0);
}

TEST_CASE("intervals, replays, settings and scripted taps are markers, as they are stored",
          "[end_to_end][markers][threads]") {
  const TempDirectory directory;
  std::string study = testing::contents(testing::source("tests/data/every_task.yaml"));
  const std::size_t blocks = study.find("blocks:\n");
  const std::string head = study.substr(0, blocks);
  std::string simulation = study.substr(study.find("simulation:"));
  simulation = testing::replaced(simulation, ", reference: one", "");
  testing::write(
      directory / "study.yaml",
      head +
          "blocks:\n"
          "  - {name: in_turn, task: abx, question: \"Which is X?\", stimuli: [one, other], "
          "explore: "
          "{min_contacts: 0, intervals: {seconds: 0.3, gap_seconds: 0.1, max_replays: 1}}}\n"
          "  - {name: set, task: adjustment, question: \"Equal?\", stimuli: [family], settings: "
          "{from: 3, to: 6, count: 13}, standard: 4.5, explore: {min_contacts: 0}}\n"
          "  - {name: by_script, task: identification, question: \"Which?\", stimuli: [one, "
          "other], "
          "explore: {scripted_taps: {point: middle, speed_m_s: 0.2}}}\n" +
          simulation);
  testing::write(directory / "rig.yaml",
                 testing::contents(testing::shipped("rigs/simulated_hand.yaml")) +
                     "\nmarkers: {lines: markers.tsv}\n");
  const auto result =
      testing::tapstudy({"run", directory / "study.yaml", "--participant", "P01", "--seed", "5",
                         "--out", directory / "the_study", "--rig", directory / "rig.yaml"},
                        "again\n= A\n= A\n= A\n= A\n+\n++\n=\n1\n1\n");
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  const auto compared =
      testing::run_program({"/usr/bin/python3", "-c", R"py(
import collections, sqlite3, sys
kinds = ("interval", "interval_end", "interval_replay", "setting", "scripted_taps")
sent = [line.rstrip("\n").split("\t") for line in open(sys.argv[1])]
sent = collections.Counter((k, int(n), round(float(v), 5)) for t, k, n, v in sent if k in kinds)
stored = collections.Counter((k, n, round(v, 5)) for k, n, v in sqlite3.connect(sys.argv[2]).execute(
    "SELECT kind, number, value FROM event JOIN trial USING (trial_id)") if k in kinds)
assert sent == stored, (sent, stored)
assert {k for k, n, v in sent} == set(kinds), sent
)py",
                            directory / "markers.tsv", (directory / "the_study") + "/study.db"});
  INFO(compared.standard_error);
  CHECK(compared.exit_code == 0);
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
      testing::tapstudy_program()};
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
  CHECK_THAT(read, Contains("\timpact\t"));
  CHECK(changes_among(read) == stored_changes(directory));
}

TEST_CASE("a session whose markers nobody reads goes on, and says so once",
          "[end_to_end][markers][threads]") {
  const TempDirectory directory;
  REQUIRE(testing::run_program({"/usr/bin/mkfifo", directory / "pipe"}).exit_code == 0);
  const auto result = session(directory, "{lines: pipe}");
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.standard_error, Contains("'begun' could not be delivered"));
  CHECK_THAT(result.standard_error, Contains(" were lost"));
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
