// A session that tells others what it does.
#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
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
// Without the markers of taps and the two clocks at the end of each line.
std::string changes_among(const std::string& lines) {
  std::istringstream all{lines};
  std::string changes;
  for (std::string line; std::getline(all, line);) {
    const std::size_t begin = line.find('\t') + 1;
    const std::string kind = line.substr(begin, line.find('\t', begin) - begin);
    if (kind != "contact" && kind != "impact" && kind != "late_impact" && kind != "release" &&
        kind != "switch") {
      changes += line.substr(0, line.rfind('\t', line.rfind('\t') - 1)) + "\n";
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

TEST_CASE("both clocks of a session's markers run with the session's time",
          "[end_to_end][markers][threads]") {
  const TempDirectory directory;
  const auto before = std::chrono::steady_clock::now().time_since_epoch();
  const auto before_utc = std::chrono::system_clock::now().time_since_epoch();
  const auto result = session(directory, "{lines: markers.tsv}");
  const auto seconds = [](std::chrono::nanoseconds of) {
    return std::to_string(std::chrono::duration<double>{of}.count());
  };
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  const auto compared =
      testing::run_program({"/usr/bin/python3", "-c", R"(
import datetime, sys, time
sent = [line.rstrip("\n").split("\t") for line in open(sys.argv[1])]
by_monotonic = [float(monotonic_s) - float(t_s) for t_s, _, _, _, monotonic_s, _ in sent]
assert max(by_monotonic) - min(by_monotonic) < 2e-6
assert float(sys.argv[2]) < by_monotonic[0] < time.clock_gettime(time.CLOCK_MONOTONIC)
by_utc = [datetime.datetime.fromisoformat(utc.replace("Z", "+00:00")).timestamp() - float(t_s)
          for t_s, _, _, _, _, utc in sent]
assert max(by_utc) - min(by_utc) < 0.1, (min(by_utc), max(by_utc))
assert float(sys.argv[3]) < by_utc[0] < time.time()
)",
                            directory / "markers.tsv", seconds(before), seconds(before_utc)});
  INFO(compared.standard_error);
  CHECK(compared.exit_code == 0);
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
    t_s, kind, trial, value = line.split("\t")[:4]
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
sent = [line.split("\t")[:4] for line in open(sys.argv[1])]
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
  for (std::string time, address, types, t_s, number, detail, monotonic_s, utc;
       dump >> time >> address >> types >> t_s >> number >> std::quoted(detail) >> monotonic_s >>
       utc;) {
    CHECK(types == "disdt");
    read += fmt::format("{}\t{}\t{}\t{}\t{}\t{}\n", t_s, address.substr(std::strlen("/tapstudy/")),
                        number, detail, monotonic_s, utc);
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

namespace {
// Pulls two streams of liblsl's own inlets until the session has ended, one line a sample.
constexpr const char* lsl_receiver = R"py(
import ctypes, sys
lsl = ctypes.CDLL(sys.argv[1])
name, connected = sys.argv[2], sys.argv[3]
c_double, c_int, c_void_p, c_char_p = ctypes.c_double, ctypes.c_int, ctypes.c_void_p, ctypes.c_char_p
lsl.lsl_resolve_byprop.argtypes = [ctypes.POINTER(c_void_p), ctypes.c_uint, c_char_p, c_char_p, c_int, c_double]
lsl.lsl_create_inlet.restype = c_void_p
lsl.lsl_create_inlet.argtypes = [c_void_p, c_int, c_int, c_int]
lsl.lsl_open_stream.argtypes = [c_void_p, c_double, ctypes.POINTER(c_int)]
lsl.lsl_pull_sample_str.restype = lsl.lsl_pull_sample_d.restype = c_double
lsl.lsl_pull_sample_str.argtypes = [c_void_p, ctypes.POINTER(c_char_p), c_int, c_double, ctypes.POINTER(c_int)]
lsl.lsl_pull_sample_d.argtypes = [c_void_p, ctypes.POINTER(c_double), c_int, c_double, ctypes.POINTER(c_int)]
error = c_int(0)
def inlet(stream):
    found = (c_void_p * 1)()
    assert lsl.lsl_resolve_byprop(found, 1, b"name", stream.encode(), 1, 120.0) == 1, stream
    one = lsl.lsl_create_inlet(found[0], 360, 0, 1)
    lsl.lsl_open_stream(one, 60.0, ctypes.byref(error))
    assert error.value == 0, stream
    return one
markers, forces = inlet(name), inlet(name + "_force")
open(connected, "w").close()
text, force = (c_char_p * 1)(), (c_double * 3)()
while text[0] is None or not text[0].startswith(b"ended"):
    at_s = lsl.lsl_pull_sample_str(markers, text, 1, 60.0, ctypes.byref(error))
    assert error.value == 0 and at_s > 0.0
    print("marker", repr(at_s), text[0].decode(), sep="\t")
while at_s := lsl.lsl_pull_sample_d(forces, force, 3, 1.0, ctypes.byref(error)):
    print("force", repr(at_s), *map(repr, force), sep="\t")
)py";

// What went to a stand-in for the library, and what it was told of the streams.
testing::ProgramResult session_with_lsl(const TempDirectory& directory, const char* lsl) {
  std::filesystem::create_symlink(testing::lsl_stand_in(), directory / "liblsl.so.2");
  std::vector<std::string> line{"/usr/bin/env", "LD_LIBRARY_PATH=" + (directory / ""),
                                "TAPSTUDY_LSL_LOG=" + (directory / "received"),
                                testing::tapstudy_program()};
  std::ranges::copy(session_line(directory, fmt::format("{{lines: markers.tsv, lsl: {}}}", lsl)),
                    std::back_inserter(line));
  return testing::run_program(line, answers);
}

// Arguments: what was received, the lines of the same session, its database.
constexpr const char* lsl_comparison = R"py(
import sqlite3, sys
lines = [line.rstrip("\n").split("\t") for line in open(sys.argv[2])]
sent = [(float(monotonic_s), f"{state} {trial} {detail}".rstrip())
        for _, state, trial, detail, monotonic_s, _ in lines]
received = [line.rstrip("\n").split("\t") for line in open(sys.argv[1])]
markers = [(float(row[1]), row[2].rstrip()) for row in received if row[0] == "marker"]
# the first ones may be sent before anybody has connected, and none later is lost
assert len(markers) > 30 and [text for _, text in markers] == [text for _, text in sent[-len(markers):]]
for (here, text), (there, _) in zip(markers, sent[-len(markers):]):
    assert abs(here - there) < 1e-3, (here, there, text)
forces = [(float(at_s), *map(float, force)) for kind, at_s, *force in received if kind == "force"]
ticks, = sqlite3.connect(sys.argv[3]).execute(
    "SELECT sum(ticks) FROM tick_statistics JOIN trial USING (trial_id) WHERE number > 1").fetchone()
begin_s = next(at_s for at_s, text in sent if text.startswith("ready 2"))
later = [force for force in forces if force[0] > begin_s]
assert len(later) == ticks > 1000, (len(later), ticks)
assert all(a[0] < b[0] for a, b in zip(forces, forces[1:]))
assert max(y for _, _, y, _ in forces) > 0.5
)py";
}  // namespace

TEST_CASE("the library of the Lab Streaming Layer is given every marker, and every force if asked",
          "[end_to_end][markers][threads]") {
  const TempDirectory directory;
  const bool has_forces = GENERATE(true, false);
  const auto run = session_with_lsl(directory, has_forces ? "{name: a_name, forces: true}" : "{}");
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  const std::string received = testing::contents(directory / "received");
  CHECK_THAT(received, Catch::Matchers::StartsWith(
                           fmt::format("stream\t{0}\tMarkers\t1\t0\t3\ttapstudy {0}\n",
                                       has_forces ? "a_name" : "tapstudy")));
  if (!has_forces) {
    CHECK_THAT(received, !Contains("\tForce\t") && !Contains("\nforce\t"));
    return;
  }
  CHECK_THAT(received, Contains("\nstream\ta_name_force\tForce\t3\t0\t2\ttapstudy a_name_force\n"
                                "label\tforce_x_n\nunit\tN\nlabel\tforce_y_n\nunit\tN\n"));
  const auto compared =
      testing::run_program({"/usr/bin/python3", "-c", lsl_comparison, directory / "received",
                            directory / "markers.tsv", (directory / "the_study") + "/study.db"});
  INFO(compared.standard_error);
  CHECK(compared.exit_code == 0);
}

// Not tagged [threads]: the library's own are not instrumented.
TEST_CASE("inlets of the Lab Streaming Layer get the markers and every tick's force",
          "[end_to_end][markers]") {
  const char* const library = std::getenv("LIBLSL");
  if (library == nullptr) {
    WARN("NOT TESTED: LIBLSL names no library (one is in npm's lsl.js@1)");
    return;
  }
  const TempDirectory directory;
  std::filesystem::create_symlink(library, directory / "liblsl.so.2");
  const std::string name = "tapstudy_" + std::to_string(getpid());
  std::vector<std::string> line{
      "/bin/sh",
      "-c",
      "python3 -c \"$1\" $2 $3 $4/connected >$4/received & reader=$!\n"
      "answers=$5; export LD_LIBRARY_PATH=$4; connected=$4/connected; shift 5\n"
      "(for i in $(seq 600); do [ -e $connected ] && break; sleep 0.1; done; printf \"$answers\") |"
      " \"$@\" || kill $reader\n"
      "wait $reader",
      "sh",
      lsl_receiver,
      library,
      name,
      directory / "",
      answers,
      testing::tapstudy_program()};
  std::ranges::copy(
      session_line(directory, "{lines: markers.tsv, lsl: {name: " + name + ", forces: true}}"),
      std::back_inserter(line));
  const auto run = testing::run_program(line);
  INFO(run.standard_output << run.standard_error);
  REQUIRE(run.exit_code == 0);
  const auto compared =
      testing::run_program({"/usr/bin/python3", "-c", lsl_comparison, directory / "received",
                            directory / "markers.tsv", (directory / "the_study") + "/study.db"});
  INFO(compared.standard_error);
  CHECK(compared.exit_code == 0);
}

TEST_CASE("without liblsl a rig that asks for it is refused with where to get it",
          "[end_to_end][markers]") {
  if (dlopen("liblsl.so.2", RTLD_NOW) != nullptr || dlopen("liblsl.so", RTLD_NOW) != nullptr) {
    return;  // this machine has it
  }
  const TempDirectory directory;
  const auto refused = session(directory, "{lsl: {}}");
  CHECK(refused.exit_code == 3);
  CHECK_THAT(refused.standard_error, Contains("markers.lsl: liblsl.so.2 is not installed") &&
                                         Contains("github.com/sccn/liblsl/releases"));
}
