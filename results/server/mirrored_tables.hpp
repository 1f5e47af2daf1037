#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "results/store/sqlite.hpp"
namespace tapstudy::results {
enum class ColumnType { integer, real, text, bytes };

struct MirroredColumn {
  std::string name;
  ColumnType type{};
};

// A table of a store as a server has it: the same columns after `store_id`, the server's number of
// the store, and `row_id`, SQLite's of the row. Rows of a store are added, never changed, so that
// their numbers say which ones the server has.
struct MirroredTable {
  std::string name;
  std::vector<MirroredColumn> columns;
  bool has_own_id{};  // a column is SQLite's number of the row

  std::string column_list() const;  // comma-separated
  std::string definitions() const;  // the same with the server's types, each after a comma
  std::string select() const;       // the number, then the columns, in the order of the numbers
};

// All tables of a store of this version, those that refer to others after them.
const std::vector<MirroredTable>& mirrored_tables();

// A row of `select` as a line of PostgreSQL's COPY, without the store's number, with a line end.
std::string copy_line(const MirroredTable& table, Statement& row);
// The same line, bound in its order. Throws StoreError if it is none of the table's.
void bind_copy_line(const MirroredTable& table, std::string_view line, Statement& insert);
// The hash of a table up to a row: the SHA-256 of the hash up to the row before ("" at the first)
// and the row's copy_line.
std::string hash_after(const std::string& hash_before, const std::string& line);
}  // namespace tapstudy::results
