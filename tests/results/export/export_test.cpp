// A study as tidy tables: what other programs read of them is what is in the store.
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "results/export/bids_files.hpp"
#include "results/export/csv_file.hpp"
#include "results/export/table.hpp"
#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/stored_study.hpp"
using namespace tapstudy;
using namespace tapstudy::results;
using testing::TempDirectory;
namespace fs = std::filesystem;
namespace messy = testing::messy_study;

namespace {
std::string csv_of(const std::vector<Row>& rows) {
  std::ostringstream out;
  write_csv(out, table_of("t", "", {{"a", CellType::text, "", ""}}, rows));
  return out.str();
}
std::string sql(const std::string& study, const std::string& query) {
  return testing::run_program({"/usr/bin/sqlite3", study + "/study.db", query}).standard_output;
}
}  // namespace

TEST_CASE("pandas and R read of an export what sqlite3 reads of the study",
          "[results][export][slow]") {
  const TempDirectory directory;
  const std::string study = messy::make(directory);
  const auto exported =
      testing::tapstudy({"export", study, "--out", directory / "out", "--traces"});
  INFO(exported.standard_error);
  REQUIRE(exported.exit_code == 0);
  const auto read = testing::run_program({"/usr/bin/python3",
                                          testing::source("tests/results/export/csv_reader.py"),
                                          study, directory / "out"});
  INFO(read.standard_error);
  CHECK(read.exit_code == 0);
  CHECK_THAT(read.standard_output, Contains("questionnaires 4"));
  CHECK(testing::contents(directory / "out/protocol.yaml") ==
        testing::contents(testing::source("tests/data/every_screen.yaml")));
  CHECK(testing::entries(directory / "out/traces") ==
        std::stoul(sql(study, "SELECT count(DISTINCT trial_id) FROM trace_chunk")));
}

TEST_CASE("the documented reader of traces reads sample by sample what is exported",
          "[results][export]") {
  const TempDirectory directory;
  const std::string study = messy::make(directory);
  REQUIRE(testing::tapstudy({"export", study, "--out", directory / "out", "--traces"}).exit_code ==
          0);
  const auto read = testing::run_program({"/usr/bin/python3",
                                          testing::source("tests/results/export/traces_match.py"),
                                          study, directory / "out"});
  INFO(read.standard_error);
  CHECK(read.exit_code == 0);
  CHECK(read.standard_output == sql(study,
                                    "SELECT count(DISTINCT trial_id) || ' trials ' || sum(ticks) "
                                    "|| ' ticks' FROM trace_chunk"));
}

TEST_CASE("views say who was excluded, and which answers were corrected", "[results][export]") {
  const TempDirectory directory;
  const std::string study = messy::make(directory);
  CHECK(sql(study,
            "SELECT DISTINCT mode, participant_id, exclusion_reason FROM v_sessions "
            "WHERE is_excluded") == "pilot|P02|left, \"early\"\n");
  CHECK(sql(study,
            "SELECT number, response, is_correct, first_response, given_by FROM v_trials "
            "WHERE is_corrected") == "3|ringing|0|" + messy::formula + "|operator\n");
  CHECK(sql(study,
            "SELECT number, response, is_current FROM v_answers WHERE number = 3 AND "
            "mode = 'real' ORDER BY response_id") == "3|" + messy::formula + "|0\n3|ringing|1\n");
  // 0 to 0.5 s, 0.9 s to the trial's end at 2 s; 0.5 to 0.9 s
  CHECK(sql(study,
            "SELECT position, visits, round(total_dwell_s, 9) FROM v_stimuli "
            "WHERE mode = 'pilot'") == "0|2|1.6\n1|1|0.4\n");
}

TEST_CASE("text is quoted and guarded where it must be, and else never changed",
          "[results][export]") {
  CHECK(csv_of({{std::string{"=cmd()"}}, {std::string{"-3"}}}) == "a\n'=cmd()\n-3\n");
  CHECK(csv_of({{std::string{"a,\"b\"\r\n"}}}) == "a\n\"a,\"\"b\"\"\r\n\"\n");
  CHECK(csv_of({{std::string{}}, {std::monostate{}}}) == "a\n\"\"\nNA\n");
  CHECK(csv_of({{std::nan("")}, {0.1 + 0.2}, {-HUGE_VAL}}) == "a\nNA\n0.30000000000000004\n-INF\n");
}

TEST_CASE("a column's name ends with its unit, and each is described once", "[results][export]") {
  const std::map<std::string, std::string> endings{
      {"s", "_s"}, {"ns", "_ns"}, {"m", "_m"},   {"m/s", "_m_s"},        {"N", "_n"},
      {"V", "_v"}, {"Hz", "_hz"}, {"Pa", "_pa"}, {"kg/m3", "_kg_per_m3"}};
  std::set<std::string> names;
  for (const Column& column : all_known_columns()) {
    CAPTURE(column.name);
    CHECK(names.insert(column.name).second);
    CHECK(column.description.size() > 3);
    if (!column.unit.empty()) {
      REQUIRE(endings.contains(column.unit));
      CHECK(column.name.ends_with(endings.at(column.unit)));
      CHECK(column.type != CellType::text);
    }
  }
}

TEST_CASE("an export that cannot be made says why and leaves nothing", "[results][export]") {
  const TempDirectory directory;
  const std::string study = messy::make(directory);
  const auto refused = [&](const std::string& from, const std::string& out,
                           const std::string& message) {
    const auto before = testing::entries(directory.path());
    const auto run = testing::tapstudy({"export", from, "--out", out, "--traces"});
    CHECK(run.exit_code != 0);
    CHECK_THAT(run.standard_error, Contains(message));
    CHECK(std::ranges::count(run.standard_error, '\n') <= 1);
    CHECK(run.standard_output.empty());
    CHECK(testing::entries(directory.path()) == before);
  };
  fs::create_directory(directory / "there");
  refused(directory / "nowhere", directory / "out", "there is no study here");
  refused(directory / "there", directory / "out", "there is no study here");
  refused(study, directory / "there", "exists already");
  refused(study, "/proc/out", "/proc/out: cannot be made");
  refused(study, directory / "no/out", "there is no directory");
  { Store::open_or_create(directory / "empty", testing::small_study::study); }
  refused(directory / "empty", directory / "out", "holds no answers");
}

// A write beyond the limit fails, as on a full disk.
TEST_CASE("on a full disk an export leaves nothing behind", "[results][export]") {
  const TempDirectory directory;
  const std::string study = messy::make(directory);
  const auto before = testing::entries(directory.path());
  rlimit usual{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &usual) == 0);
  const rlimit lowered{100'000, usual.rlim_max};
  setrlimit(RLIMIT_FSIZE, &lowered);
  const auto run = testing::tapstudy({"export", study, "--out", directory / "out", "--traces"});
  setrlimit(RLIMIT_FSIZE, &usual);
  CHECK(run.exit_code == 5);
  CHECK_THAT(run.standard_error, Contains("is the disk full?"));
  CHECK(testing::entries(directory.path()) == before);
}

// A study as a dataset of the Brain Imaging Data Structure.
namespace {
std::string dataset_of(const TempDirectory& directory, const std::string& study) {
  const std::string dataset = directory / "dataset";
  const auto run = testing::tapstudy({"export", study, "--format", "bids", "--out", dataset});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  return dataset;
}
}  // namespace

TEST_CASE("the public validator of BIDS finds no error in an export", "[results][export]") {
  const TempDirectory directory;
  const std::string dataset = dataset_of(directory, messy::make(directory));
  const char* const validator = std::getenv("BIDS_VALIDATOR");
  if (validator == nullptr) {
    WARN("NOT TESTED: BIDS_VALIDATOR names no program (npm install bids-validator@1)");
    return;
  }
  const auto run = testing::run_program({validator, dataset, "--json"});
  INFO(run.standard_output << run.standard_error);
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.standard_output, Contains("\"errors\":[]"));
  fs::remove(dataset + "/dataset_description.json");  // what it says of a broken one
  CHECK(testing::run_program({validator, dataset, "--json"}).exit_code != 0);
}

TEST_CASE("pandas reads of a BIDS dataset what is in the store", "[results][export]") {
  const TempDirectory directory;
  const std::string study = messy::make(directory);
  const auto read = testing::run_program({"/usr/bin/python3",
                                          testing::source("tests/results/export/bids_reader.py"),
                                          study, dataset_of(directory, study)});
  INFO(read.standard_error);
  CHECK(read.exit_code == 0);
  CHECK_THAT(read.standard_output, Contains("recordings"));
  CHECK_THAT(read.standard_output, !Contains(" 0 answers") && !Contains(" 0 events"));
}

TEST_CASE("names of people and what they wrote stay out of a BIDS dataset", "[results][export]") {
  const TempDirectory directory;
  const std::string dataset = dataset_of(directory, messy::make(directory));
  CHECK(fs::is_directory(dataset + "/sub-p01"));
  for (const std::string& removed :
       {std::string{"Anna"}, std::string{"early"}, std::string{"say \"hi\""}}) {
    const auto found = testing::run_program({"/bin/grep", "-rlF", removed, dataset});
    CHECK(found.standard_output.empty());
  }
}

TEST_CASE("labels are letters and digits, and never the same twice", "[results][export]") {
  const BidsLabels labels = bids_labels({"P-01", "P01", "p_01", "Anna M.", "\xC3\xA4", "--"}, "x");
  CHECK(labels.by_name.at("P-01") == "P01");
  CHECK(labels.by_name.at("P01") == "P01x2");
  CHECK(labels.by_name.at("p_01") == "p01x3");
  CHECK(labels.by_name.at("Anna M.") == "x01");
  CHECK(labels.by_name.at("\xC3\xA4") == "x02");
  CHECK(labels.by_name.at("--") == "x03");
  REQUIRE(labels.notes.size() == 2);
  CHECK(bids_labels({"a", "b"}, "x").notes.empty());
}

TEST_CASE("a BIDS dataset says all that a trial presented, with what varied", "[results][export]") {
  const TempDirectory directory;
  REQUIRE(testing::tapstudy({"simulate", testing::shipped("examples/stiffness_jnd.yaml").string(),
                             "--participants", "1", "--no-traces", "--out", directory / "study"})
              .exit_code == 0);
  const std::string dataset = dataset_of(directory, directory / "study");
  const std::string trials =
      testing::contents(dataset + "/sub-sim01/beh/sub-sim01_task-stiffness_beh.tsv");
  CHECK_THAT(trials, Contains("plate (youngs_modulus_pa=3.2e+09); plate* (youngs_modulus_pa=") &&
                         Contains("plate* (youngs_modulus_pa=") &&
                         Contains("; plate (youngs_modulus_pa=3.2e+09)"));
}

// A study as one HDF5 file.
using Catch::Matchers::EndsWith;

namespace {
testing::ProgramResult export_hdf5(const std::string& study, const std::string& out) {
  return testing::tapstudy({"export", study, "--format", "hdf5", "--out", out});
}
}  // namespace

TEST_CASE("h5py reads of an export what sqlite3 reads of the study, traces to the bit",
          "[results][export]") {
  const TempDirectory directory;
  const std::string study = messy::make(directory);
  const auto exported = export_hdf5(study, directory / "out.h5");
  INFO(exported.standard_error);
  REQUIRE(exported.exit_code == 0);
  const auto read = testing::run_program({"/usr/bin/python3",
                                          testing::source("tests/results/export/hdf5_reader.py"),
                                          study, directory / "out.h5"});
  INFO(read.standard_error);
  CHECK(read.exit_code == 0);
  CHECK_THAT(read.standard_output, Contains("8 bytes a number"));
  CHECK(export_hdf5(study, directory / "again.h5").exit_code == 0);
  CHECK(testing::contents(directory / "out.h5") == testing::contents(directory / "again.h5"));
  CHECK(fs::file_size(directory / "out.h5") <= fs::file_size(study + "/study.db"));
}

TEST_CASE("an HDF5 file is there whole or not at all", "[results][export]") {
  const TempDirectory directory;
  const std::string study = messy::make(directory);
  testing::write(directory / "there.h5", "mine");
  CHECK_THAT(export_hdf5(study, directory / "there.h5").standard_error, Contains("exists already"));
  CHECK(testing::contents(directory / "there.h5") == "mine");
  REQUIRE(export_hdf5(study, directory / "whole.h5").exit_code == 0);
  const auto whole = static_cast<int>(fs::file_size(directory / "whole.h5") / 512);
  for (const int blocks : {0, 10, 100, whole / 2, whole - 1}) {  // of 512 bytes: a full disk
    CAPTURE(blocks);
    const auto run = testing::run_program(
        {"/bin/sh", "-c",
         "{ (ulimit -f " + std::to_string(blocks) + "; exec \"$@\" 2>&1); echo code $?; } | cat",
         "sh", testing::tapstudy_program(), "export", study, "--format", "hdf5", "--out",
         directory / "out.h5"});
    // with no room at all the file cannot be opened
    const char* const code = blocks == 0 ? "code 2\n" : "code 5\n";
    CHECK_THAT(run.standard_output, Contains("out.h5") && EndsWith(code));
    CHECK_THAT(run.standard_output, Contains("cannot be written") || Contains("disk full"));
    CHECK(testing::entries(directory.path()) == 3);
  }
}
