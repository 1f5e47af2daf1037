// A study as tidy tables: what other programs read of them is what is in the store.
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "results/export/columns.hpp"
#include "results/export/csv_file.hpp"
#include "support/catch.hpp"
#include "support/messy_study.hpp"
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

TEST_CASE("text is quoted where it must be and never changed", "[results][export]") {
  CHECK(csv_of({{std::string{"=cmd()"}}}) == "a\n=cmd()\n");
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
  CHECK(run.exit_code != 0);
  CHECK_THAT(run.standard_error, Contains("is the disk full?"));
  CHECK(testing::entries(directory.path()) == before);
}
