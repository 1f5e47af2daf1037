#include "results/server/server_connection.hpp"

#include <fmt/format.h>
#include <libpq-fe.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <map>

#include "core/error.hpp"
#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
constexpr std::array<std::string_view, 2> url_beginnings{"postgresql://", "postgres://"};

struct FreeOptions {
  void operator()(PQconninfoOption* options) const { PQconninfoFree(options); }
};
using Options = std::unique_ptr<PQconninfoOption, FreeOptions>;
using Settings = std::map<std::string, std::string>;

void add_settings(const PQconninfoOption* option, Settings& settings) {
  for (; option != nullptr && option->keyword != nullptr; ++option) {
    if (option->val != nullptr) {
      settings.insert_or_assign(option->keyword, option->val);
    }
  }
}

// What PostgreSQL says, as one line.
std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') {
    text.pop_back();
  }
  std::ranges::replace(text, '\n', ' ');
  return text.empty() ? "the connection was lost" : text;
}

// What the url says, and of what it does not say the environment and PostgreSQL's service file.
Settings settings_of(const std::string& url) {
  char* message = nullptr;
  const Options given{PQconninfoParse(url.c_str(), &message)};
  if (!given) {
    const std::string said = message == nullptr ? "" : one_line(message);
    PQfreemem(message);
    throw core::InvalidInput{"a server is postgresql://USER@HOST/DATABASE: " + said};
  }
  Settings of_url;
  add_settings(given.get(), of_url);
  if (of_url.contains("password")) {
    throw core::InvalidInput{
        "a password in the server's address is read by whoever lists the processes: it belongs in "
        "PGPASSWORD or in a password file (~/.pgpass)"};
  }
  if (of_url.contains("service")) {
    throw core::InvalidInput{
        "a server's address names no service: PGSERVICE in the environment does"};
  }
  Settings settings;
  const Options defaults{PQconndefaults()};
  add_settings(defaults.get(), settings);
  for (const auto& [key, value] : of_url) {
    settings.insert_or_assign(key, value);
  }
  return settings;
}

bool is_loopback(std::string_view host) {
  return host.empty() || host.front() == '/' || host.front() == '@' || host == "localhost" ||
         host == "::1" || host.starts_with("127.");
}

// Several hosts, separated by commas, may stand where one does.
bool is_on_this_machine(const Settings& settings) {
  for (const char* key : {"host", "hostaddr"}) {
    const auto found = settings.find(key);
    std::string_view rest = found == settings.end() ? std::string_view{} : found->second;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(','), rest.size());
      if (!is_loopback(rest.substr(0, end))) {
        return false;
      }
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  return true;
}

// Encrypted and verified, unless the user accepts less than verification.
void require_encryption(Settings& settings, const Settings::const_iterator& stated) {
  constexpr std::array<std::string_view, 3> encrypted{"require", "verify-ca", "verify-full"};
  const std::string mode = stated == settings.end() ? "" : stated->second;
  if (mode == "disable" || mode == "allow") {
    throw core::InvalidInput{
        fmt::format("sslmode={}: a server that is not on this machine is asked with {}", mode,
                    "require, verify-ca or verify-full only")};
  }
  if (std::ranges::find(encrypted, mode) == encrypted.end()) {
    settings["sslmode"] = "verify-full";  // PostgreSQL's own default is to prefer encryption
  }
}

std::string name_of(const PGconn* connection) {
  const char* const host = PQhost(connection);
  const char* const database = PQdb(connection);
  return fmt::format("postgresql://{}/{}", host == nullptr ? "" : host,
                     database == nullptr ? "" : database);
}
}  // namespace

void ServerConnection::Close::operator()(pg_conn* connection) const {
  PQfinish(connection);
}
void ServerConnection::Clear::operator()(pg_result* result) const {
  PQclear(result);
}

bool ServerConnection::is_url(std::string_view text) {
  return std::ranges::any_of(url_beginnings,
                             [&](std::string_view begin) { return text.starts_with(begin); });
}

ServerConnection::ServerConnection(const std::string& url) {
  if (!is_url(url)) {
    throw core::InvalidInput{url + ": a server is postgresql://USER@HOST/DATABASE"};
  }
  Settings settings = settings_of(url);
  const bool is_local = is_on_this_machine(settings);
  if (!is_local) {
    require_encryption(settings, settings.find("sslmode"));
  }
  settings.insert_or_assign("application_name", "tapstudy");
  settings.try_emplace("connect_timeout", "10");
  settings.try_emplace("tcp_user_timeout", "30000");  // ms
  std::vector<const char*> keys;
  std::vector<const char*> values;
  for (const auto& [key, value] : settings) {
    keys.push_back(key.c_str());
    values.push_back(value.c_str());
  }
  keys.push_back(nullptr);
  values.push_back(nullptr);
  connection_.reset(PQconnectdbParams(keys.data(), values.data(), 0));
  name_ = connection_ ? name_of(connection_.get()) : url;
  if (!connection_ || PQstatus(connection_.get()) != CONNECTION_OK ||
      PQsetnonblocking(connection_.get(), 1) != 0) {
    fail();
  }
  if (!is_local && PQsslInUse(connection_.get()) == 0) {
    fail("the connection is not encrypted");
  }
  run("SET client_encoding TO 'UTF8'");
}

void ServerConnection::fail(const std::string& message) const {
  throw StoreError{name_ + ": " + message};
}

void ServerConnection::fail() const {
  fail(one_line(PQerrorMessage(connection_.get())));
}

void ServerConnection::wait_for(short events) {
  constexpr int longest_ms = 60'000;
  pollfd socket{PQsocket(connection_.get()), events, 0};
  int ready = 0;
  do {
    ready = poll(&socket, 1, longest_ms);
  } while (ready < 0 && errno == EINTR);
  if (ready <= 0) {
    fail(ready == 0 ? "the server has not answered for a minute" : "the connection was lost");
  }
  if ((socket.revents & POLLIN) != 0 && PQconsumeInput(connection_.get()) == 0) {
    fail();
  }
}

// A server may want to be read from before it takes more.
void ServerConnection::flush() {
  int left = PQflush(connection_.get());
  while (left > 0) {
    wait_for(POLLIN | POLLOUT);
    left = PQflush(connection_.get());
  }
  if (left < 0) {
    fail();
  }
}

ServerConnection::Result ServerConnection::next_result() {
  while (PQisBusy(connection_.get()) != 0) {
    wait_for(POLLIN);
  }
  return Result{PQgetResult(connection_.get())};
}

void ServerConnection::finish_command(const std::function<void(const pg_result&)>& on_result) {
  std::string message;
  while (const Result result = next_result()) {
    const ExecStatusType status = PQresultStatus(result.get());
    if (status != PGRES_COMMAND_OK && status != PGRES_TUPLES_OK && message.empty()) {
      message = one_line(PQresultErrorMessage(result.get()));
    }
    if (on_result) {
      on_result(*result);
    }
  }
  if (!message.empty()) {
    fail(message);
  }
}

void ServerConnection::check_sent(int code) {
  if (code == 0) {
    fail();
  }
  flush();
}

namespace {
void add_rows(const PGresult* result, std::vector<ServerConnection::Cells>& rows) {
  for (int row = 0; row < PQntuples(result); ++row) {
    ServerConnection::Cells& cells = rows.emplace_back();
    for (int column = 0; column < PQnfields(result); ++column) {
      cells.push_back(PQgetisnull(result, row, column) != 0
                          ? std::nullopt
                          : std::optional<std::string>{PQgetvalue(result, row, column)});
    }
  }
}
}  // namespace

std::vector<ServerConnection::Cells> ServerConnection::rows(
    const std::string& sql, const std::vector<std::string>& parameters) {
  std::vector<const char*> values;
  std::ranges::transform(parameters, std::back_inserter(values), &std::string::c_str);
  const int sent = values.empty() ? PQsendQuery(connection_.get(), sql.c_str())
                                  : PQsendQueryParams(connection_.get(), sql.c_str(),
                                                      static_cast<int>(values.size()), nullptr,
                                                      values.data(), nullptr, nullptr, 0);
  check_sent(sent);
  std::vector<Cells> rows;
  finish_command([&](const pg_result& result) { add_rows(&result, rows); });
  return rows;
}

void ServerConnection::begin_copy(const std::string& sql, int status) {
  check_sent(PQsendQuery(connection_.get(), sql.c_str()));
  if (const Result begun = next_result(); PQresultStatus(begun.get()) != status) {
    const std::string message = one_line(PQresultErrorMessage(begun.get()));
    finish_command();
    fail(message);
  }
}

void ServerConnection::copy_in(const std::string& sql, std::string_view lines) {
  begin_copy(sql, PGRES_COPY_IN);
  constexpr std::size_t at_once = 1 << 16;
  while (!lines.empty()) {
    const std::string_view part = lines.substr(0, at_once);
    if (const int put =
            PQputCopyData(connection_.get(), part.data(), static_cast<int>(part.size()));
        put > 0) {
      lines.remove_prefix(part.size());
    } else if (put < 0) {
      break;  // the command's result says why
    }
    flush();
  }
  while (PQputCopyEnd(connection_.get(), nullptr) == 0) {
    flush();
  }
  flush();
  finish_command();
}

void ServerConnection::copy_out(const std::string& sql,
                                const std::function<void(std::string_view)>& on_line) {
  begin_copy(sql, PGRES_COPY_OUT);
  char* line = nullptr;
  int length = PQgetCopyData(connection_.get(), &line, 1);
  while (length >= 0) {
    if (length == 0) {
      wait_for(POLLIN);
    } else {
      const std::unique_ptr<char, void (*)(void*)> freed{line, PQfreemem};
      std::string_view text{line, static_cast<std::size_t>(length)};
      text.remove_suffix(text.ends_with('\n') ? 1 : 0);
      on_line(text);
    }
    length = PQgetCopyData(connection_.get(), &line, 1);
  }
  finish_command();
}

ServerTransaction::ServerTransaction(ServerConnection& server, const std::string& kind)
    : server_{&server} {
  server_->run("BEGIN " + kind);
}

ServerTransaction::~ServerTransaction() {
  if (is_open_) {
    try {
      server_->run("ROLLBACK");
    } catch (const StoreError&) {  // NOLINT(bugprone-empty-catch): the server rolls back itself
    }
  }
}

void ServerTransaction::commit() {
  server_->run("COMMIT");
  is_open_ = false;
}
}  // namespace tapstudy::results
