#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
struct pg_conn;
struct pg_result;
namespace tapstudy::results {
// A connection to a PostgreSQL server, by libpq. Every failure throws StoreError with the server's
// name and PostgreSQL's message; so does a server that has not answered for a minute.
class ServerConnection {
 public:
  // url: postgresql://USER@HOST/DATABASE. A password in it is refused (whoever lists the processes
  // reads it): it comes from PGPASSWORD or a password file. But for the loopback the connection is
  // encrypted and the server's certificate verified, unless `sslmode` is require or verify-ca.
  // Throws InvalidInput for another url.
  explicit ServerConnection(const std::string& url);
  static bool is_url(std::string_view text);

  using Cells = std::vector<std::optional<std::string>>;
  // Parameters are $1, $2 …; several statements may stand in one text without them.
  std::vector<Cells> rows(const std::string& sql, const std::vector<std::string>& parameters = {});
  void run(const std::string& sql) { rows(sql); }
  // COPY … FROM STDIN of whole lines, in a transaction of its own if there is none.
  void copy_in(const std::string& sql, std::string_view lines);
  // COPY … TO STDOUT, line by line.
  void copy_out(const std::string& sql, const std::function<void(std::string_view)>& on_line);
  const std::string& name() const { return name_; }  // host and database, for messages

 private:
  struct Close {
    void operator()(pg_conn* connection) const;
  };
  struct Clear {
    void operator()(pg_result* result) const;
  };
  using Result = std::unique_ptr<pg_result, Clear>;
  [[noreturn]] void fail(const std::string& message) const;
  [[noreturn]] void fail() const;  // with what libpq says of the connection
  void wait_for(short events);
  void flush();
  Result next_result();
  // The results of a command that was sent, to its end; then throws the first error among them.
  void finish_command(const std::function<void(const pg_result&)>& on_result = {});
  void check_sent(int code);
  void begin_copy(const std::string& sql, int status);
  std::unique_ptr<pg_conn, Close> connection_;
  std::string name_;
};

// Committed, or rolled back at the end of the scope.
class ServerTransaction {
 public:
  explicit ServerTransaction(ServerConnection& server, const std::string& kind = "");
  ~ServerTransaction();
  ServerTransaction(const ServerTransaction&) = delete;
  ServerTransaction& operator=(const ServerTransaction&) = delete;
  void commit();

 private:
  ServerConnection* server_;
  bool is_open_{true};
};
}  // namespace tapstudy::results
