#include "results/server/mirrored_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "core/files/sha256.hpp"
#include "core/text/hexadecimal.hpp"
#include "core/text/plain_text.hpp"
#include "results/store/schema.hpp"
#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
struct TypeRow {
  ColumnType type;
  std::string_view of_sqlite;
  std::string_view of_server;
};
constexpr std::array<TypeRow, 4> types{{{ColumnType::integer, "INTEGER", "bigint"},
                                        {ColumnType::real, "REAL", "double precision"},
                                        {ColumnType::text, "TEXT", "text"},
                                        {ColumnType::bytes, "BLOB", "bytea"}}};

MirroredTable table_of(Database& schema, const std::string& name) {
  MirroredTable table{.name = name, .columns = {}};
  Statement column{schema, fmt::format("SELECT name, type, pk FROM pragma_table_info('{}') "
                                       "ORDER BY cid",
                                       name)};
  int keys = 0;
  while (column.step()) {
    const std::string type = column.text(1);
    const auto* const known = std::ranges::find(types, type, &TypeRow::of_sqlite);
    table.columns.push_back({column.text(0), known->type});
    keys += column.flag(2) ? 1 : 0;
    table.has_own_id = table.has_own_id || (column.flag(2) && known->type == ColumnType::integer);
  }
  table.has_own_id = table.has_own_id && keys == 1;
  return table;
}

std::vector<MirroredTable> tables_of_schema() {
  Database schema = Database::in_memory("the schema");
  schema.run(schema_sql);
  std::vector<std::string> names;
  {
    Statement name{schema, "SELECT name FROM sqlite_schema WHERE type = 'table' ORDER BY rowid"};
    while (name.step()) {
      names.push_back(name.text(0));
    }
  }
  std::vector<MirroredTable> tables;
  std::ranges::transform(names, std::back_inserter(tables),
                         [&](const std::string& name) { return table_of(schema, name); });
  return tables;
}

struct Escape {
  char character;
  char written;
};
// PostgreSQL, "COPY", file formats, text format.
constexpr std::array<Escape, 7> escapes{
    {{'\\', '\\'}, {'\t', 't'}, {'\n', 'n'}, {'\r', 'r'}, {'\b', 'b'}, {'\f', 'f'}, {'\v', 'v'}}};

void append_escaped(const std::string& text, std::string& line) {
  for (const char character : text) {
    const auto* const escape = std::ranges::find(escapes, character, &Escape::character);
    if (escape != escapes.end()) {
      line += '\\';
      line += escape->written;
    } else {
      line += character;
    }
  }
}

std::string unescaped(std::string_view field) {
  std::string text;
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (field[i] != '\\' || i + 1 == field.size()) {
      text += field[i];
      continue;
    }
    ++i;
    const auto* const escape = std::ranges::find(escapes, field[i], &Escape::written);
    text += escape == escapes.end() ? field[i] : escape->character;
  }
  return text;
}

std::vector<std::byte> bytes_of(std::string_view written) {
  written.remove_prefix(written.starts_with("\\x") ? 2 : 0);
  return core::from_hex(written);
}

template <class Number>
Number number_of(std::string_view text, const MirroredTable& table) {
  const auto number = core::number_in<Number>(text);
  if (!number) {
    throw StoreError{
        fmt::format("the server's table {} holds '{}' where a number is", table.name, text)};
  }
  return *number;
}

void append_field(ColumnType type, int column, Statement& row, std::string& line) {
  if (row.is_null(column)) {
    line += "\\N";
    return;
  }
  switch (type) {
    case ColumnType::integer:
      line += fmt::format("{}", row.integer(column));
      return;
    case ColumnType::real:
      line += fmt::format("{:.17g}", row.real(column));
      return;
    case ColumnType::text:
      append_escaped(row.text(column), line);
      return;
    case ColumnType::bytes:
      line += R"(\\x)" + core::to_hex(row.bytes(column));
  }
}

void bind_field(const MirroredTable& table, ColumnType type, std::string_view field,
                Statement& insert) {
  if (field == "\\N") {
    insert.bind_null();
    return;
  }
  const std::string text = unescaped(field);
  switch (type) {
    case ColumnType::integer:
      insert.bind(number_of<std::int64_t>(text, table));
      return;
    case ColumnType::real:
      insert.bind(number_of<double>(text, table));
      return;
    case ColumnType::text:
      insert.bind(text);
      return;
    case ColumnType::bytes:
      insert.bind(std::span<const std::byte>{bytes_of(text)});
  }
}
}  // namespace

std::string MirroredTable::definitions() const {
  std::string list;
  for (const MirroredColumn& column : columns) {
    list += fmt::format(", {} {}", column.name,
                        std::ranges::find(types, column.type, &TypeRow::type)->of_server);
  }
  return list;
}

std::string MirroredTable::column_list() const {
  std::string list;
  for (const MirroredColumn& column : columns) {
    list += (list.empty() ? "" : ", ") + column.name;
  }
  return list;
}

std::string MirroredTable::select() const {
  return fmt::format("SELECT rowid, {} FROM {} ORDER BY rowid", column_list(), name);
}

const std::vector<MirroredTable>& mirrored_tables() {
  static const std::vector<MirroredTable> tables = tables_of_schema();
  return tables;
}

std::string copy_line(const MirroredTable& table, Statement& row) {
  std::string line = fmt::format("{}", row.integer(0));
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    line += '\t';
    append_field(table.columns[i].type, static_cast<int>(i) + 1, row, line);
  }
  line += '\n';
  return line;
}

void bind_copy_line(const MirroredTable& table, std::string_view line, Statement& insert) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t end = std::min(line.find('\t'), line.size());
    fields.push_back(line.substr(0, end));
    if (end == line.size()) {
      break;
    }
    line.remove_prefix(end + 1);
  }
  if (fields.size() != table.columns.size() + 1) {
    throw StoreError{fmt::format("the server's table {} has {} columns, not {}", table.name,
                                 fields.size() - 1, table.columns.size())};
  }
  if (!table.has_own_id) {
    bind_field(table, ColumnType::integer, fields.front(), insert);
  }
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    bind_field(table, table.columns[i].type, fields[i + 1], insert);
  }
}

std::string hash_after(const std::string& hash_before, const std::string& line) {
  return core::sha256(hash_before + line);
}
}  // namespace tapstudy::results
