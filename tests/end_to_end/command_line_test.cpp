// What a researcher types and what comes back: output and exit code of the program itself.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::replaced;
using testing::TempDirectory;

namespace {
std::string paper(const std::string& name) {
  return testing::shipped("paper/" + name).string();
}
std::string changed(const TempDirectory& directory, const std::string& name,
                    const std::string& from, const std::string& to) {
  const std::string file = directory / name;
  testing::write(file, replaced(testing::contents(paper(name)), from, to));
  return file;
}
std::vector<std::vector<std::string>> csv_rows(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream stream{text};
  for (std::string line; std::getline(stream, line);) {
    std::vector<std::string> cells;
    std::istringstream cell_stream{line};
    for (std::string cell; std::getline(cell_stream, cell, ',');) {
      cells.push_back(cell);
    }
    rows.push_back(cells);
  }
  return rows;
}
std::vector<double> column(const std::string& csv, const std::string& name) {
  const auto rows = csv_rows(csv);
  const auto place = std::find(rows.front().begin(), rows.front().end(), name);
  REQUIRE(place != rows.front().end());
  std::vector<double> values;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    values.push_back(std::stod(rows[i].at(static_cast<std::size_t>(place - rows.front().begin()))));
  }
  return values;
}
std::string tap(const std::string& technique, const std::string& at) {
  const auto result =
      testing::tapstudy({"tap", paper("reality_finger.yaml"), "--stimulus", "both", "--technique",
                         technique, "--at", at, "--speed", "0.3", "--csv", "-"});
  REQUIRE(result.exit_code == 0);
  return result.standard_output;
}
double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) {
    most = std::max(most, std::abs(value));
  }
  return most;
}
}  // namespace

TEST_CASE("help and version are results, nonsense is an error of usage", "[end_to_end]") {
  CHECK(testing::tapstudy({"--help"}).exit_code == 0);
  CHECK_THAT(testing::tapstudy({"--version"}).standard_output, Contains("tapstudy 0."));
  for (const std::vector<std::string>& line :
       std::vector<std::vector<std::string>>{{},
                                             {"dance"},
                                             {"modes"},
                                             {"simulate", paper("discrimination.yaml")},
                                             {"tap", paper("forces.yaml"), "--speed", "fast"}}) {
    const auto result = testing::tapstudy(line);
    CHECK(result.exit_code == 2);
    CHECK(result.standard_output.empty());
    CHECK_FALSE(result.standard_error.empty());
  }
}

TEST_CASE("modes gives frequencies, damping, sizes and times as JSON", "[end_to_end]") {
  const TempDirectory directory;
  const auto result =
      testing::tapstudy({"modes", paper("discrimination.yaml"), "--stimulus", "acrylic_two",
                         "--json", "--mesh-out", directory / "plate"});
  REQUIRE(result.exit_code == 0);
  const auto json = nlohmann::json::parse(result.standard_output);
  CHECK(json["schema_version"] == 1);
  const std::vector<double> hz = json["frequencies_hz"];
  CHECK(std::is_sorted(hz.begin(), hz.end()));
  CHECK(hz.size() == 3);
  // eq. 12 with Table 1's coefficients
  const double omega = 2.0 * M_PI * hz[0];
  CHECK(json["damping_ratios"][0].get<double>() == Approx(0.5 * (120.0 / omega + 8.5e-5 * omega)));
  CHECK(json["elements"] == 445);
  CHECK(json["dof"].get<int>() == 3 * 172 - 12);
  CHECK(json["seconds"]["total"].get<double>() > 0.0);
  CHECK_THAT(testing::contents(directory / "plate.ele"), Catch::Matchers::StartsWith("445 4 0"));
}

TEST_CASE("the techniques differ as they must", "[end_to_end]") {
  const std::string none = tap("none", "P3");
  CHECK(largest(column(none, "vibration_n")) == 0.0);
  CHECK(largest(column(none, "sinusoid_n")) == 0.0);
  CHECK(largest(column(none, "penalty_n")) > 1.0);
  CHECK(column(tap("sinusoid", "P3"), "sinusoid_n") == column(tap("sinusoid", "P1"), "sinusoid_n"));
  const std::string fem = tap("fem", "P3");
  CHECK(largest(column(fem, "vibration_n")) >
        5.0 * largest(column(tap("fem", "P1"), "vibration_n")));
  CHECK(largest(column(fem, "sinusoid_n")) == 0.0);
  const std::string coupled = tap("fem-coupled", "P3");
  CHECK(largest(column(coupled, "vibration_n")) > 0.0);
  CHECK(largest(column(coupled, "sinusoid_n")) == 0.0);
  const std::string both = tap("fem+sinusoid", "0.24,0.24");
  CHECK(largest(column(both, "vibration_n")) > 0.0);
  CHECK(largest(column(both, "sinusoid_n")) > 0.0);
  const auto speeds = column(both, "velocity_y_m_s");
  const auto impacts = column(both, "impact");
  const auto impact = std::find(impacts.begin(), impacts.end(), 1.0) - impacts.begin();
  CHECK(speeds.at(static_cast<std::size_t>(impact)) == Approx(-0.3));
}

TEST_CASE("a tap can be had twice to the last bit", "[end_to_end]") {
  CHECK(tap("fem+sinusoid", "P2") == tap("fem+sinusoid", "P2"));
}

TEST_CASE("the demo study runs, is stored whole and is reported", "[end_to_end]") {
  const TempDirectory directory;
  const std::string study = directory / "study";
  const auto run = testing::tapstudy({"simulate", paper("discrimination.yaml"), "--participants",
                                      "10", "--seed", "1", "--out", study});
  REQUIRE(run.exit_code == 0);
  const auto sql = [&](const std::string& query) {
    return testing::run_program({"/usr/bin/sqlite3", study + "/study.db", query}).standard_output;
  };
  CHECK(sql("PRAGMA integrity_check") == "ok\n");
  CHECK(sql("PRAGMA foreign_key_check").empty());
  CHECK(sql("SELECT count(*), sum(dropped_samples) FROM tick_statistics") == "80|0\n");
  CHECK(sql("SELECT count(*) FROM (SELECT trial_id, sum(ticks) AS kept FROM trace_chunk "
            "GROUP BY trial_id) JOIN tick_statistics USING (trial_id) WHERE kept = ticks") ==
        "80\n");
  const auto report = testing::tapstudy({"report", study});
  REQUIRE(report.exit_code == 0);
  CHECK_THAT(report.standard_output, Contains("presented \\ answered"));
  CHECK_THAT(report.standard_output, Contains("SIMULATED"));
  CHECK_THAT(testing::contents(study + "/report/report.html"), Contains("SIMULATED participants"));
  const auto json = nlohmann::json::parse(testing::contents(study + "/report/report.json"));
  int total = 0;
  for (const auto& row : json["blocks"][0]["counts"]) {
    for (const int count : row) {
      total += count;
    }
  }
  CHECK(total == 80);
  SECTION("a report is not written over, unless asked") {
    CHECK(testing::tapstudy({"report", study}).exit_code == 2);
    CHECK(testing::tapstudy({"report", study, "--replace"}).exit_code == 0);
  }
  SECTION("the same participants are not simulated again into it") {
    const auto again = testing::tapstudy(
        {"simulate", paper("discrimination.yaml"), "--participants", "10", "--out", study});
    CHECK(again.exit_code == 2);
    CHECK_THAT(again.standard_error, Contains("already"));
    CHECK(sql("SELECT count(*) FROM trial") == "80\n");
  }
  SECTION("another protocol is kept out") {
    const auto other =
        testing::tapstudy({"simulate", paper("reality_finger.yaml"), "--out", study});
    CHECK(other.exit_code == 2);
    CHECK_THAT(other.standard_error, Contains("another protocol"));
  }
}

TEST_CASE("the same seed simulates the same study", "[end_to_end]") {
  const TempDirectory directory;
  const auto dump = [&](const std::string& name) {
    const std::string study = directory / name;
    REQUIRE(testing::tapstudy({"simulate", paper("reality_vibration.yaml"), "--participants", "3",
                               "--seed", "42", "--out", study})
                .exit_code == 0);
    return testing::run_program(
               {"/usr/bin/sqlite3", study + "/study.db",
                "SELECT participant_id, trial.number, response, response_time_s, "
                "hex(bytes) FROM trial JOIN response USING (trial_id) JOIN session "
                "USING (session_id) JOIN trace_chunk USING (trial_id) "
                "ORDER BY participant_id, trial.number, first_tick"})
        .standard_output;
  };
  const std::string once = dump("once");
  CHECK(once.size() > 10'000);
  CHECK(once == dump("twice"));
}

TEST_CASE("report --counts takes the paper's Table 2", "[end_to_end]") {
  const auto result = testing::tapstudy({"report", "--counts", paper("table2.csv")});
  REQUIRE(result.exit_code == 0);
  for (const char* said : {"correct: 43/80", "structure: 65/80", "material: 48/80",
                           "material, given structure is right: 43/65"}) {
    CHECK_THAT(result.standard_output, Contains(said));
  }
}

TEST_CASE("check shows design, schedule, models and power", "[end_to_end]") {
  const auto result = testing::tapstudy({"check", paper("discrimination.yaml")});
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.standard_output, Contains("chance 25 %"));
  CHECK_THAT(result.standard_output, Contains("of 80 answers 27 must be right"));
  CHECK_THAT(result.standard_output, Contains("schedule of participant 10"));
  CHECK_THAT(result.standard_output, Contains("445 linear tetrahedra"));
}

TEST_CASE("techniques without vibration build no model", "[end_to_end]") {
  const TempDirectory directory;
  std::string text = testing::contents(paper("forces.yaml"));
  for (int i = 0; i < 6; ++i) {
    text = replaced(text, "technique: fem", "technique: none");
  }
  testing::write(directory / "none.yaml", text);
  CHECK_THAT(testing::tapstudy({"check", directory / "none.yaml"}).standard_output,
             Contains("none: no technique here needs a model"));
}

TEST_CASE("bad input is one clear error and its own exit code", "[end_to_end]") {
  const TempDirectory directory;
  const auto refused = [&](const std::vector<std::string>& line, int code, const char* said) {
    const auto result = testing::tapstudy(line);
    INFO(result.standard_error);
    CHECK(result.exit_code == code);
    CHECK(result.standard_output.empty());
    CHECK_THAT(result.standard_error, Contains(said));
    CHECK(std::count(result.standard_error.begin(), result.standard_error.end(), '\n') == 1);
  };
  const std::string name = "discrimination.yaml";
  const std::string out = directory / "out";
  refused({"check", "/nowhere.yaml"}, 2, "/nowhere.yaml: cannot be read");
  refused({"check", changed(directory, name, "notes: |", "notse: |")}, 2, "did you mean 'notes'?");
  refused({"check", changed(directory, name, "poissons_ratio: 0.35", "poissons_ratio: 0.5")}, 2,
          "materials.acrylic.poissons_ratio: 0.5 is not allowed");
  const std::string off_plate =
      changed(directory, name, "at_m: [-0.3, -0.3]", "at_m: [-0.7, -0.3]");
  refused({"modes", off_plate, "--stimulus", "mdf_two"}, 4, "touches no node");
  refused({"simulate", off_plate, "--out", out}, 4, "touches no node");
  CHECK_FALSE(std::filesystem::exists(out));
  refused({"modes",
           changed(directory, name, "- {region: vertex, at_m: [-0.3, -0.3], face: both, axes: xyz}",
                   "- {region: disc, radius_m: 2, at_m: [0, 0], face: through}"),
           "--stimulus", "mdf_two"},
          4, "nothing is left free");
  refused({"modes", paper(name), "--stimulus", "oak"}, 2, "stimulus 'oak' is not in the protocol");
  refused({"tap", paper(name), "--stimulus", "mdf_two", "--at", "7,0"}, 2, "is off the plate");
  refused({"tap", paper(name), "--stimulus", "mdf_two", "--at", "P9"}, 2, "nor a tapping point");
  refused({"tap", paper(name), "--stimulus", "mdf_two", "--speed", "-1"}, 2, "--speed");
  refused({"report", directory.path()}, 2, "there is no study here");
  refused({"simulate", paper("forces.yaml"), "--out", out}, 2, "has no blocks");
  testing::write(directory / "a_file", "");
  refused({"simulate", paper(name), "--out", directory / "a_file"}, 5, "a_file");
  refused({"simulate", paper(name), "--out", "/proc/study"}, 5, "/proc/study");
  refused({"run", paper(name), "--participant", "../P1", "--out", out}, 2, "--participant");
  refused({"run", paper(name), "--participant", "NA", "--out", out}, 2, "NA");
  refused({"run", paper(name), "--participant", "P1", "--out", out, "--console", "80"}, 2,
          "--console");
  refused({"doctor", "--seconds", "nan"}, 2, "nan is not allowed (from 0.1 to 600)");
  refused({"calibrate", "--type", "X3R", "--out", directory / "none/c.yaml"}, 2,
          "there is no directory");
}

namespace {
// A namespace of our own, as the tests of file systems need.
bool can_mount() {
  return testing::run_program({"/usr/bin/unshare", "-rm", "/bin/true"}).exit_code == 0;
}
}  // namespace

TEST_CASE("a full disk ends in one error and leaves whole trials", "[end_to_end]") {
  // a file system of our own, 2 MB large, where the kernel lets us have one
  const std::string script = R"sh(
mount -t tmpfs -o size=2M tapstudy "$1" || exit 70
"$2" simulate "$3" --participants 10 --seed 1 --out "$1/study" 2>"$4"; code=$?
sqlite3 "$1/study/study.db" 'PRAGMA integrity_check; SELECT count(*) > 0 FROM trial;
  SELECT count(*) FROM trial WHERE trial_id NOT IN (SELECT trial_id FROM tick_statistics)' >"$4.sql" 2>&1
exit $code)sh";
  if (!can_mount()) {
    WARN("no private mounts here: the full disk was not tried");
    return;
  }
  const TempDirectory directory;
  const TempDirectory small;
  const auto result = testing::run_program({"/usr/bin/unshare", "-rm", "/bin/sh", "-c", script,
                                            "sh", small.path(), testing::tapstudy_program(),
                                            paper("discrimination.yaml"), directory / "said"});
  CHECK(result.exit_code == 5);
  CHECK_THAT(testing::contents(directory / "said"), Contains("is the disk full?"));
  CHECK(testing::contents(directory / "said.sql") == "ok\n1\n0\n");
}

TEST_CASE("a read-only disk is an error of the store, and the study on it can still be reported",
          "[end_to_end]") {
  const std::string script = R"sh(
mount -t tmpfs tapstudy "$1" || exit 70
"$2" simulate "$3" --participants 1 --out "$1/study" >/dev/null || exit 78
mount -o remount,ro "$1" || exit 70
"$2" simulate "$3" --participants 1 --out "$1/new" 2>"$4"; echo $? >>"$4"
"$2" simulate "$3" --participants 1 --out "$1/study" 2>>"$4"; echo $? >>"$4"
"$2" report "$1/study" --out "$4.report" >/dev/null 2>>"$4"; echo $? >>"$4")sh";
  if (!can_mount()) {
    WARN("no private mounts here: the read-only disk was not tried");
    return;
  }
  const TempDirectory directory;
  const TempDirectory disk;
  const auto result = testing::run_program({"/usr/bin/unshare", "-rm", "/bin/sh", "-c", script,
                                            "sh", disk.path(), testing::tapstudy_program(),
                                            paper("reality_vibration.yaml"), directory / "said"});
  auto lines = csv_rows(testing::contents(directory / "said"));
  std::erase_if(lines, [](const auto& line) {  // progress, of a machine that is busy
    return line[0].starts_with("tapstudy: ");
  });
  REQUIRE(lines.size() == 5);
  CHECK_THAT(lines[0][0], Contains("Read-only file system"));
  CHECK(lines[1][0] == "5");
  CHECK_THAT(lines[2][0], Contains("readonly database"));
  CHECK(lines[3][0] == "5");
  CHECK(lines[4][0] == "0");
}

TEST_CASE("the panels of Figures 4 and 5 are drawn by one command", "[end_to_end]") {
  const TempDirectory directory;
  const auto result =
      testing::tapstudy({"tap", paper("forces.yaml"), "--panels", directory / "figures"});
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  for (const char* name : {"forces_two_fixations.svg", "forces_four_fixations.svg"}) {
    const std::string svg = testing::contents((directory / "figures/") + name);
    CHECK_THAT(svg, Contains("</svg>"));
    CHECK_THAT(svg, Contains("aluminium"));
  }
}

TEST_CASE("a figure that does not fit on the disk is an error and leaves nothing", "[end_to_end]") {
  const TempDirectory directory;
  const std::string figure = directory / "modes.svg";
  const std::string command =
      "trap '' XFSZ; ulimit -f 8; exec \"$0\" modes \"$1\" --stimulus mdf_two --figure \"$2\"";
  const auto run = testing::run_program({"/bin/sh", "-c", command, testing::tapstudy_program(),
                                         paper("discrimination.yaml"), figure});
  CHECK(run.exit_code == 5);
  CHECK_THAT(run.standard_error, Contains("is the disk full?"));
  CHECK_FALSE(std::filesystem::exists(figure));
}

TEST_CASE("a file that is no protocol is refused however long it is", "[end_to_end]") {
  const auto run = testing::tapstudy({"check", "/dev/zero"});
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.standard_error, Contains("too long"));
}

TEST_CASE("check counts the screens that a session shows", "[end_to_end][threads]") {
  const TempDirectory directory;
  const std::string study = testing::source("tests/data/every_screen.yaml");
  const auto shown = testing::tapstudy({"check", study}).standard_output;
  const std::string answers = "\nright\n\n1\n2\n\n1\n2\n\n2\n3\n4\n0.75\n\n";
  REQUIRE(testing::tapstudy({"run", study, "--participant", "P01", "--out", directory / "study"},
                            answers)
              .exit_code == 0);
  const auto counted = testing::run_program(
      {"/usr/bin/sqlite3", (directory / "study") + "/study.db",
       "SELECT printf('%6d  in all', count(*)) FROM session_event WHERE state IN ('instructions', "
       "'form', 'exploring', 'feedback', 'confidence', 'resting')"});
  INFO(shown);
  const std::string total = counted.standard_output;
  CHECK_THAT(shown, Contains(total.substr(0, total.size() - 1)));
  CHECK_THAT(shown, Contains("1  a break of 1 to 600 s, after every 1 trial\n"));
}

TEST_CASE("check warns of a contact that the hand cannot rest on", "[end_to_end]") {
  const TempDirectory directory;
  const auto checked = [&](const std::string& stiffness) {
    const auto run = testing::tapstudy(
        {"check", changed(directory, "discrimination.yaml", "penalty_stiffness_n_per_m: 3000",
                          "penalty_stiffness_n_per_m: " + stiffness)});
    INFO(run.standard_error);
    CHECK(run.exit_code == 0);
    return run.standard_output;
  };
  CHECK_THAT(checked("3000"), Contains("rests on up to") && !Contains("chatter"));
  CHECK_THAT(checked("15000"), Contains("half its damping would chatter"));
  CHECK_THAT(checked("25000"), Contains("it will chatter"));
}

TEST_CASE("a value that is empty, or a file's name that promises another format, is refused",
          "[end_to_end]") {
  const std::string study = testing::shipped("paper/forces.yaml").string();
  const std::vector<std::vector<std::string>> lines{
      {"modes", study, "--stimulus", "mdf_four", "--vtu", ""},
      {"modes", study, "--stimulus", "mdf_four", "--vtu", "modes.vtk"},
      {"modes", study, "--stimulus", "mdf_four", "--figure", "modes.png"},
      {"tap", study, "--stimulus", "mdf_four", "--at", "P1", "--frames", "-"},
      {"tap", study, "--stimulus", "mdf_four", "--at", "P1", "--csv", ""},
      {"report", "--counts", ""}};
  for (const auto& line : lines) {
    const auto run = testing::tapstudy(line);
    CAPTURE(line, run.standard_error);
    CHECK(run.exit_code == 2);
    CHECK_THAT(run.standard_error, Contains("must not be empty") || Contains("must end in"));
  }
}

#if !TAPSTUDY_SANITIZED
TEST_CASE("too little memory for a fine mesh is one sentence", "[end_to_end]") {
  const TempDirectory directory;
  const std::string study =
      changed(directory, "forces.yaml",
              "  four_fixations:\n    size_m: [0.6, 0.6, 0.05]\n    mesh: {order: 1}\n",
              "  four_fixations:\n    size_m: [0.6, 0.6, 0.05]\n"
              "    mesh: {order: 2, max_tet_volume_m3: 2.0e-6}\n");
  const auto run = testing::run_program({"/bin/sh", "-c",
                                         "ulimit -v 700000; exec " + testing::tapstudy_program() +
                                             " modes " + study + " --stimulus mdf_four"});
  CAPTURE(run.standard_error);
  CHECK(run.exit_code == 4);
  CHECK_THAT(run.standard_error, Contains("memory"));
}
#endif

TEST_CASE("a calibration that no eight motors of one kind can have is refused", "[end_to_end]") {
  const TempDirectory directory;
  const auto said_of = [&](const std::string& from, const std::string& to) {
    testing::write(directory / "rig.yaml",
                   testing::contents(testing::shipped("rigs/spidar_g6.yaml")));
    testing::write(
        directory / "spidar_calibration.yaml",
        testing::replaced(testing::contents(testing::source("tests/data/spidar_calibration.yaml")),
                          from, to));
    const auto result =
        testing::tapstudy({"check", paper("discrimination.yaml"), "--rig", directory / "rig.yaml"});
    return std::to_string(result.exit_code) + " " + result.standard_error;
  };
  CHECK_THAT(said_of("format", "format"), Catch::Matchers::StartsWith("0 "));
  CHECK_THAT(said_of("-1.66555e-5", "-1.0e-7"),
             Contains("metres_per_count is 1e-07 for string 1 and 1.67e-05"));
  CHECK_THAT(said_of("volts_per_newton: 0.3653", "volts_per_newton: 99"), Contains("string 1"));
  CHECK_THAT(said_of("dac_counts_per_volt: 415", "dac_counts_per_volt: 1300"),
             Contains("string 1"));
  CHECK_THAT(said_of("dac_counts_per_volt: 415", "dac_counts_per_volt: 1200"),
             Contains("max_tension_n, 10 N, is above 9.342 N, which take all 4095 DAC counts"));
}

namespace {
// A box of 0.3 x 0.2 x 0.02 m as an OFF file with faces of four corners, and a study on it.
std::string study_on_a_surface(const TempDirectory& directory, const std::string& technique) {
  testing::write(directory / "body.off",
                 "OFF\n8 6 0\n0 0 0\n300 0 0\n300 200 0\n0 200 0\n0 0 20\n300 0 20\n"
                 "300 200 20\n0 200 20\n4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n"
                 "4 2 3 7 6\n4 3 0 4 7\n");
  std::string text = testing::contents(paper("reality_vibration.yaml"));
  text = replaced(text, "lateral_scale: 0.1", "lateral_scale: 1");
  text = replaced(text,
                  "    size_m: [0.6, 0.6, 0.05]\n    mesh: {order: 1}\n    fixations:\n"
                  "      - {region: vertex, at_m: [-0.3, -0.3], face: both, axes: xyz}\n"
                  "      - {region: vertex, at_m: [0.3, -0.3], face: both, axes: xyz}\n",
                  "    surface: {file: body.off, metres_per_unit: 0.001}\n    mesh: {order: 1}\n"
                  "    fixations:\n"
                  "      - {region: side, side: left}\n");
  text = replaced(text, "  P1: [-0.24, -0.24]\n  P2: [0.0, 0.0]\n  P3: [0.24, 0.24]\n",
                  "  P1: [0.05, 0.05]\n  P2: [0.15, 0.1]\n  P3: [0.25, 0.15]\n");
  text = replaced(text, "technique: fem}", "technique: " + technique + "}");
  testing::write(directory / "study.yaml", text);
  return directory / "study.yaml";
}
}  // namespace

TEST_CASE("a report needs the study's directory alone, and no session goes on with another body",
          "[end_to_end]") {
  const TempDirectory directory;
  const std::string study = study_on_a_surface(directory, "fem");
  const std::string out = directory / "out";
  REQUIRE(testing::tapstudy({"simulate", study, "--participants", "1", "--out", out}).exit_code ==
          0);
  const std::string body = testing::contents(directory / "body.off");
  CHECK(testing::run_program({"/usr/bin/sqlite3", out + "/study.db",
                              "SELECT file, size, length(zstd) < size FROM surface"})
            .standard_output == "body.off|" + std::to_string(body.size()) + "|1\n");
  testing::write(directory / "body.off", replaced(body, "0 200 20\n4", "0 201 20\n4"));
  const auto changed_body =
      testing::tapstudy({"run", study, "--participant", "P01", "--out", out}, "= a\n");
  CHECK(changed_body.exit_code == 2);
  CHECK_THAT(changed_body.standard_error,
             Contains("'body.off' is not the file that the study began with"));
  std::filesystem::remove(directory / "body.off");
  std::filesystem::remove(study);
  const auto report = testing::tapstudy({"report", out});
  INFO(report.standard_error);
  CHECK(report.exit_code == 0);
}

TEST_CASE("what only the finished model shows to be wrong is told at its line", "[end_to_end]") {
  const TempDirectory directory;
  const auto said = [&](const std::string& from, const std::string& to) {
    const auto run =
        testing::tapstudy({"modes", changed(directory, "discrimination.yaml", from, to),
                           "--stimulus", "acrylic_two"});
    CHECK(run.exit_code == 4);
    return run.standard_error;
  };
  CHECK_THAT(
      said("damping: {alpha_per_s: 120.0, beta_s: 8.50e-5}", "damping: {modal_ratios: [0.1]}"),
      Contains("materials.acrylic.damping: stimulus 'acrylic_two': 1 modal ratios are given, "
               "3 modes") &&
          Catch::Matchers::Matches("(.|\n)*\\.yaml:[0-9]+:[0-9]+: materials(.|\n)*"));
  CHECK_THAT(
      said("mesh: {order: 1}", "mesh: {accuracy: 0.1}"),
      Contains("plates.two_fixations: stimulus 'acrylic_two': mesh.accuracy: fixation 1 is a "
               "point or a line"));
}

TEST_CASE("damping that is fitted, and damping mode by mode, reach the modes", "[end_to_end]") {
  const TempDirectory directory;
  const auto modes = [&](const std::string& damping) {
    const auto result = testing::tapstudy(
        {"modes",
         changed(directory, "discrimination.yaml", "damping: {alpha_per_s: 120.0, beta_s: 8.50e-5}",
                 "damping: " + damping),
         "--stimulus", "acrylic_two", "--json"});
    INFO(result.standard_error);
    REQUIRE(result.exit_code == 0);
    return nlohmann::json::parse(result.standard_output);
  };
  const auto by_mode = modes("{modal_ratios: [0.011, 0.022, 0.033, 0.044]}");
  CHECK(by_mode["damping_ratios"] == std::vector<double>{0.011, 0.022, 0.033});
  CHECK_FALSE(by_mode.contains("alpha_per_s"));
  CHECK(modes("{modal_ratios: [0.011], further_ratio: 0.05}")["damping_ratios"] ==
        std::vector<double>{0.011, 0.05, 0.05});
  // points that lie on one Rayleigh curve, alpha 10 1/s and beta 2e-5 s, and one twice
  const auto ratio = [](double hz) {
    return 0.5 * (10.0 / (2.0 * M_PI * hz) + 2e-5 * 2.0 * M_PI * hz);
  };
  const auto fitted = modes(
      fmt::format("{{measured: [{{frequency_hz: 50, ratio: {}}}, {{frequency_hz: 120, ratio: {}}}, "
                  "{{frequency_hz: 280, ratio: {}}}, {{frequency_hz: 280, ratio: {}}}]}}",
                  ratio(50), ratio(120), ratio(280), ratio(280)));
  CHECK(fitted["alpha_per_s"].get<double>() == Approx(10.0).epsilon(1e-9));
  CHECK(fitted["beta_s"].get<double>() == Approx(2e-5).epsilon(1e-9));
  for (std::size_t i = 0; i < fitted["frequencies_hz"].size(); ++i) {
    CHECK(fitted["damping_ratios"][i].get<double>() ==
          Approx(ratio(fitted["frequencies_hz"][i].get<double>())));
  }
  // off the curve: the normal equations of least squares hold
  const auto off = modes(
      "{measured: [{frequency_hz: 50, ratio: 0.05}, {frequency_hz: 120, ratio: 0.03}, "
      "{frequency_hz: 280, ratio: 0.06}]}");
  double along_alpha = 0.0;
  double along_beta = 0.0;
  for (const auto& [hz, measured] : {std::pair{50.0, 0.05}, {120.0, 0.03}, {280.0, 0.06}}) {
    const double omega = 2.0 * M_PI * hz;
    const double left =
        0.5 * (off["alpha_per_s"].get<double>() / omega + off["beta_s"].get<double>() * omega) -
        measured;
    along_alpha += left / omega;
    along_beta += left * omega;
  }
  CHECK(along_alpha == Approx(0.0).margin(1e-12));
  CHECK(along_beta == Approx(0.0).margin(1e-8));
}

TEST_CASE("modes and frames of a plate are drawn, one panel each", "[end_to_end]") {
  const TempDirectory directory;
  const auto modes = testing::tapstudy({"modes", paper("discrimination.yaml"), "--stimulus",
                                        "acrylic_two", "--figure", directory / "modes.svg"});
  REQUIRE(modes.exit_code == 0);
  const std::string drawn = testing::contents(directory / "modes.svg");
  const auto listed =
      nlohmann::json::parse(testing::tapstudy({"modes", paper("discrimination.yaml"), "--stimulus",
                                               "acrylic_two", "--json"})
                                .standard_output);
  int mode = 0;
  for (const double frequency_hz : listed["frequencies_hz"]) {
    CHECK_THAT(drawn, Contains(fmt::format("{}: {:.1f} Hz", ++mode, frequency_hz)));
  }
  CHECK(mode == 3);
  CHECK_THAT(drawn, Contains("</svg>"));
  const auto tap =
      testing::tapstudy({"tap", paper("discrimination.yaml"), "--stimulus", "acrylic_two", "--at",
                         "P3", "--frames", directory / "frames.svg"});
  REQUIRE(tap.exit_code == 0);
  const std::string frames = testing::contents(directory / "frames.svg");
  CHECK_THAT(frames, Contains("1.0 ms") && Contains("12.0 ms") && Contains("</svg>"));
  for (const auto& line : std::vector<std::vector<std::string>>{
           {"modes", study_on_a_surface(directory, "fem"), "--stimulus", "finite_elements",
            "--figure", directory / "none.svg"},
           {"tap", paper("reality_vibration.yaml"), "--stimulus", "no_vibration", "--frames",
            directory / "none.svg"}}) {
    const auto refused = testing::tapstudy(line);
    CHECK(refused.exit_code == 2);
    CHECK_FALSE(std::filesystem::exists(directory / "none.svg"));
  }
}

TEST_CASE("every link in the documentation leads somewhere, and every command in it runs",
          "[end_to_end][slow]") {
  const auto result =
      testing::run_program({"/usr/bin/python3", "-B", testing::source("tests/docs/check_docs.py"),
                            "--program", testing::tapstudy_program()});
  INFO(result.standard_output << result.standard_error);
  CHECK(result.exit_code == 0);
}
