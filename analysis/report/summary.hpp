#pragma once
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/report/answer_tables/answer_table.hpp"
#include "analysis/report/document/block_summary.hpp"
#include "analysis/report/document/sections.hpp"
namespace tapstudy::analysis {
struct LoopQuality {
  std::int64_t ticks{};
  std::int64_t late{};
  std::int64_t skipped{};
  std::int64_t dropped_samples{};
  std::int64_t impacts{};
  std::int64_t late_impacts{};
};

struct Summary {
  std::string title;
  std::string notes;
  std::set<std::string> modes;  // results::Mode; also "counts" or "answers" if it is of a table
  std::vector<std::string> unfinished;  // sessions, with what was answered of what was planned
  std::vector<std::string> excluded;    // participants, with the operator's reason
  std::vector<std::string> deviations;  // what was not as planned, or is left out
  int participants{};
  std::set<std::string> participant_ids{};  // where they are known
  std::vector<std::shared_ptr<const BlockSummary>> blocks;
  std::vector<ReportSection> sections;  // of the study as a whole
  std::optional<LoopQuality> loop;
  std::vector<std::pair<std::string, std::string>> provenance;
  CitingText stated_methods{};  // in place of what methods() would say
  CitingText procedure{};       // how the study was run, in sentences; methods() begins with it
};

// What a report needs besides answers and visits; all of it may be unknown.
struct Presentations {
  std::vector<VisitOrder> orders{};
  std::map<std::string, int> missing_replies{};  // by block
};

// All contents of a report, computed from the stored rows.
Summary summarise(const StudyDesign& design, const std::vector<results::AnswerRow>& answers,
                  const std::vector<results::VisitRow>& visits,
                  const Presentations& presentations = {});
// From a matrix alone, participants unknown; `task` is the one that such a matrix comes from.
Summary summarise(const ConfusionMatrix& matrix, const std::string& title, std::string_view task,
                  const std::set<std::string>& modes = {});
// From somebody else's table; without participants it is summarised as its matrix.
Summary summarise(const AnswerTable& table, const std::string& title, std::string_view task,
                  const std::set<std::string>& modes = {});

// Whose answers these are, in words: "pilot, real".
std::string words_of_modes(const Summary& summary);
// What must stand above everything else where the participants are not those of a study; or empty.
std::string banner(const Summary& summary);
// A paragraph on how the numbers were computed, for a methods section.
CitingText methods(const Summary& summary);

// How many tests the report holds, and how they are adjusted for their number, in a sentence; empty
// where there are none.
std::string tests_in_words(const Summary& summary);

// Throws InvalidInput for a name that is none of the parts that a report can have, with these.
void check_are_parts(const std::vector<std::string>& names, const std::vector<std::string>& parts);
// Leaves out of a report all blocks and sections but those named. What a report must say anyway,
// whose data these are and what was not as planned, stays.
// Throws InvalidInput for a name that is none, with those that there are.
void keep_only(Summary& summary, const std::vector<std::string>& names);
}  // namespace tapstudy::analysis
