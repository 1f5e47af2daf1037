#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "analysis/report/answer_tables/answer_table.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using Json = nlohmann::ordered_json;

Json list_in(std::istream& text, const std::string& file) {
  Json list;
  try {
    list = Json::parse(table_text(text, file));
  } catch (const Json::parse_error& error) {
    throw core::InvalidInput{fmt::format("{}: not valid JSON: at byte {}", file, error.byte)};
  }
  if (!list.is_array() || list.empty() ||
      !std::ranges::all_of(list, [](const Json& one) { return one.is_object(); })) {
    throw core::InvalidInput{file + ": not a JSON list of objects, one for each trial"};
  }
  return list;
}

std::string cell_of(const Json& value) {
  if (value.is_null()) {
    return "";
  }
  return value.is_string() ? value.get<std::string>() : value.dump();
}
}  // namespace

bool is_json_list(std::string_view text) {
  constexpr std::string_view byte_order_mark{"\xef\xbb\xbf"};
  text.remove_prefix(text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0);
  const auto first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '[';
}

CsvText read_json_rows(std::istream& text, const std::string& file) {
  const Json list = list_in(text, file);
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
}  // namespace tapstudy::analysis
