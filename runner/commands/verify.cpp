#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <set>

#include "core/error.hpp"
#include "protocols/protocol.hpp"
#include "results/journal_heads.hpp"
#include "results/recomputation.hpp"
#include "results/store.hpp"
#include "results/store_error.hpp"
#include "runner/commands/commands.hpp"
#include "runner/experiments/published_report.hpp"
#include "runner/experiments/stored_protocol.hpp"
#include "runner/experiments/stored_trial.hpp"
#include "runner/terminal/logging.hpp"
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

// Of a protocol that is not one of this version, no block is known.
results::TaskRule rule_of(const results::StudyRow& study) {
  auto protocol = std::make_shared<protocols::Protocol>();
  try {
    *protocol = stored_protocol(study);
  } catch (const core::InvalidInput&) {
    warn("the study's protocol cannot be read by this version");
  }
  const auto block_of = [protocol](const results::TrialRow& trial) {
    const auto found = std::ranges::find(protocol->blocks, trial.block, &protocols::Block::name);
    return found == protocol->blocks.end() ? nullptr : &*found;
  };
  return {[block_of](const results::TrialRow& trial) { return block_of(trial) != nullptr; },
          [block_of](const results::TrialRow& trial,
                     const std::vector<results::AlternativeRow>& alternatives,
                     const std::string& response) {
            const protocols::Block& block = *block_of(trial);
            return block.task->is_correct(stored_trial(trial, alternatives, block), block,
                                          response);
          }};
}

// What is wrong, or empty.
std::string print_recomputed(const results::Recomputation& recomputed) {
  constexpr std::size_t max_printed = 20;
  const auto& differences = recomputed.differences;
  for (std::size_t i = 0; i < std::min(differences.size(), max_printed); ++i) {
    fmt::print("differs: {}\n", differences[i]);
  }
  fmt::print("recomputed       {} events from their traces, {} answers by their task's rule{}\n",
             recomputed.events, recomputed.answers,
             recomputed.unknown_blocks == 0 ? ""
                                            : fmt::format(" ({} of blocks that the protocol lacks)",
                                                          recomputed.unknown_blocks));
  return differences.empty() ? ""
                             : fmt::format("stored values that differ from those recomputed: {}",
                                           differences.size());
}

// What is wrong, or empty.
std::string print_heads(const std::vector<std::string>& differences) {
  for (const std::string& difference : differences) {
    fmt::print("differs: {}\n", difference);
  }
  return differences.empty() ? ""
                             : fmt::format("rows of the study and its sessions that differ: {}",
                                           differences.size());
}

// The journal against the database: what is wrong, or empty.
std::string print_compared(const results::JournalEntries& in_store,
                           const results::JournalEntries& in_journal) {
  fmt::print("answers.journal  {} answers: hash chain intact\n", in_journal.answers.size());
  const auto stored = lines_of(in_store);
  const auto journalled = lines_of(in_journal);
  const int missing = print_missing(stored, journalled, "answers.journal") +
                      print_missing(journalled, stored, "study.db");
  if (missing > 0) {
    return fmt::format("answers or actions that are not the same in both: {}", missing);
  }
  fmt::print("their answers and actions agree\n");
  return "";
}

// What is wrong, or empty.
std::string print_published(const PublishedReport& report) {
  if (!report.is_there) {
    return "";
  }
  if (!report.not_compared.empty()) {
    fmt::print("report.json      not compared: {}\n", report.not_compared);
    return "";
  }
  constexpr std::size_t max_printed = 20;
  for (std::size_t i = 0; i < std::min(report.differences.size(), max_printed); ++i) {
    fmt::print("differs: {}\n", report.differences[i]);
  }
  if (report.differences.empty()) {
    fmt::print("report.json      its tables and page: identical to a regenerated report\n");
    return "";
  }
  return fmt::format("places where its report differs from a regenerated one (is it older?): {}",
                     report.differences.size());
}

void verify(const VerifyOptions& options) {
  results::Store store = results::Store::open_existing(options.directory);
  const results::Recomputation recomputed = results::recompute(store, rule_of(store.study()));
  const results::JournalEntries in_store = store.entries_for_journal();
  fmt::print("study.db         {} trials, {} answers, {} ticks: sound\n", store.trials().size(),
             in_store.answers.size(), recomputed.ticks);
  const results::JournalContent journal = results::read_journal(options.directory);
  std::vector<std::string> wrong{
      print_recomputed(recomputed),
      print_heads(results::differing_study_and_sessions(store.study(), store.sessions(), journal)),
      print_compared(in_store, journal.entries)};
  std::erase(wrong, "");
  if (wrong.empty()) {  // else a report made anew would be wrong, too
    wrong.push_back(print_published(published_report(options.directory, store)));
    std::erase(wrong, "");
  }
  if (!wrong.empty()) {
    throw results::StoreError{fmt::format("{}: {}", options.directory, fmt::join(wrong, "; "))};
  }
}
}  // namespace

void add_verify(CommandParser& line) {
  Command command = line.add(
      "verify",
      "Check a study's database, its traces and its journal of answers, and recompute what "
      "follows from them");
  const auto options = std::make_shared<VerifyOptions>();
  command.argument("directory", options->directory, "Directory of a study", Need::required);
  command.on_run([options] { verify(*options); });
}
}  // namespace tapstudy::runner
