#pragma once
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>
struct sqlite3;
struct sqlite3_stmt;
namespace tapstudy::results {
// A thin SQLite wrapper; every failure throws StoreError with the file name and SQLite's message.
class Database {
 public:
  enum class Access { read, write };
  // The file name is a path, never a URI. Anything but a regular file is refused.
  Database(const std::string& file, Access access);
  // A database without a file; the name is for messages.
  static Database in_memory(const std::string& name);
  void run(const std::string& sql);
  std::int64_t pragma(const std::string& name);  // what PRAGMA name answers, an integer
  const std::string& file() const { return file_; }
  bool is_open() const { return handle_ != nullptr; }
  bool can_write() const { return access_ == Access::write; }
  std::int64_t last_row_id() const;
  bool is_in_transaction() const;
  // Whether the open file is no longer the one under its name: deleted, moved or replaced.
  bool has_moved() const;
  // Moves the write-ahead log into the file; false if another connection prevents it.
  bool checkpoint();
  // Statements running longer than this from now on are interrupted.
  void limit_time(std::chrono::seconds limit);
  void lift_limit();

 private:
  friend class Statement;
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  struct Opening {
    std::string name;  // for messages
    std::string path;
    int flags;
  };
  struct Finalise {
    void operator()(sqlite3_stmt* handle) const;
  };
  using Prepared = std::unique_ptr<sqlite3_stmt, Finalise>;
  Database(const Opening& opening, Access access);
  // A statement that nobody uses, prepared now or kept from before.
  Prepared prepared(const std::string& sql);
  void keep(Prepared statement) noexcept;
  std::string file_;
  Access access_;
  std::unique_ptr<sqlite3, Close> handle_;
  std::multimap<std::string, Prepared, std::less<>> kept_;  // preparing costs more than most rows
  std::unique_ptr<std::chrono::steady_clock::time_point> time_limit_;  // SQLite keeps its address
};

// Parameters are bound in order; columns are read by index, from 0. It ends before its database
// does.
class Statement {
 public:
  Statement(Database& database, const std::string& sql);
  Statement(Statement&& other) = default;
  Statement& operator=(Statement&& other) = delete;
  ~Statement();
  Statement& bind(const std::string& text);
  Statement& bind(std::int64_t number);
  Statement& bind(int number) { return bind(static_cast<std::int64_t>(number)); }
  Statement& bind(bool flag) { return bind(static_cast<std::int64_t>(flag)); }
  Statement& bind(double number);
  Statement& bind(std::span<const std::byte> bytes);
  template <class Value>
  Statement& bind(const std::optional<Value>& value) {
    return value ? bind(*value) : bind_null();
  }
  Statement& bind_null();

  bool step();  // true while there is a row
  void finish() {
    while (step()) {
    }
  }
  bool is_null(int column);
  std::string text(int column);
  std::int64_t integer(int column);
  double real(int column);
  std::vector<std::byte> bytes(int column);
  int small_integer(int column) { return static_cast<int>(integer(column)); }
  bool flag(int column) { return integer(column) != 0; }
  // Unset where the column is NULL.
  std::optional<double> optional_real(int column) { return unless_null(column, &Statement::real); }
  std::optional<int> optional_int(int column) {
    return unless_null(column, &Statement::small_integer);
  }
  std::optional<bool> optional_flag(int column) { return unless_null(column, &Statement::flag); }
  std::optional<std::string> optional_text(int column) {
    return unless_null(column, &Statement::text);
  }

 private:
  template <class Value>
  std::optional<Value> unless_null(int column, Value (Statement::*read)(int)) {
    return is_null(column) ? std::nullopt : std::optional{(this->*read)(column)};
  }
  void check(int code) const;
  Database* database_;
  Database::Prepared handle_;
  int bound_{0};
};

// Begins here; rolled back at the end of the scope unless committed. Within another transaction it
// is a part of that one, which goes on without it where it is rolled back.
class Transaction {
 public:
  explicit Transaction(Database& database);
  ~Transaction();
  Transaction(const Transaction& other) = delete;
  Transaction& operator=(const Transaction& other) = delete;
  void commit();

 private:
  Database* database_;
  bool is_part_;
  bool is_open_{true};
};
}  // namespace tapstudy::results
