#include "analysis/modal/recording/instrument_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "analysis/modal/recording/sampling.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
constexpr char blank = ' ';

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  for (std::size_t begin = line.find_first_not_of(" \t\r"); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
    words.emplace_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(" \t\r", end);
  }
  return words;
}

std::vector<std::string> cells_of(std::string_view line, char separator) {
  if (separator == blank) {
    return words_of(line);
  }
  std::vector<std::string> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(separator, begin), line.size());
    cells.push_back(core::trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return cells;
}

bool is_a_number(std::string cell, char separator) {
  if (separator != ',') {
    std::ranges::replace(cell, ',', '.');
  }
  return core::number_in<double>(std::string_view{cell}.substr(cell.starts_with('+') ? 1 : 0))
      .has_value();
}

// How many cells a row of numbers has; 0: it is none.
std::size_t numbers_in(std::string_view line, char separator) {
  const std::vector<std::string> cells = cells_of(line, separator);
  const bool are_numbers = !cells.empty() && !cells.front().empty() &&
                           std::ranges::all_of(cells, [&](const std::string& cell) {
                             return cell.empty() || is_a_number(cell, separator);
                           });
  return are_numbers ? cells.size() : 0;
}

struct FirstNumbers {
  std::size_t line{};  // index
  std::size_t cells{};
  char separator{};
};
std::optional<FirstNumbers> first_numbers(const std::vector<std::string_view>& lines) {
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    for (const char separator : {'\t', ';', ',', blank}) {
      const std::size_t cells = numbers_in(lines[i], separator);
      const bool is_separated = cells > 1 || separator == blank;
      if (cells > 0 && is_separated && numbers_in(lines[i + 1], separator) == cells) {
        return FirstNumbers{i, cells, cells == 1 ? ',' : separator};
      }
    }
  }
  return std::nullopt;
}

bool is_blank(std::string_view line) {
  return line.find_first_not_of(" \t\r") == std::string_view::npos;
}

bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with('%');
}

std::vector<std::string> cells_of_header(std::string_view line, char separator) {
  line.remove_prefix(is_comment(line) ? 1 : 0);
  return cells_of(line, separator);
}

std::string joined_by(char separator, const std::vector<std::string>& cells, std::size_t count) {
  std::string line;
  for (std::size_t i = 0; i < std::min(cells.size(), count); ++i) {
    line += (i == 0 ? "" : std::string(1, separator)) + cells[i];
  }
  return line;
}

bool is_time(const std::string& name) {
  return time_unit_of(name).seconds > 0.0;
}

bool is_in_brackets(const std::string& cell) {
  return (cell.starts_with('(') && cell.ends_with(')')) ||
         (cell.starts_with('[') && cell.ends_with(']'));
}

// A row of units below the names: "s,m/s^2", "(ms),(g)", "[g],[N]".
bool are_units(const std::vector<std::string>& cells) {
  const auto is_unit_of_time = [](const std::string& cell) {
    return cell.find('s') != std::string::npos && is_time("t " + cell);
  };
  return std::ranges::any_of(cells, is_unit_of_time) || std::ranges::all_of(cells, is_in_brackets);
}

// The names, and with that of the time its unit; unset if there are not as many as units.
std::optional<std::vector<std::string>> names_above(std::string_view line,
                                                    const std::vector<std::string>& units,
                                                    char separator) {
  std::vector<std::string> names = cells_of_header(line, separator);
  const bool may_lack_time = std::ranges::all_of(units, is_in_brackets);
  if (names.size() != units.size() || (!may_lack_time && std::ranges::none_of(names, is_time))) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (is_time(names[i]) && is_time(names[i] + " " + units[i])) {
      names[i] += " " + units[i];
    }
  }
  return names;
}

// LabVIEW states the units of all columns in a line of their own.
std::vector<std::string> units_of_labview(const std::vector<std::string_view>& lines,
                                          const FirstNumbers& first) {
  for (std::size_t i = first.line; i-- > 0;) {
    if (lines[i].starts_with("Y_Unit_Label")) {
      std::vector<std::string> units = cells_of(lines[i], first.separator);
      const bool is_above_time = lines[first.line - 1].starts_with("X_Value");
      units.erase(units.begin(), units.begin() + (is_above_time ? 0 : 1));
      return units;
    }
  }
  return {};
}

std::vector<std::string_view> lines_of(std::string_view text) {
  constexpr std::string_view byte_order_mark_utf8 = "\xEF\xBB\xBF";
  text.remove_prefix(text.starts_with(byte_order_mark_utf8) ? byte_order_mark_utf8.size() : 0);
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    lines.back().remove_suffix(lines.back().ends_with('\r') ? 1 : 0);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

// The rows of numbers of a file in which LabVIEW saved no times (X_Columns No): an empty cell
// stands in their place.
struct RowsWithoutTimes {
  std::size_t names{};  // line of the columns' names
  char separator{};
  std::vector<double> first_s;     // of each channel
  std::vector<double> interval_s;  // likewise
};

std::vector<double> labview_numbers(std::string_view line, char separator) {
  std::vector<double> numbers;
  for (std::string cell : cells_of(line, separator)) {
    std::ranges::replace(cell, ',', '.');
    if (const auto number = core::number_in<double>(cell)) {
      numbers.push_back(*number);
    }
  }
  return numbers;
}

std::optional<RowsWithoutTimes> rows_without_times(const std::vector<std::string_view>& lines) {
  constexpr std::string_view separator_line = "Separator";
  if (lines.empty() || !lines.front().starts_with("LabVIEW Measurement")) {
    return std::nullopt;
  }
  RowsWithoutTimes rows;
  bool has_times = true;
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    const std::string_view line = lines[i];
    if (line.starts_with(separator_line) && line.size() > separator_line.size()) {
      rows.separator = line[separator_line.size()];
    } else if (line.starts_with("X_Columns")) {
      has_times = !line.ends_with("No");
    } else if (line.starts_with("X0")) {
      rows.first_s = labview_numbers(line, rows.separator);
    } else if (line.starts_with("Delta_X")) {
      rows.interval_s = labview_numbers(line, rows.separator);
    } else if (line.starts_with("***End_of_Header***")) {
      rows.names = i + 1;
    }
  }
  const bool are_empty = !has_times && rows.names + 1 < lines.size() &&
                         lines[rows.names + 1].starts_with(rows.separator);
  return are_empty ? std::optional{rows} : std::nullopt;
}

bool are_alike(const std::vector<double>& values) {
  return !values.empty() && std::ranges::count(values, values.front()) == std::ssize(values);
}

// What stands in the empty cell of a line, if the header's times are of all channels.
std::string time_at(std::size_t line, const RowsWithoutTimes& rows) {
  if (line == rows.names) {
    return "X_Value";
  }
  const auto row = static_cast<double>(line - rows.names - 1);
  return fmt::format("{:.17g}", rows.first_s.front() + row * rows.interval_s.front());
}

// With the times that the header states, where it states the same ones of all channels.
std::string with_times_of_labview(const std::string& text) {
  const std::vector<std::string_view> lines = lines_of(text);
  const auto rows = rows_without_times(lines);
  if (!rows) {
    return text;
  }
  const bool have_times = are_alike(rows->first_s) && are_alike(rows->interval_s);
  std::string filled;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::string line{lines[i]};
    if (i >= rows->names && line.starts_with(rows->separator)) {
      line = have_times ? time_at(i, *rows) + line : line.substr(1);
    }
    filled += line + "\n";
  }
  return filled;
}

struct Header {
  std::string line;  // as the rows' cells ask for it; empty: there is none
  std::vector<std::string> units;
};

Header header_above(const std::vector<std::string_view>& lines, const FirstNumbers& first) {
  std::size_t end = first.line;
  while (end > 0 && is_blank(lines[end - 1])) {
    --end;
  }
  if (end == 0) {
    return {};
  }
  const bool is_commented = is_comment(lines[end - 1]);
  std::vector<std::string> cells = cells_of_header(lines[end - 1], first.separator);
  const bool fits = is_commented ? cells.size() == first.cells : cells.size() >= first.cells;
  std::vector<std::string> units = units_of_labview(lines, first);
  if (are_units(cells)) {
    units = cells;
    if (end > 1 && is_comment(lines[end - 2]) == is_commented) {
      cells = names_above(lines[end - 2], units, first.separator).value_or(cells);
    }
  }
  const bool must_name_time = is_commented || end < first.line;
  if (!fits || (must_name_time && std::ranges::none_of(cells, is_time))) {
    return {};
  }
  return {joined_by(first.separator == blank ? '\t' : first.separator, cells, first.cells), units};
}

// A header in quotes may be of several lines, and a table of one header needs no help.
bool is_plain(const std::vector<std::string_view>& lines, const FirstNumbers& first) {
  std::size_t headers = 0;
  for (std::size_t i = 0; i < first.line; ++i) {
    if (lines[i].find('"') != std::string_view::npos) {
      return true;
    }
    headers += lines[i].empty() || lines[i].starts_with('#') ? 0 : 1;
  }
  const std::size_t above =
      headers == 0 ? first.cells : cells_of(lines[first.line - 1], first.separator).size();
  return first.separator != blank && headers <= 1 && above == first.cells;
}
// Where the blank lines before this line begin.
std::size_t begin_of_blank_lines(std::string_view text, std::size_t line) {
  while (line > 1) {
    const std::size_t before = text.rfind('\n', line - 2) + 1;
    if (!is_blank(text.substr(before, line - 1 - before))) {
      break;
    }
    line = before;
  }
  return line;
}
}  // namespace

std::string first_segment(std::string text, std::vector<std::string>& remarks) {
  constexpr std::string_view end_of_header = "\n***End_of_Header***";
  std::vector<std::size_t> headers;  // the file's own, then those of its segments
  if (text.starts_with("LabVIEW Measurement")) {
    for (std::size_t at = text.find(end_of_header); at != std::string::npos;
         at = text.find(end_of_header, at + 1)) {
      headers.push_back(at);
    }
  }
  constexpr std::size_t of_one_segment = 2;
  if (headers.size() <= of_one_segment) {
    return text;
  }
  const std::size_t second = text.rfind("\nChannels", headers[of_one_segment]);
  if (second == std::string::npos || second < headers[of_one_segment - 1]) {
    return text;
  }
  text.resize(begin_of_blank_lines(text, second + 1));
  remarks.push_back(fmt::format(
      "it has {} segments with a header each, of which only the first was read, up to line {} "
      "(save the others as files of their own)",
      headers.size() - 1, std::ranges::count(text, '\n')));
  return text;
}

PlainTable plain_table(const std::string& text) {
  const std::string timed = with_times_of_labview(text);
  const std::vector<std::string_view> lines = lines_of(timed);
  const auto first = first_numbers(lines);
  if (!first || is_plain(lines, *first)) {
    return {timed, {}};
  }
  const Header header = header_above(lines, *first);
  std::string plain;
  plain.reserve(text.size() + lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool is_header = !header.line.empty() && i + 1 == first->line;
    if (is_header) {
      plain += header.line;
    } else if (i < first->line) {
      plain += "#" + std::string{lines[i]};
    } else if (first->separator == blank) {
      plain += joined_by('\t', words_of(lines[i]), lines[i].size());
    } else {
      plain += lines[i];
    }
    plain += '\n';
  }
  return {plain, header.units};
}
}  // namespace tapstudy::analysis
