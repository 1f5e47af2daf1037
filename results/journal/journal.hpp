#pragma once
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "results/rows.hpp"
namespace tapstudy::results {
// An answered trial without its traces and events.
struct JournalledAnswer {
  TrialRow trial;
  std::vector<AlternativeRow> alternatives;
  ResponseRow response;
};

// The entries of a journal that concern trials. Each of them is a line.
struct JournalEntries {
  std::vector<JournalledAnswer> answers{};  // as first given
  std::vector<CorrectionRow> corrections{};
  std::vector<OperatorActionRow> actions{};
  std::vector<FormAnswerRow> form_answers{};
};

std::string journal_file(const std::string& directory);

// DIR/answers.journal: a second record of what was answered and of what the operator did, in plain
// text, in case the database is lost. Only ever appended to, each line flushed to the disk before
// anybody is told that it is there, whoever wrote it: one JSON object a line, the study first (with
// its protocol and surfaces), each session before its answers. Each line ends with
//   "chain":"SHA-256 of the previous line's chain and of this line up to here"
// so that a line that was changed, removed or inserted is noticed. Several programs may append at
// once. A half line at the end, left by a power failure, was never confirmed and is cut off.
class Journal {
 public:
  explicit Journal(const std::string& directory) : file_{journal_file(directory)} {}
  enum class Flush { each_time, when_asked };
  void set_flush(Flush flush) { flush_ = flush; }
  // Throws StoreError if it cannot be written.
  void flush();
  // Appends what it does not hold yet; the study is asked for if it is new. Throws StoreError if it
  // cannot be written: its end is then as it was before, or, where the line cannot be cut off or is
  // not known to be on the disk, the next call writes and flushes it again. False: nothing was
  // appended, since lines that it once held are gone, with its file or its end; the next call
  // begins with what is left.
  bool complete(const std::function<StudyRow()>& study, const std::vector<SessionRow>& sessions,
                const JournalEntries& entries);
  // Whether the session's line has been completed, and none has gone since: a row that holds the
  // whole planned order need not be read for each answer.
  bool holds_session(std::int64_t session_id) const { return session_ids_.contains(session_id); }

 private:
  bool read_appended(int descriptor);  // false: it is another file now
  std::string chained(const std::string& body);
  void flush(int descriptor);
  void write_again(int descriptor);  // what is not known to be on the disk
  std::string file_;
  Flush flush_{Flush::each_time};
  std::set<std::string> known_;  // lines without their chain
  std::set<std::int64_t> session_ids_;
  std::string chain_;  // of the last line known
  std::int64_t read_bytes_{0};
  std::int64_t flushed_bytes_{0};  // of these, known to be on the disk
  bool flush_failed_{false};
};

// The content of a study's journal. Reading throws StoreError with file and line where the chain is
// broken or a line is invalid.
struct JournalContent {
  StudyRow study;
  std::vector<SessionRow> sessions;
  JournalEntries entries;
};
JournalContent read_journal(const std::string& directory);

// Whose a journal is and how much it holds, also where its chain is broken.
struct JournalSummary {
  bool has_lines{false};             // whole ones: a half line was never confirmed
  std::size_t answers{0};            // to trials
  std::string protocol_sha256;       // empty: it does not begin with a study
  std::vector<SessionRow> sessions;  // their ids, participants, seeds and starts
};
JournalSummary summary_of_journal(const std::string& directory);
// Ends a sentence about a database that is lost or damaged: how to read the answers in the journal
// beside it. Empty where that one holds nothing.
std::string where_answers_are(const std::string& database_file);

// One text per entry, equal if and only if the entries are, kind by kind.
std::vector<std::string> to_lines(const JournalEntries& entries);

// A line of a journal: a JSON object without its chain, and the chain.
struct JournalLine {
  std::string body;
  std::string chain;  // empty where the line has none
};
JournalLine split_line(const std::string& line);
std::string join_line(const JournalLine& line);
std::string chain_of(const std::string& chain_before, const std::string& body);

// Bodies.
std::string to_line(const StudyRow& study);
std::string to_line(const SessionRow& session);

// The differences between database and journal in study and sessions (the protocol and its hash,
// modes, seeds, orders, devices …), a line each; answers are not compared.
std::vector<std::string> differing_study_and_sessions(const StudyRow& study,
                                                      const std::vector<SessionRow>& sessions,
                                                      const JournalContent& journal);
}  // namespace tapstudy::results
