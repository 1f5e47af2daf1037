#include "results/journal/journal.hpp"

#include <sys/resource.h>

#include <csignal>
#include <fstream>

#include "results/store_error.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::results;

namespace {
StudyRow empty_study() {
  return {"a study", "study.yaml", "format: tapstudy/1\n", "hash", {{"s.stl", "hash", "solid\n"}}};
}
JournalledAnswer answer(int number, const std::string& response) {
  return {{1, number, 1, "main", "identification", false, 1, results::TrialStatus::answered, 2.0},
          {{0, "A", "one"}, {1, "B", "two"}},
          {response, true, 0.1, std::nullopt}};
}
SessionRow first_session() {
  SessionRow row;
  row.id = 1;
  row.participant_id = "P01";
  row.seed = 0xfedcba9876543210ULL;
  return row;
}
void write_three(const std::string& directory) {
  Journal journal{directory};
  for (int number = 1; number <= 3; ++number) {
    journal.complete(empty_study, {first_session()}, {.answers = {answer(number, "one")}});
  }
}
std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream{text};
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line + "\n");
  }
  return lines;
}
std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) {
    text += line;
  }
  return text;
}
}  // namespace

TEST_CASE("what a journal was told comes back, once each", "[results][journal]") {
  const testing::TempDirectory directory;
  write_three(directory.path());
  Journal{directory.path()}.complete(empty_study, {first_session()},
                                     {.answers = {answer(2, "one")}});  // known already
  const JournalContent content = read_journal(directory.path());
  CHECK(content.study.protocol_text == empty_study().protocol_text);
  CHECK(content.study.surfaces.at(0).bytes == "solid\n");
  REQUIRE(content.sessions.size() == 1);
  CHECK(content.sessions[0].seed == first_session().seed);
  REQUIRE(content.entries.answers.size() == 3);
  CHECK(to_lines({.answers = {content.entries.answers[2]}}) ==
        to_lines({.answers = {answer(3, "one")}}));
}

TEST_CASE("a journal's line that was changed, removed, inserted or moved is noticed",
          "[results][journal]") {
  const testing::TempDirectory directory;
  write_three(directory.path());
  const std::string file = journal_file(directory.path());
  auto lines = lines_of(testing::contents(file));
  REQUIRE(lines.size() == 5);
  SECTION("changed") {
    lines[3] = testing::replaced(lines[3], "\"one\",\"is", "\"two\",\"is");
  }
  SECTION("removed") {
    lines.erase(lines.begin() + 3);
  }
  SECTION("inserted") {
    lines.insert(lines.begin() + 3, lines[2]);
  }
  SECTION("moved") {
    std::swap(lines[3], lines[4]);
  }
  testing::write(file, joined(lines));
  CHECK_THROWS_WITH(read_journal(directory.path()), Contains("answers.journal, line "));
}

TEST_CASE("half a line at a journal's end is cut off, and what it said is said again",
          "[results][journal]") {
  const testing::TempDirectory directory;
  write_three(directory.path());
  const std::string file = journal_file(directory.path());
  const std::string whole = testing::contents(file);
  testing::write(file, whole.substr(0, whole.size() - 20));
  CHECK(read_journal(directory.path()).entries.answers.size() == 2);
  Journal{directory.path()}.complete(empty_study, {}, {.answers = {answer(3, "one")}});
  CHECK(testing::contents(file) == whole);
}

TEST_CASE("several programs append to one journal", "[results][journal]") {
  const testing::TempDirectory directory;
  Journal one{directory.path()};
  Journal other{directory.path()};
  for (int number = 1; number <= 20; number += 2) {
    one.complete(empty_study, {first_session()}, {.answers = {answer(number, "one")}});
    other.complete(empty_study, {first_session()}, {.answers = {answer(number + 1, "two")}});
  }
  CHECK(read_journal(directory.path()).entries.answers.size() == 20);
}

TEST_CASE("a journal that cannot be written ends as it was before", "[results][journal]") {
  const testing::TempDirectory directory;
  write_three(directory.path());
  const std::string before = testing::contents(journal_file(directory.path()));
  Journal journal{directory.path()};
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit tight = limit;
  tight.rlim_cur = before.size() + 20;  // the line is longer
  setrlimit(RLIMIT_FSIZE, &tight);
  CHECK_THROWS_AS(journal.complete(empty_study, {}, {.answers = {answer(4, "one")}}), StoreError);
  setrlimit(RLIMIT_FSIZE, &limit);
  CHECK(testing::contents(journal_file(directory.path())) == before);
  journal.complete(empty_study, {}, {.answers = {answer(4, "one")}});
  CHECK(read_journal(directory.path()).entries.answers.size() == 4);
}
