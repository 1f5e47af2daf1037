#include "results/server/mirrored_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "core/files/sha256.hpp"
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

void append_bytes(const std::vector<std::byte>& bytes, std::string& line) {
  constexpr std::string_view digits = "0123456789abcdef";
  line += R"(\\x)";
  for (const std::byte byte : bytes) {
    line += digits[std::to_integer<std::size_t>(byte >> 4)];
    line += digits[std::to_integer<std::size_t>(byte & std::byte{15})];
  }
}

std::vector<std::byte> bytes_of(std::string_view hexadecimal) {
  hexadecimal.remove_prefix(hexadecimal.starts_with("\\x") ? 2 : 0);
  std::vector<std::byte> bytes(hexadecimal.size() / 2);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    unsigned value = 0;
    const char* const begin = hexadecimal.data() + 2 * i;
    std::from_chars(begin, begin + 2, value, 16);
    bytes[i] = static_cast<std::byte>(value);
  }
  return bytes;
}

template <class Number>
Number number_of(std::string_view text, const MirroredTable& table) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) {
    throw StoreError{
        fmt::format("the server's table {} holds '{}' where a number is", table.name, text)};
  }
  return number;
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
      append_bytes(row.bytes(column), line);
  }
}

// PostgreSQL writes the least digits that say a number, and inf as Infinity.
double real_of(const std::string& text, const MirroredTable& table) {
  if (text == "Infinity" || text == "-Infinity") {
    return text.front() == '-' ? -std::numeric_limits<double>::infinity()
                               : std::numeric_limits<double>::infinity();
  }
  return number_of<double>(text, table);
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
      insert.bind(real_of(text, table));
      return;
    case ColumnType::text:
      insert.bind(text);
      return;
    case ColumnType::bytes:
      insert.bind(std::span<const std::byte>{bytes_of(text)});
  }
}
}  // namespace

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

std::string server_schema_sql() {
  std::string sql = fmt::format(
      R"sql(-- tapstudy's tables of a PostgreSQL server, and the roles that use them: psql -f FILE, once.
BEGIN;
CREATE SCHEMA tapstudy;
CREATE TABLE tapstudy.schema_version (version integer NOT NULL);
INSERT INTO tapstudy.schema_version VALUES ({});
-- One row a study directory: a site's name, and which of its studies.
CREATE TABLE tapstudy.store (
  store_id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  site text NOT NULL,
  title text NOT NULL,
  protocol_sha256 text NOT NULL,
  created_utc text NOT NULL,
  UNIQUE (site, protocol_sha256, created_utc)
);
-- How far each table of a store is here: rows beyond are of a push that has not ended.
CREATE TABLE tapstudy.mirrored (
  store_id bigint NOT NULL REFERENCES tapstudy.store,
  table_name text NOT NULL,
  last_row_id bigint NOT NULL,
  sha256 text NOT NULL,
  PRIMARY KEY (store_id, table_name)
);
-- Which row of a study's balanced orders each participant of each site has.
CREATE TABLE tapstudy.assigned_row (
  protocol_sha256 text NOT NULL,
  title text NOT NULL,
  row integer NOT NULL,
  site text NOT NULL,
  participant_id text NOT NULL,
  assigned_utc timestamp NOT NULL DEFAULT (now() AT TIME ZONE 'utc'),
  PRIMARY KEY (protocol_sha256, row),
  UNIQUE (protocol_sha256, site, participant_id)
);
)sql",
      schema_version);
  for (const MirroredTable& table : mirrored_tables()) {
    sql += fmt::format(
        "CREATE TABLE tapstudy.{} (store_id bigint NOT NULL REFERENCES tapstudy.store, row_id "
        "bigint "
        "NOT NULL",
        table.name);
    for (const MirroredColumn& column : table.columns) {
      sql += fmt::format(", {} {}", column.name,
                         std::ranges::find(types, column.type, &TypeRow::type)->of_server);
    }
    sql += ", PRIMARY KEY (store_id, row_id));\n";
  }
  sql += R"sql(-- A site adds rows and changes none, but for how far its pushes are. A reader reads.
DO $$ BEGIN
  IF NOT EXISTS (SELECT FROM pg_roles WHERE rolname = 'tapstudy_site') THEN
    CREATE ROLE tapstudy_site NOLOGIN;
  END IF;
  IF NOT EXISTS (SELECT FROM pg_roles WHERE rolname = 'tapstudy_reader') THEN
    CREATE ROLE tapstudy_reader NOLOGIN;
  END IF;
END $$;
GRANT USAGE ON SCHEMA tapstudy TO tapstudy_site, tapstudy_reader;
GRANT SELECT ON ALL TABLES IN SCHEMA tapstudy TO tapstudy_site, tapstudy_reader;
GRANT INSERT ON ALL TABLES IN SCHEMA tapstudy TO tapstudy_site;
REVOKE INSERT ON tapstudy.schema_version FROM tapstudy_site;
GRANT UPDATE ON tapstudy.mirrored TO tapstudy_site;
COMMIT;
)sql";
  return sql;
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
