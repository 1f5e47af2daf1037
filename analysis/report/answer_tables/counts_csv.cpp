#include "analysis/report/answer_tables/counts_csv.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>
#include <sstream>

#include "analysis/report/answer_tables/answer_columns.hpp"
#include "analysis/report/answer_tables/foreign_text.hpp"
#include "analysis/statistics/csv_rows.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::int64_t max_answers = 1'000'000;

[[noreturn]] void refuse(const std::string& file, int line, const std::string& what) {
  throw core::InvalidInput{fmt::format("{}:{}: {}", file, line, what)};
}

std::vector<std::string> names_of(const std::vector<Item>& items) {
  std::vector<std::string> names;
  std::ranges::transform(items, std::back_inserter(names), &Item::name);
  return names;
}

bool has_name(const std::vector<Item>& items, const std::string& name) {
  return std::ranges::find(items, name, &Item::name) != items.end();
}

// As a confusion matrix's are whose corner does not say which of both were presented.
bool are_called_alike(const std::vector<CsvRow>& rows) {
  return rows.size() > 2 && rows.front().cells.front() != "stimulus" &&
         std::ranges::all_of(std::span{rows}.subspan(1), [&](const CsvRow& row) {
           return std::ranges::find(rows.front().cells, row.cells.front()) !=
                  rows.front().cells.end();
         });
}

// A row for each participant and stimulus, and a column for each answer.
void check_has_no_answers_in_columns(const std::vector<CsvRow>& rows, const std::string& file) {
  const std::vector<std::string> header =
      rows.empty() ? std::vector<std::string>{} : rows.front().cells;
  const auto stimulus = std::ranges::find(header, "stimulus");
  if (stimulus == header.end() || stimulus == header.begin()) {
    return;
  }
  const auto place = stimulus - header.begin();
  const auto is_presented = [&](const std::string& name) {
    return std::ranges::any_of(std::span{rows}.subspan(1), [&](const CsvRow& row) {
      return row.cells[static_cast<std::size_t>(place)] == name;
    });
  };
  if (std::ranges::count_if(header, is_presented) > 1) {
    refuse(file, rows.front().line,
           fmt::format("has a row for each '{}' and stimulus, and answers as columns: put these "
                       "into rows, with a column of their counts (pandas: stack(); R: "
                       "as.data.frame(table())), or add the rows of each stimulus up",
                       header.front()));
  }
}

const std::vector<CsvRow>& checked_rows(const std::vector<CsvRow>& rows, const std::string& file) {
  for (const CsvRow& row : rows) {
    if (row.cells.size() != rows.front().cells.size()) {
      refuse(file, row.line,
             fmt::format("has {} cells, the header has {}", row.cells.size(),
                         rows.front().cells.size()));
    }
  }
  if (are_called_alike(rows)) {
    refuse(file, rows.front().line,
           "has rows and columns of the same names, and does not say which were presented: --rows "
           "stimuli or --rows responses (a header that starts with 'stimulus' says so itself)");
  }
  check_has_no_answers_in_columns(rows, file);
  if (rows.size() < 2 || rows.front().cells.front() != "stimulus") {
    refuse(file, rows.empty() ? 1 : rows.front().line,
           fmt::format(
               "is neither a matrix (its header starts with 'stimulus', and there is a row "
               "for each) nor a table of answers (a row each; --stimulus-column and "
               "--response-column name the columns, which commas, semicolons or tabs separate, "
               "here: {})",
               fmt::join(rows.empty() ? std::vector<std::string>{} : rows.front().cells, ", ")));
  }
  return rows;
}

std::int64_t count_in(const std::string& cell, const CsvText& csv, const std::string& file,
                      int line) {
  if (cell.empty()) {
    refuse(file, line, "has an empty cell: an answer that was never given is counted as 0");
  }
  const auto value = count_in_cell(csv, cell);
  if (!value || *value > max_answers) {
    refuse(file, line,
           fmt::format("'{}' is not a count (from 0 to {}; shares are no counts; a factor's column "
                       "is headed {}NAME)",
                       cell, max_answers, factor_mark));
  }
  return *value;
}

std::vector<Item> stimuli_of(const std::vector<CsvRow>& lines, const std::string& file) {
  std::vector<Item> stimuli;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::string& name = lines[i].cells[0];
    if (has_name(stimuli, name)) {
      refuse(file, lines[i].line, fmt::format("stimulus '{}' is there twice", name));
    }
    stimuli.push_back({name, name, {}});
  }
  return stimuli;
}

// Columns of factors come first.
std::size_t first_response(const CsvRow& header, const std::string& file) {
  const auto is_factor = [](const std::string& name) { return name.starts_with(factor_mark); };
  const auto found = std::find_if_not(header.cells.begin() + 1, header.cells.end(), is_factor);
  if (std::any_of(found, header.cells.end(), is_factor)) {
    refuse(file, header.line, "has a factor after the first response");
  }
  return static_cast<std::size_t>(found - header.cells.begin());
}

std::vector<Item> responses_of(const CsvRow& header, std::size_t first,
                               const std::vector<Item>& stimuli, const std::string& file) {
  std::vector<Item> responses;
  for (std::size_t column = first; column < header.cells.size(); ++column) {
    const std::string& name = header.cells[column];
    if (has_name(responses, name)) {
      refuse(file, header.line, fmt::format("response '{}' is there twice", name));
    }
    const auto stimulus = std::ranges::find(stimuli, name, &Item::name);
    responses.push_back(stimulus != stimuli.end()
                            ? *stimulus
                            : Item{.name = name, .label = name, .is_alternative = false});
  }
  if (responses.size() < 2) {
    refuse(file, header.line, "has fewer than two responses");
  }
  return responses;
}

// Otherwise a misspelt name would be a stimulus that is never recognised.
void check_is_named(const std::vector<Item>& stimuli, const std::vector<Item>& responses,
                    const std::vector<CsvRow>& lines, const std::string& file) {
  const std::vector<std::string> names = names_of(responses);
  for (std::size_t i = 0; i < stimuli.size(); ++i) {
    if (!has_name(responses, stimuli[i].name)) {
      refuse(file, lines[i + 1].line,
             fmt::format("no response is called '{}' (these are: {}; one that was never given is a "
                         "column of zeros)",
                         stimuli[i].name, fmt::join(names, ", ")));
    }
  }
  if (stimuli.size() < 2) {
    refuse(file, lines.back().line, "is the only stimulus: there is nothing to tell apart");
  }
}

using Lines = std::vector<std::vector<std::int64_t>>;

std::int64_t sum_of(const std::vector<std::int64_t>& line) {
  return std::accumulate(line.begin(), line.end(), std::int64_t{0});
}

// Whether in each line what stands at `place` is the sum of all else. Not of two alone, which may
// be equal.
bool is_margin(const Lines& lines, std::size_t place) {
  std::int64_t whole = 0;
  for (const auto& line : lines) {
    const std::int64_t all = sum_of(line);
    if (2 * line[place] != all) {
      return false;
    }
    whole += all;
  }
  return whole > 0 && lines.front().size() > 2;
}

constexpr const char* otherwise = " (--are-counts: it is no sum)";

Lines columns_of(const ConfusionMatrix& matrix) {
  Lines columns(matrix.responses.size(), std::vector<std::int64_t>(matrix.stimuli.size()));
  for (std::size_t i = 0; i < matrix.stimuli.size(); ++i) {
    for (std::size_t j = 0; j < matrix.responses.size(); ++j) {
      columns[j][i] = matrix.counts[i][j];
    }
  }
  return columns;
}

// But for two standard deviations of the sum of so many rounded numbers.
bool is_about_100(std::int64_t sum, std::size_t numbers) {
  const double rounding = std::max(1.0, std::sqrt(static_cast<double>(numbers) / 3.0));
  return std::abs(static_cast<double>(sum) - 100.0) <= rounding;
}

// Of so many answers only --are-counts can tell.
void check_are_no_percentages(const ConfusionMatrix& matrix, const std::vector<CsvRow>& lines,
                              const std::string& file) {
  const auto adds_up = [](const std::vector<std::int64_t>& line) {
    return is_about_100(sum_of(line), line.size());
  };
  const std::size_t cells = matrix.stimuli.size() * matrix.responses.size();
  const char* const what = std::ranges::all_of(matrix.counts, adds_up) ? "each row adds up"
                           : std::ranges::all_of(columns_of(matrix), adds_up)
                               ? "each column adds up"
                           : is_about_100(matrix.total(), cells) ? "all numbers together add up"
                                                                 : nullptr;
  if (what != nullptr) {
    refuse(file, lines.front().line,
           fmt::format("{} to 100, as percentages do, which are no counts (--are-counts: these are "
                       "numbers of answers)",
                       what));
  }
}

// Other columns say something else than how often an answer was given, or count missing ones.
void check_are_answers(const ConfusionMatrix& matrix, const std::set<std::string>& others,
                       const std::vector<CsvRow>& lines, const std::string& file) {
  for (const Item& response : matrix.responses) {
    if (!response.is_alternative && !others.contains(response.name)) {
      refuse(file, lines.front().line,
             fmt::format("column '{0}' is no stimulus: if it counts an answer that names none, say "
                         "so by --responses '{0}', else leave it out",
                         response.name));
    }
  }
}

void check_differ(const std::vector<Item>& items, const std::string& file, int line) {
  if (const auto alike = first_alike(names_of(items))) {
    refuse(
        file, line,
        fmt::format("'{}' and '{}' read alike: add up what is one", alike->first, alike->second));
  }
}

// They would count every answer twice.
void check_has_no_margins(const ConfusionMatrix& matrix, const std::vector<CsvRow>& lines,
                          const std::string& file) {
  const Lines columns = columns_of(matrix);
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (is_margin(matrix.counts, j)) {
      refuse(file, lines.front().line,
             fmt::format("column '{}' is the sum of the others: leave it out{}",
                         matrix.responses[j].name, otherwise));
    }
  }
  for (std::size_t i = 0; i < matrix.stimuli.size(); ++i) {
    if (is_margin(columns, i)) {
      refuse(file, lines[i + 1].line,
             fmt::format("row '{}' is the sum of the others: leave it out{}",
                         matrix.stimuli[i].name, otherwise));
    }
  }
}

ConfusionMatrix from_matrix(const CsvText& csv, const std::vector<CsvRow>& lines,
                            const std::string& file) {
  const std::vector<std::string>& header = lines.front().cells;
  if (std::max(lines.size(), header.size()) > max_classes) {
    refuse(file, lines.front().line,
           fmt::format("has more than {} stimuli or responses", max_classes));
  }
  std::vector<Item> stimuli = stimuli_of(lines, file);
  const std::size_t first = first_response(lines.front(), file);
  for (std::size_t i = 0; i < stimuli.size(); ++i) {
    for (std::size_t column = 1; column < first; ++column) {
      stimuli[i].factors[header[column].substr(std::string_view{factor_mark}.size())] =
          lines[i + 1].cells[column];
    }
  }
  ConfusionMatrix matrix{stimuli, responses_of(lines.front(), first, stimuli, file)};
  for (const CsvRow& line : std::span{lines}.subspan(1)) {
    for (std::size_t column = first; column < header.size(); ++column) {
      matrix.add(line.cells[0], header[column], count_in(line.cells[column], csv, file, line.line));
    }
  }
  return matrix;
}
}  // namespace

ConfusionMatrix read_counts(const CsvText& csv, const std::string& file, bool are_counts,
                            const std::set<std::string>& others) {
  const std::vector<CsvRow>& lines = checked_rows(csv.rows, file);
  ConfusionMatrix matrix = from_matrix(csv, lines, file);
  if (!are_counts) {
    check_has_no_margins(matrix, lines, file);
    check_are_no_percentages(matrix, lines, file);
  }
  check_is_named(matrix.stimuli, matrix.responses, lines, file);
  check_differ(matrix.stimuli, file, lines.front().line);
  check_differ(matrix.responses, file, lines.front().line);
  check_are_answers(matrix, others, lines, file);
  if (matrix.total() == 0) {
    refuse(file, lines.front().line, "holds no answers");
  }
  return matrix;
}

namespace {
void check_corner(const std::string& corner, MatrixRows rows) {
  constexpr std::array of_stimuli{"stimulus", "stimuli", "presented", "true", "actual", "target"};
  constexpr std::array of_responses{"response",  "responses",  "answer", "answered",
                                    "predicted", "prediction", "pred"};
  const auto is_one_of = [&](const auto& words) {
    return std::ranges::any_of(words, [&](const char* word) { return is_same_word(corner, word); });
  };
  const bool are_stimuli = rows == MatrixRows::stimuli;
  if (are_stimuli ? is_one_of(of_responses) : is_one_of(of_stimuli)) {
    throw core::InvalidInput{fmt::format(
        "--rows: the header begins with '{}', as if rows were {}: rename it if they "
        "are {}",
        corner, are_stimuli ? "responses" : "stimuli", are_stimuli ? "stimuli" : "responses")};
  }
}
}  // namespace

CsvText as_matrix(CsvText csv, MatrixRows rows) {
  std::vector<CsvRow>& lines = csv.rows;
  if (lines.empty()) {
    return csv;
  }
  std::vector<std::string>& header = lines.front().cells;
  check_corner(header.front(), rows);
  const bool lacks_corner =
      lines.size() > 1 && std::ranges::all_of(std::span{lines}.subspan(1), [&](const CsvRow& row) {
        return row.cells.size() == header.size() + 1;
      });
  if (lacks_corner) {
    header.insert(header.begin(), "");
  }
  header.front() = "stimulus";
  const bool is_rectangular = std::ranges::all_of(
      lines, [&](const CsvRow& row) { return row.cells.size() == header.size(); });
  if (rows == MatrixRows::stimuli || !is_rectangular) {  // which is refused at its line
    return csv;
  }
  CsvText turned = csv;
  turned.rows.assign(header.size(), {lines.front().line, {}});
  for (const CsvRow& row : lines) {
    for (std::size_t column = 0; column < header.size(); ++column) {
      turned.rows[column].cells.push_back(row.cells[column]);
    }
  }
  return turned;
}

std::set<std::string> modes_in(const CsvText& csv) {
  std::set<std::string> modes;
  for (const std::string& comment : csv.comments) {
    if (!comment.starts_with(mode_mark)) {
      continue;
    }
    std::istringstream words{comment.substr(std::string_view{mode_mark}.size())};
    for (std::string word; std::getline(words, word, ',');) {
      modes.insert(core::trimmed(word));
    }
  }
  return modes;
}
}  // namespace tapstudy::analysis
