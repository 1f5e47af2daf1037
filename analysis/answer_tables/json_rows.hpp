#pragma once
#include <istream>
#include <string>
#include <string_view>

#include "analysis/statistics/csv_rows.hpp"
namespace tapstudy::analysis {
// Whether the text begins as a list does in JSON. Reads nothing else of it.
bool is_json_list(std::string_view text);

// A list of objects, as jsPsych saves its data, as the table that it would be in CSV: a column for
// each key that any has, a row for each object, numbered as its line. What is null or missing is
// empty; lists and objects within are JSON. Throws InvalidInput with the file for what is no such
// list and beyond 64 MB.
CsvText read_json_rows(std::istream& text, const std::string& file);
}  // namespace tapstudy::analysis
