#include "runner/studies/table_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include "analysis/report/answer_tables/answer_table.hpp"
#include "analysis/report/answer_tables/counts_csv.hpp"
#include "analysis/report/answer_tables/foreign_text.hpp"
#include "core/error.hpp"
#include "protocols/tasks/task.hpp"
#include "runner/studies/counted.hpp"
namespace tapstudy::runner {
namespace {
using analysis::NamedCsv;
using analysis::Summary;

// A table of tapstudy's BIDS export: who took part, as whom, and whether they were excluded is in
// other files of it.
void check_says_whose(const NamedCsv& table) {
  if (table.text.rows.empty()) {
    return;
  }
  const std::vector<std::string>& header = table.text.rows.front().cells;
  const auto has = [&](const char* column) {
    return std::ranges::find(header, column) != header.end();
  };
  if (has("trial_type") && has("alternatives") && has("is_practice") && has("is_catch") &&
      !has("participant_id")) {
    throw core::InvalidInput{
        fmt::format("{}: is of a BIDS export of tapstudy, whose rows do not say who was simulated "
                    "or excluded: report the study's directory, or trials.csv of its CSV export",
                    table.file)};
  }
}

using LeftOut = std::map<std::string, std::size_t>;  // lines of programs, and of how many files

NamedCsv read_file(const std::string& file, const std::string& encoding, LeftOut& left_out) {
  std::ifstream text{file};
  if (!text) {
    throw core::InvalidInput{file + ": cannot be read"};
  }
  std::string bytes = analysis::utf8_of(analysis::table_text(text, file), encoding, file);
  for (const std::string& line : analysis::without_lines_of_programs(bytes)) {
    ++left_out[line];
  }
  const bool is_json = analysis::is_json_list(bytes);
  analysis::check_is_no_json_object(bytes, file);
  std::istringstream whole{std::move(bytes)};
  NamedCsv table{file,
                 is_json ? analysis::read_json_rows(whole, file) : analysis::read_csv(whole, file)};
  analysis::settle_header(table.text, file);
  check_says_whose(table);
  return table;
}

std::pair<std::string, std::string> split(const std::string& text) {
  const std::size_t equals = text.find('=');
  return equals == std::string::npos ? std::pair{text, text}
                                     : std::pair{text.substr(0, equals), text.substr(equals + 1)};
}

analysis::AnswerReading reading_of(const TableOptions& options) {
  analysis::AnswerReading reading;
  reading.columns = options.columns;
  for (const std::string& condition : options.conditions) {
    if (condition.find('=') == std::string::npos) {
      throw core::InvalidInput{
          fmt::format("--where: '{}' is not of the form COLUMN=VALUE or COLUMN!=VALUE", condition)};
    }
    auto [column, value] = split(condition);
    const bool is_excluded = column.ends_with('!');
    if (is_excluded) {
      column.pop_back();
    }
    reading.conditions.push_back({column, value, is_excluded});
  }
  reading.order = options.order;
  reading.merges_alike = options.merges_alike;
  reading.pools_runs = options.pools_runs;
  reading.pools_tasks = options.pools_tasks;
  reading.counts_practice = options.counts_practice;
  reading.are_counts = options.are_counts;
  for (const std::string& response : options.responses) {
    const auto [given, meaning] = split(response);
    const auto [known, is_new] = reading.responses.emplace(given, meaning);
    if (!is_new && known->second != meaning) {
      throw core::InvalidInput{fmt::format("--responses: '{}' stands for '{}' and for '{}'", given,
                                           known->second, meaning)};
    }
  }
  return reading;
}

// Adds the modes that the comments of the tables name.
std::set<std::string> modes_of(const std::vector<NamedCsv>& tables,
                               std::set<std::string> modes = {}) {
  for (const NamedCsv& table : tables) {
    modes.merge(analysis::modes_in(table.text));
  }
  return modes;
}

bool hold_answers(const std::vector<NamedCsv>& tables, const TableOptions& options) {
  if (options.rows) {
    return false;
  }
  return tables.size() > 1 || options.columns.are_given() || !options.conditions.empty() ||
         (!tables.front().text.rows.empty() &&
          analysis::has_answers(tables.front().text.rows.front().cells));
}

void check_differ(const std::vector<NamedCsv>& tables) {
  const auto is_same_row = [](const analysis::CsvRow& one, const analysis::CsvRow& other) {
    return one.cells == other.cells;
  };
  for (auto one = tables.begin(); one != tables.end(); ++one) {
    for (auto other = std::next(one); other != tables.end(); ++other) {
      if (std::ranges::equal(one->text.rows, other->text.rows, is_same_row)) {
        throw core::InvalidInput{
            fmt::format("{}: holds the same rows as {}", other->file, one->file)};
      }
    }
  }
}

void add_unanswered(const analysis::AnswerTable& table, Summary& summary) {
  std::size_t all = 0;
  std::vector<std::string> kinds;
  for (const auto& [cell, count] : table.unanswered) {
    all += count;
    kinds.push_back(fmt::format("{} '{}'", count, cell));
  }
  if (all > 0) {
    summary.deviations.push_back(fmt::format("{} of {} rows have no answer and are left out: {}",
                                             all, table.rows, fmt::join(kinds, ", ")));
  }
}

Summary summary_of_answers(const std::vector<NamedCsv>& tables, const TableOptions& options,
                           const std::string& title) {
  const analysis::AnswerTable table = analysis::read_answers(tables, reading_of(options));
  Summary summary = analysis::summarise(table, title, protocols::identification().name(),
                                        modes_of(tables, table.modes));
  add_unanswered(table, summary);
  if (!table.weight_column.empty()) {
    summary.deviations.push_back(
        fmt::format("rows count as often as column '{}' says: {} rows are {} answers",
                    table.weight_column, table.rows, table.answers.size()));
  }
  std::ranges::copy(table.merged, std::back_inserter(summary.deviations));
  for (const std::string& column : table.not_compared) {
    summary.deviations.push_back(
        fmt::format("column '{}' is not compared with the names of stimuli and answers: it does "
                    "not say of each answer whether it is right",
                    column));
  }
  if (!table.pooled.empty()) {
    summary.deviations.push_back(
        fmt::format("several runs are pooled of participants {}", fmt::join(table.pooled, ", ")));
  }
  if (table.not_counted > 0) {
    summary.deviations.push_back(
        fmt::format("{} of {} rows are left out: practice, catch trials, answers that were "
                    "corrected, trials without an answer, or participants who are excluded",
                    table.not_counted, table.rows));
  }
  if (table.of_other_modes > 0) {
    summary.deviations.push_back(
        fmt::format("{} of {} rows are left out: of pilot or simulated sessions, which are no part "
                    "of the study",
                    table.of_other_modes, table.rows));
  }
  if (table.has_times && !table.are_participants_known) {
    summary.deviations.emplace_back(
        "times are not summarised: participants are not known (--participant-column)");
  }
  if (!table.possible_time.empty()) {
    summary.deviations.push_back(fmt::format(
        "column '{0}' is not read: if it holds response times, --time-column {0} and --time-unit "
        "say so",
        table.possible_time));
  }
  return summary;
}
}  // namespace

namespace {
Summary summary_of_matrix(NamedCsv table, const TableOptions& options, const std::string& title) {
  const std::set<std::string> modes = modes_of({table});
  if (options.rows) {
    table.text = analysis::as_matrix(std::move(table.text), *options.rows);
  }
  const std::set<std::string> others{options.responses.begin(), options.responses.end()};
  return analysis::summarise(
      analysis::read_counts(table.text, table.file, options.are_counts, others), title,
      protocols::identification().name(), modes);
}
}  // namespace

Summary summary_of_tables(const std::vector<std::string>& files, const TableOptions& options) {
  std::vector<NamedCsv> tables;
  LeftOut left_out;
  for (const std::string& file : files) {
    tables.push_back(read_file(file, options.encoding, left_out));
  }
  check_differ(tables);
  const std::string title = std::filesystem::path{files.front()}.stem().string();
  Summary summary = hold_answers(tables, options)
                        ? summary_of_answers(tables, options, title)
                        : summary_of_matrix(tables.front(), options, title);
  for (const auto& [line, count] : left_out) {
    summary.deviations.push_back(
        fmt::format("{} is left out of {}: it is no row", line, counted(count, "file")));
  }
  summary.provenance = {{"counts", fmt::format("{}", fmt::join(files, ", "))}};
  return summary;
}
}  // namespace tapstudy::runner
