#include "runner/console/console_server.hpp"

#include <civetweb.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <future>
#include <thread>
#include <vector>

#include "core/error.hpp"
namespace tapstudy::runner {
namespace {
RateLimit::Duration seconds(double s) {
  return std::chrono::duration_cast<RateLimit::Duration>(std::chrono::duration<double>{s});
}
}  // namespace

RateLimit::RateLimit(double per_second, double burst)
    : per_second_{per_second}, burst_{seconds(burst / per_second)} {}

RateLimit::Duration RateLimit::delay_of(double cost, Time now) {
  const std::lock_guard lock{mutex_};
  paid_until_ = std::max(paid_until_, now) + seconds(cost / per_second_);
  return std::max(Duration::zero(), paid_until_ - burst_ - now);
}

ClientLimits::Limits& ClientLimits::of(const std::string& client) {
  const std::lock_guard lock{mutex_};
  const auto known = clients_.find(client);
  if (known != clients_.end()) {
    return known->second;
  }
  return clients_.size() < max_clients ? clients_[client] : others_;
}

namespace {
constexpr int max_streams = 8;                 // of each role
constexpr const char* threads = "64";          // one for each open stream, the rest for requests
constexpr long long max_body_bytes = 262'144;  // a form of ten texts, four bytes a character
constexpr std::chrono::milliseconds frame{16};
constexpr std::chrono::seconds keep_alive_interval{3};

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw core::InvalidInput{"--console: no random numbers are available"};
  }
  std::string token;
  for (const unsigned char byte : bytes) {
    token += fmt::format("{:02x}", byte);
  }
  return token;
}

// In a time that does not tell how much of it was right.
bool is_same(std::string_view one, std::string_view other) {
  unsigned difference = one.size() == other.size() ? 0U : 1U;
  for (std::size_t i = 0; i < one.size() && i < other.size(); ++i) {
    difference |= static_cast<unsigned>(one[i] ^ other[i]);
  }
  return difference == 0U;
}

std::string header(mg_connection* connection, const char* name) {
  const char* const value = mg_get_header(connection, name);
  return value == nullptr ? "" : value;
}

constexpr const char* common_headers =
    "Cache-Control: no-store\r\n"
    "Content-Security-Policy: default-src 'self'; img-src 'self' data:; frame-ancestors 'none'\r\n"
    "X-Content-Type-Options: nosniff\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n";

bool send_all(mg_connection* connection, const std::string& text) {
  return mg_write(connection, text.data(), text.size()) == static_cast<int>(text.size());
}

int send(mg_connection* connection, const Reply& reply) {
  const char* const reason = mg_get_response_code_text(connection, reply.status);
  send_all(connection, fmt::format("HTTP/1.1 {} {}\r\n{}Content-Type: {}\r\nContent-Length: "
                                   "{}\r\nConnection: close\r\n\r\n{}",
                                   reply.status, reason, common_headers, reply.media_type,
                                   reply.body.size(), reply.body));
  return reply.status;
}

Reply refusal(int status) {
  return {status, "text/plain; charset=utf-8", "Not available.\n"};
}

// nullopt: too long, or not whole.
std::optional<std::string> body_of(mg_connection* connection) {
  const long long length = mg_get_request_info(connection)->content_length;
  if (length < 0 || length > max_body_bytes) {
    return std::nullopt;
  }
  std::string body(static_cast<std::size_t>(length), '\0');
  std::size_t have = 0;
  while (have < body.size()) {
    const int count = mg_read(connection, body.data() + have, body.size() - have);
    if (count <= 0) {
      return std::nullopt;
    }
    have += static_cast<std::size_t>(count);
  }
  return body;
}

// The library's threads have 100 kB of stack, which parsers and exceptions can exceed.
template <class Work>
Reply on_full_stack(Work work) {
  return std::async(std::launch::async, std::move(work)).get();
}

void wait_for(RateLimit& limit, double cost) {
  std::this_thread::sleep_for(limit.delay_of(cost, std::chrono::steady_clock::now()));
}

class OpenPage {
 public:
  OpenPage(ConsoleApi& api, Role role) : api_{api}, role_{role} { api_.page_opened(role_); }
  ~OpenPage() { api_.page_closed(role_); }
  OpenPage(const OpenPage&) = delete;
  OpenPage& operator=(const OpenPage&) = delete;
  OpenPage(OpenPage&&) = delete;
  OpenPage& operator=(OpenPage&&) = delete;

 private:
  ConsoleApi& api_;
  Role role_;
};

// The haptic loop and the recorder come first, also where no real-time priority was granted.
void* begin_thread_at_low_priority(const mg_context* /*context*/, int /*kind*/) {
  constexpr int nice = 10;
  setpriority(PRIO_PROCESS, 0, nice);
  return nullptr;
}

// The door of every request, also of those that the library would answer by itself (WebSockets,
// preflights): it does so on a stack that is too small for it.
using Door = int (*)(mg_connection* connection);

int refuse(mg_connection* connection) {
  return send(connection, refusal(503));
}

// What is no request at all.
int refuse_error(mg_connection* connection, int status, const char* /*message*/) {
  try {
    send(connection, refusal(status));
  } catch (const std::exception&) {  // none may leave a callback of C
  }
  return 0;
}

// Throws InvalidInput if it cannot be listened to.
mg_context* listening_at(const ServerAddress& address, Door door, void* user) {
  const std::string listening = fmt::format("{}:{}", address.host, address.port);
  std::vector<const char*> options{"listening_ports",
                                   listening.c_str(),
                                   "num_threads",
                                   threads,
                                   "request_timeout_ms",
                                   "500",  // so long an idle connection keeps others waiting
                                   "max_request_size",
                                   "16384",
                                   "enable_directory_listing",
                                   "no",
                                   nullptr};
  mg_callbacks callbacks{};
  callbacks.init_thread = begin_thread_at_low_priority;
  callbacks.begin_request = door;
  callbacks.http_error = refuse_error;
  callbacks.log_message = [](const mg_connection*, const char*) { return 1; };
  mg_context* const context = mg_start(&callbacks, user, options.data());
  if (context == nullptr) {
    throw core::InvalidInput{
        fmt::format("--console: {} cannot be listened to (is the port in use, is it an IPv4 "
                    "address of this machine?)",
                    listening)};
  }
  return context;
}
}  // namespace

void check_can_listen(const ServerAddress& address) {
  if (address.host == "0.0.0.0" || address.host == "::" || address.host == "[::]") {
    throw core::InvalidInput{
        "--listen: name one address of this machine; pages are served under no other"};
  }
  mg_context* const trial = listening_at(address, refuse, nullptr);
  mg_stop(trial);
}

ConsoleServer::ConsoleServer(ServerAddress address, ConsoleApi& api)
    : address_{std::move(address)}, api_{api} {
  for (std::string& token : tokens_) {
    token = random_token();
  }
  context_ = listening_at(address_, &ConsoleServer::handle, this);
  mg_server_port port{};
  mg_get_server_ports(context_, 1, &port);
  address_.port = port.port;
  is_open_ = true;
}

ConsoleServer::~ConsoleServer() {
  is_closing_ = true;
  mg_stop(context_);
}

std::string ConsoleServer::url(Role role) const {
  return fmt::format("http://{}:{}/{}/", address_.host, address_.port, token(role));
}

int ConsoleServer::handle(mg_connection* connection) {
  auto* const server = static_cast<ConsoleServer*>(mg_get_user_data(mg_get_context(connection)));
  if (!server->is_open_) {
    return refuse(connection);
  }
  try {
    return server->serve(connection);
  } catch (const std::exception&) {  // none may leave a callback of C
    return send(connection, refusal(500));
  }
}

// A page of another site, or a name that leads here (DNS rebinding), gets nothing.
bool ConsoleServer::is_from_here(mg_connection* connection) const {
  const std::string host = header(connection, "Host");
  const std::string origin = header(connection, "Origin");
  const std::string site = header(connection, "Sec-Fetch-Site");
  bool is_known = false;
  for (const std::string& name : {address_.host, std::string{"localhost"}}) {
    is_known = is_known || host == fmt::format("{}:{}", name, address_.port);
  }
  return is_known && (origin.empty() || origin == "http://" + host) && site != "cross-site" &&
         site != "same-site";
}

int ConsoleServer::serve(mg_connection* connection) {
  const mg_request_info* const request = mg_get_request_info(connection);
  const std::string path = request->local_uri == nullptr ? "" : request->local_uri;
  const auto end = path.find('/', 1);
  if (!is_from_here(connection) || end == std::string::npos) {
    return send(connection, refusal(403));
  }
  const std::string given = path.substr(1, end - 1);
  for (const Role role : roles) {
    if (is_same(given, token(role))) {
      return serve(connection, role, path.substr(end + 1));
    }
  }
  return send(connection, refusal(403));
}

int ConsoleServer::serve_get(mg_connection* connection, Role role, const std::string& path,
                             RateLimit& bytes) {
  if (path == "events") {
    stream(connection, role);
    return 200;
  }
  const Reply reply = on_full_stack([&] { return api_.get(role, path); });
  wait_for(bytes, static_cast<double>(reply.body.size()));
  return send(connection, reply);
}

int ConsoleServer::serve(mg_connection* connection, Role role, const std::string& path) {
  const mg_request_info* const request = mg_get_request_info(connection);
  ClientLimits::Limits& limits = limits_.of(
      fmt::format("{} {}", static_cast<int>(role), static_cast<const char*>(request->remote_addr)));
  wait_for(limits.requests, 1.0);
  const std::string method = request->request_method;
  if (method == "GET") {
    return serve_get(connection, role, path, limits.bytes);
  }
  if (method != "POST" || header(connection, "X-Tapstudy") != "1") {
    return send(connection, refusal(405));
  }
  if (path == "alive") {
    return send(connection, api_.post_alive(role));
  }
  if (path == "input") {
    const auto body = body_of(connection);
    return send(connection,
                body ? on_full_stack([&] { return api_.post_input(role, *body); }) : refusal(413));
  }
  return send(connection, refusal(405));
}

// Until the page has gone, newer ones have taken its place, or it is so slow that its connection is
// full for too long: it then connects again and gets the latest.
void ConsoleServer::stream(mg_connection* connection, Role role) {
  std::atomic<int>& opened = streams_.at(static_cast<std::size_t>(role));
  const int number = ++opened;
  const OpenPage open_page{api_, role};
  bool is_there =
      send_all(connection, fmt::format("HTTP/1.1 200 OK\r\n{}Content-Type: text/event-stream\r\n"
                                       "Connection: close\r\n\r\nretry: 500\n\n",
                                       common_headers));
  SentToPage sent;
  auto last = std::chrono::steady_clock::now();
  while (is_there && !is_closing_ && number > opened - max_streams) {
    std::string events = api_.events(role, sent);
    const auto now = std::chrono::steady_clock::now();
    if (events.empty() && now - last > keep_alive_interval) {
      events = ": \n\n";
    }
    if (!events.empty()) {
      is_there = send_all(connection, events);
      last = now;
    }
    std::this_thread::sleep_for(frame);
  }
}
}  // namespace tapstudy::runner
