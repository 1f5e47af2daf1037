// Simulations that are computed in shares, and merged.
#include <algorithm>
#include <filesystem>
#include <map>

#include "core/error.hpp"
#include "core/files/sha256.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "runner/studies/shares/merge.hpp"
#include "runner/studies/simulated_design.hpp"
#include "runner/studies/simulated_study.hpp"
#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
namespace fs = std::filesystem;

namespace {
constexpr int people = 3;

// The hash of every row with its ids, but for the dates: nobody reads how megabytes differ.
std::string hash_of_rows(const std::string& directory) {
  return core::sha256(testing::run_program({"/usr/bin/sqlite3", directory + "/study.db",
                                            "UPDATE session SET started_utc = ''; "
                                            "UPDATE study SET created_utc = '';",
                                            ".dump"})
                          .standard_output);
}

std::string every_task() {
  return testing::source("tests/data/every_task.yaml");
}

void simulate_share(const std::string& directory, const std::string& share,
                    const std::vector<std::string>& further = {}) {
  std::vector<std::string> line{"simulate", every_task(), "--participants", std::to_string(people),
                                "--out",    directory,    "--share",        share};
  line.insert(line.end(), further.begin(), further.end());
  const auto simulated = testing::tapstudy(line);
  INFO(simulated.standard_error);
  REQUIRE(simulated.exit_code == 0);
}

// Their names, the last one first.
std::vector<std::string> simulate_shares(const testing::TempDirectory& in, int of,
                                         const std::vector<std::string>& further = {}) {
  std::vector<std::string> shares;
  for (int number = of; number >= 1; --number) {
    const std::string share = runner::to_text({number, of});
    shares.push_back(in / testing::replaced(share, "/", "of"));
    simulate_share(shares.back(), share, further);
  }
  return shares;
}

testing::ProgramResult merge(std::vector<std::string> shares, const std::string& out = "") {
  shares.insert(shares.begin(), "merge");
  if (!out.empty()) {
    shares.insert(shares.end(), {"--out", out});
  }
  return testing::tapstudy(shares);
}

// Their hashes by name.
std::map<std::string, std::string> files_of_report(std::vector<std::string> directories,
                                                   const std::string& out) {
  directories.insert(directories.begin(), "report");
  directories.insert(directories.end(), {"--out", out, "--only", "comparison,sessions,procedures"});
  const auto reported = testing::tapstudy(directories);
  INFO(reported.standard_error);
  REQUIRE(reported.exit_code == 0);
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator{out}) {
    if (entry.is_regular_file() && entry.path().extension() != ".pdf") {  // which hold the date
      files[fs::relative(entry.path(), out)] = core::sha256(testing::contents(entry.path()));
    }
  }
  return files;
}
}  // namespace

TEST_CASE("merged shares are the store and the report of one run, however many there are",
          "[simulate][shares]") {
  const testing::TempDirectory directory;
  const std::string one_after_the_other = directory / "one";
  runner::simulate({.protocol_file = every_task(),
                    .directory = one_after_the_other,
                    .participants = people,
                    .seed = 1,
                    .threads = 1},
                   protocols::read_protocol(every_task()));
  for (const int of : {2, people}) {
    CAPTURE(of);
    const auto shares = simulate_shares(directory, of);
    const std::string whole = directory / ("whole" + std::to_string(of));
    REQUIRE(merge(shares, whole).exit_code == 0);
    if (of == 2) {
      CHECK(testing::tapstudy({"verify", whole}).exit_code == 0);
      const auto report = files_of_report(shares, directory / "report_of_shares");
      CHECK(report.size() > 5);
      CHECK(report == files_of_report({one_after_the_other}, directory / "report_of_one"));
    }
    CHECK(hash_of_rows(whole) == hash_of_rows(one_after_the_other));
  }
}

TEST_CASE("shares that do not make one simulation are not merged", "[simulate][shares]") {
  const testing::TempDirectory directory;
  const auto shares = simulate_shares(directory, 2, {"--no-traces"});
  const auto refused = [&](const std::vector<std::string>& some, const std::string& why) {
    CAPTURE(why);
    const auto result = merge(some, directory / "whole");
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.standard_error, Contains(why));
    CHECK(std::ranges::count(result.standard_error, '\n') == 1);
    CHECK_FALSE(fs::exists(directory / "whole"));
  };
  refused({shares[0]}, "share 1/2 is not among");
  refused({shares[0], shares[1], shares[0]}, "both hold share 2/2");
  const auto other = [&](const std::vector<std::string>& options, const std::string& why) {
    const std::string made = directory / "other";
    fs::remove_all(made);
    simulate_share(made, "1/2", options);
    refused({shares[0], made}, why);
  };
  other({"--no-traces", "--seed", "9"}, "their seeds differ");
  other({}, "only one of them has traces");
  const std::string copied = directory / "copied";
  fs::copy(shares[1], copied);
  const std::string described = testing::contents(copied + "/share.json");
  const auto change = [&](const std::string& from, const std::string& to) {
    testing::write(copied + "/share.json", testing::replaced(described, from, to));
  };
  change("\"inputs\": \"", "\"inputs\": \"0");
  refused({shares[0], copied}, "their protocols differ");
  change("\"program\": \"", "\"program\": \"0");
  refused({shares[0], copied}, "their versions of tapstudy differ");
  change("\"share\": 1", "\"share\": 2");
  refused({shares[1], copied}, "does not hold the participants of share 2/2");
  fs::remove(copied + "/share.json");
  refused({shares[0], copied}, "is no complete share");
}

TEST_CASE("a complete share is computed once, and a killed one is none", "[simulate][shares]") {
  const testing::TempDirectory directory;
  const std::string share = directory / "share";
  fs::create_directory(share + ".unfinished-1-0");  // left by a killed program
  simulate_share(share, "2/3");
  CHECK_FALSE(fs::exists(share + ".unfinished-1-0"));
  const auto written = fs::last_write_time(share + "/study.db");
  simulate_share(share, "2/3");
  CHECK(fs::last_write_time(share + "/study.db") == written);
  const auto of_another = testing::tapstudy(
      {"simulate", every_task(), "--participants", "3", "--out", share, "--share", "3/3"});
  CHECK(of_another.exit_code == 2);
  CHECK_THAT(of_another.standard_error, Contains("is not this share"));
}

TEST_CASE("shares of a simulated design print together what one run prints", "[simulate][shares]") {
  const testing::TempDirectory directory;
  const std::vector<std::string> line{"check", every_task(),    "--participants",
                                      "3",     "--simulations", "3"};
  const auto whole = testing::tapstudy(line);
  std::vector<std::string> shares;
  for (const char* const share : {"1/2", "2/2"}) {
    shares.push_back(directory / std::to_string(shares.size()));
    std::vector<std::string> of_share = line;
    of_share.insert(of_share.end(), {"--share", share, "--out", shares.back()});
    REQUIRE(testing::tapstudy(of_share).exit_code == 0);
  }
  const auto merged = merge(shares);
  CHECK(merged.exit_code == 0);
  CHECK_THAT(merged.standard_output, Contains("3 simulated studies of 3 participants"));
  CHECK(whole.standard_output.ends_with("\n\n" + merged.standard_output));
  CHECK(std::ranges::count(merged.standard_output, '\n') > 5);
}

TEST_CASE("what is no share, or is more than there are, is refused", "[simulate][shares]") {
  for (const char* const none : {"", "1", "0/3", "4/3", "1/0", "-1/3", "1/2/3", "1/ 2", "a/b"}) {
    CAPTURE(none);
    CHECK_THROWS_AS(runner::share_from(none), core::InvalidInput);
  }
  CHECK_THROWS_AS(runner::part_of({1, 4}, 3, "participants"), core::InvalidInput);
}

TEST_CASE("everybody is in one share, and shares differ in size by one at most",
          "[simulate][shares]") {
  const int of = GENERATE(1, 2, 7, 64, 100);
  int next = 0;
  for (int number = 1; number <= of; ++number) {
    const runner::SharedOut part = runner::part_of({number, of}, 100, "participants");
    CHECK(part.first == next);
    CHECK(part.end - part.first >= 100 / of);
    CHECK(part.end - part.first <= (100 + of - 1) / of);
    next = part.end;
  }
  CHECK(next == 100);
}
