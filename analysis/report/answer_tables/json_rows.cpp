#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "analysis/report/answer_tables/answer_table.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
using Json = nlohmann::ordered_json;

bool are_objects(const Json& list) {
  return list.is_array() && !list.empty() &&
         std::ranges::all_of(list, [](const Json& one) { return one.is_object(); });
}

// JATOS saves each run of a study as a list in a line of its own; empty: it is no such file.
Json lists_in_lines(const std::string& text) {
  Json all = Json::array();
  std::istringstream lines{text};
  int run = 0;
  for (std::string line; std::getline(lines, line);) {
    if (core::trimmed(line).empty()) {
      continue;
    }
    const Json list = Json::parse(line, nullptr, false);
    if (!are_objects(list)) {
      return Json::array();
    }
    ++run;
    for (Json object : list) {
      object[run_of_file] = run;
      all.push_back(std::move(object));
    }
  }
  return all;
}

Json list_in(std::istream& stream, const std::string& file) {
  const std::string text = table_text(stream, file);
  Json list;
  try {
    list = Json::parse(text);
  } catch (const Json::parse_error& error) {
    list = lists_in_lines(text);
    if (list.empty()) {
      throw core::InvalidInput{fmt::format("{}: not valid JSON: at byte {}", file, error.byte)};
    }
  }
  if (!are_objects(list)) {
    throw core::InvalidInput{file + ": not a JSON list of objects, one for each trial"};
  }
  return list;
}

// The answers of a survey are objects: {"response": {"Q0": "oak"}}.
Json with_entries(Json object) {
  Json entries = Json::object();
  for (const auto& [key, value] : object.items()) {
    if (value.is_object()) {
      for (const auto& [inner, entry] : value.items()) {
        entries[key + "." + inner] = entry;
      }
    }
  }
  object.update(entries);
  return object;
}

std::string cell_of(const Json& value) {
  if (value.is_null()) {
    return "";
  }
  return value.is_string() ? value.get<std::string>() : value.dump();
}
}  // namespace

namespace {
bool begins_with(char mark, std::string_view text) {
  constexpr std::string_view byte_order_mark{"\xef\xbb\xbf"};
  text.remove_prefix(text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0);
  const auto first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == mark;
}
}  // namespace

bool is_json_list(std::string_view text) {
  return begins_with('[', text);
}

void check_is_no_json_object(std::string_view text, const std::string& file) {
  if (!begins_with('{', text)) {
    return;
  }
  const bool is_whole = Json::parse(text, nullptr, false).is_object();
  const std::string_view line = text.substr(0, text.find('\n'));
  if (is_whole) {
    throw core::InvalidInput{
        fmt::format("{0}: is one JSON object, not a list of objects, one for each trial: `jq .KEY "
                    "'{0}' > list.json` makes a table of the list under its key KEY",
                    file)};
  }
  if (Json::parse(line, nullptr, false).is_object()) {
    throw core::InvalidInput{
        fmt::format("{0}: has a JSON object in each line, not a list of them: `jq -s . '{0}' > "
                    "list.json` makes one",
                    file)};
  }
}

CsvText read_json_rows(std::istream& text, const std::string& file) {
  Json list = list_in(text, file);
  std::ranges::transform(list, list.begin(), with_entries);
  CsvText table;
  table.has_objects = true;
  CsvRow header{1, {}};
  for (const Json& object : list) {
    for (const auto& [key, value] : object.items()) {
      if (std::ranges::find(header.cells, key) == header.cells.end()) {
        header.cells.push_back(key);
      }
    }
  }
  table.rows.push_back(header);
  for (const Json& object : list) {
    CsvRow row{static_cast<int>(table.rows.size()), {}};
    for (const std::string& key : header.cells) {
      row.cells.push_back(object.contains(key) ? cell_of(object.at(key)) : "");
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string only_answer_in(const std::string& cell) {
  if (!cell.starts_with('{') && !cell.starts_with('[')) {
    return cell;
  }
  std::string json = cell;
  if (cell.starts_with("['")) {  // as Python writes it
    std::ranges::replace(json, '\'', '"');
  }
  const auto answers = Json::parse(json, nullptr, false);
  if (!answers.is_structured() || answers.size() != 1 || answers.front().is_structured()) {
    return cell;
  }
  return answers.front().is_string() ? answers.front().get<std::string>() : answers.front().dump();
}
}  // namespace tapstudy::analysis
