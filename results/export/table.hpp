#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>
namespace tapstudy::results {
enum class CellType { boolean, integer, real, text };

// A column of an exported table. Its unit is of the SI, "dB" or empty (a text or a pure number);
// a column with a unit ends with it: `_s`, `_m_s`.
struct Column {
  std::string name;
  CellType type{};
  std::string unit;
  std::string description;
};

// Of a column's type; booleans are 0 or 1; monostate: missing. A real may be NaN or infinite.
using Cell = std::variant<std::monostate, std::int64_t, double, std::string>;
using Row = std::vector<Cell>;  // as many cells as there are columns
using RowSink = std::function<void(const Row&)>;

// A table with one observation a row. `each_row` shows its rows in order, as often as it is called.
struct Table {
  std::string name;
  std::string description;
  std::vector<Column> columns;
  std::function<void(const RowSink&)> each_row;
};

// Of rows that are at hand.
Table table_of(std::string name, std::string description, std::vector<Column> columns,
               std::vector<Row> rows);

// The data dictionary: a name means the same in every table and file that an export writes.
// Throws std::logic_error for a name that is not in it.
const Column& known_column(const std::string& name);
// Names are separated by spaces.
std::vector<Column> known_columns(const std::string& names);
const std::vector<Column>& all_known_columns();
}  // namespace tapstudy::results
