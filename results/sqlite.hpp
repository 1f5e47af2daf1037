#pragma once
#include <cstddef>
#include <cstdint>
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
  Database(const std::string& file, Access access);
  void run(const std::string& sql);
  const std::string& file() const { return file_; }
  bool is_open() const { return handle_ != nullptr; }
  bool can_write() const { return access_ == Access::write; }
  std::int64_t last_row_id() const;

 private:
  friend class Statement;
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  std::string file_;
  Access access_;
  std::unique_ptr<sqlite3, Close> handle_;
};

// Parameters are bound in order; columns are read by index, from 0.
class Statement {
 public:
  Statement(Database& database, const std::string& sql);
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

 private:
  void check(int code) const;
  struct Finalise {
    void operator()(sqlite3_stmt* handle) const;
  };
  Database* database_;
  std::unique_ptr<sqlite3_stmt, Finalise> handle_;
  int bound_{0};
};

// Begins here; rolled back at the end of the scope unless committed.
class Transaction {
 public:
  explicit Transaction(Database& database);
  ~Transaction();
  Transaction(const Transaction& other) = delete;
  Transaction& operator=(const Transaction& other) = delete;
  void commit();

 private:
  Database* database_;
  bool is_open_{true};
};
}  // namespace tapstudy::results
