#pragma once
#include <istream>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/report/answer_tables/answer_columns.hpp"
#include "analysis/statistics/confusion_matrix.hpp"
#include "analysis/statistics/csv_rows.hpp"
#include "results/rows.hpp"
namespace tapstudy::analysis {
// The values of one column. Neighbours are mostly equal.
std::set<std::string> distinct(const std::vector<results::AnswerRow>& answers,
                               std::string results::AnswerRow::*column);

// Throws InvalidInput, with the file, where two stimuli, responses or participants read alike
// (as_read()), and where no answer names a stimulus.
void check_names(const std::vector<results::AnswerRow>& answers, const std::string& file,
                 const std::set<std::string>& stimuli, const std::set<std::string>& responses);

struct AnswerReading {
  AnswerColumns columns{};
  std::vector<RowCondition> conditions{};  // rows that fail one are other trials
  // What answers stand for, "1" for acrylic; an answer for itself is one that is no stimulus.
  std::map<std::string, std::string> responses{};
  bool merges_alike{false};          // names that read alike are one, the first of them
  bool pools_runs{false};            // of one participant
  bool pools_tasks{false};           // that a column names
  bool counts_practice{false};       // rows that a column calls practice are answers like others
  bool are_counts{false};            // also what looks like percentages, or like sums of others
  std::vector<std::string> order{};  // of stimuli and responses; empty: as they first appear
};

// One answer a row, of one question with one right answer: the stimulus's own name.
struct AnswerTable {
  std::vector<results::AnswerRow> answers;  // response_time_s is NaN where it is not known
  std::vector<Item> stimuli;                // in the order asked for, else of first appearance
  std::vector<Item> responses;              // likewise, stimuli first
  std::set<std::string> modes;              // of them, but for real; at most one
  bool are_participants_known{};
  std::size_t rows{};  // that meet the conditions
  // Of these: left out, by what stands in the answer's place ("NA", "timeout", … or "", empty).
  std::map<std::string, std::size_t> unanswered{};
  std::string weight_column{};        // says how many answers a row stands for; empty: one
  std::vector<std::string> merged{};  // "'Oak' is read as 'oak'"
  std::vector<std::string> pooled{};  // participants with several runs
  std::size_t not_counted{};  // of these: tapstudy's own practice, catch trials, excluded people …
  // Rows of other modes than the one reported: real before pilot before simulated.
  std::size_t of_other_modes{};
  bool has_times{};
  // Columns that are called after right answers, but do not say of each whether it is.
  std::set<std::string> not_compared{};
  std::string possible_time{};  // a column that was not read, but may hold times; empty: none
};

struct NamedCsv {
  std::string file;  // also the participant's name, if no column has it and there are several files
  CsvText text;
};
// Participants' answers follow one another as rows and files do. Throws InvalidInput with file:line
// where a column says that some rows are practice (says_practice()), for an answer that is neither
// a stimulus nor one of `responses`, a time that is no number from 0, an answer without a stimulus,
// several blocks of one of tapstudy's own exports, a row with more or fewer cells than the header,
// more than 200 different answers, no answers at all, and as weigh_answers().
AnswerTable read_answers(const std::vector<NamedCsv>& files, const AnswerReading& reading);

// Without the two rows below the header in which Qualtrics repeats the questions and says where
// they come from; with a header above the names of rows, which R's write.table leaves out. Throws
// InvalidInput where a title stands in the header's place.
void settle_header(CsvText& table, const std::string& file);

// Whether the text begins as a list does in JSON. Reads nothing else of it.
bool is_json_list(std::string_view text);
// Throws InvalidInput for a JSON object, and for one in each line, with what makes a list of it.
void check_is_no_json_object(std::string_view text, const std::string& file);

// A list of objects, as jsPsych saves its data, as the table that it would be in CSV: a column for
// each key that any has, a row for each object, numbered as its line. What is null or missing is
// empty; lists within are JSON, and so are objects, whose entries are columns of their own, too
// ("response.Q0"). Several lists, one a line, are runs: the column `run_of_file` counts them.
// Throws InvalidInput with the file for what is no such list and beyond 64 MB.
CsvText read_json_rows(std::istream& text, const std::string& file);
// The one answer in {"Q0": "oak"}, as surveys give it, and in ['oak'], as PsychoPy lists keys and
// what was clicked; any other cell as it is.
std::string only_answer_in(const std::string& cell);
}  // namespace tapstudy::analysis
