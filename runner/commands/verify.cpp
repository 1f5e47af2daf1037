#include <fmt/format.h>

#include <memory>
#include <set>

#include "results/journal.hpp"
#include "results/store.hpp"
#include "results/store_error.hpp"
#include "runner/commands/commands.hpp"
namespace tapstudy::runner {
namespace {
struct VerifyOptions {
  std::string directory;
};

std::set<std::string> lines_of(const results::JournalEntries& entries) {
  const std::vector<std::string> lines = results::to_lines(entries);
  return {lines.begin(), lines.end()};
}

// How many of these lines the others lack; prints the first few.
int print_missing(const std::set<std::string>& lines, const std::set<std::string>& others,
                  const char* where) {
  constexpr int max_printed = 5;
  int missing = 0;
  for (const std::string& line : lines) {
    if (!others.contains(line) && ++missing <= max_printed) {
      fmt::print("not in {}: {}\n", where, line);
    }
  }
  return missing;
}

void verify(const VerifyOptions& options) {
  results::Store store = results::Store::open_existing(options.directory);
  std::int64_t ticks = 0;
  const std::vector<std::int64_t> trials = store.trials();
  for (const std::int64_t trial : trials) {
    ticks += static_cast<std::int64_t>(store.trace(trial).size());
  }
  const results::JournalEntries in_store = store.entries_for_journal();
  fmt::print("study.db         {} trials, {} answers, {} ticks: sound\n", trials.size(),
             in_store.answers.size(), ticks);
  const results::JournalEntries in_journal = results::read_journal(options.directory).entries;
  fmt::print("answers.journal  {} answers: every line follows from the one before\n",
             in_journal.answers.size());
  const auto stored = lines_of(in_store);
  const auto journalled = lines_of(in_journal);
  const int missing = print_missing(stored, journalled, "answers.journal") +
                      print_missing(journalled, stored, "study.db");
  if (missing > 0) {
    throw results::StoreError{fmt::format("{}: {} answers or actions are not the same in both",
                                          options.directory, missing)};
  }
  fmt::print("the two agree\n");
}
}  // namespace

void add_verify(CommandParser& line) {
  Command command =
      line.add("verify", "Check a study's database, its traces and its journal of answers");
  const auto options = std::make_shared<VerifyOptions>();
  command.argument("directory", options->directory, "Directory of a study", Need::required);
  command.on_run([options] { verify(*options); });
}
}  // namespace tapstudy::runner
