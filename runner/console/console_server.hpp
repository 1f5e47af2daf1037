#pragma once
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "runner/console/console_api.hpp"
namespace tapstudy::runner {
// Delays what comes faster than it should: a leaky bucket, by the virtual scheduling of the generic
// cell rate algorithm (ITU-T I.371, annex A). For any number of threads.
class RateLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;
  // burst: what may come at once without a delay.
  RateLimit(double per_second, double burst);
  // How long something of this cost must wait that comes now. It counts from then on.
  Duration delay_of(double cost, Time now);

 private:
  double per_second_;
  Duration burst_;
  std::mutex mutex_;
  Time paid_until_;
};

// The limits of everybody who asks, apart: one who asks too much delays nobody else. Once so many
// have asked, further ones share the limits of one.
class ClientLimits {
 public:
  static constexpr std::size_t max_clients = 64;
  struct Limits {
    // More than a page ever asks would take the processor from the loop.
    RateLimit requests{200.0, 100.0};
    RateLimit bytes{8.0e6, 8.0e6};  // a page with all that it loads, several times
  };
  Limits& of(const std::string& client);

 private:
  std::mutex mutex_;
  std::map<std::string, Limits> clients_;
  Limits others_;
};
}  // namespace tapstudy::runner

struct mg_connection;
struct mg_context;
namespace tapstudy::runner {
struct ServerAddress {
  std::string host{"127.0.0.1"};  // an address of this machine
  int port{0};                    // 0: any that is free
};

// Throws InvalidInput if the address cannot be listened to now.
void check_can_listen(const ServerAddress& address);

// Serves the pages of one session by HTTP. A page's address holds a random token; without it, or
// with a foreign Host or Origin header, nothing is served, and nobody's limit is used. Its threads
// never touch the haptic loop.
class ConsoleServer {
 public:
  // Throws InvalidInput if the address cannot be listened to.
  ConsoleServer(ServerAddress address, ConsoleApi& api);
  ~ConsoleServer();
  ConsoleServer(const ConsoleServer& other) = delete;
  ConsoleServer& operator=(const ConsoleServer& other) = delete;
  ConsoleServer(ConsoleServer&& other) = delete;
  ConsoleServer& operator=(ConsoleServer&& other) = delete;
  std::string url(Role role) const;

 private:
  static int handle(mg_connection* connection);
  int serve(mg_connection* connection);
  int serve(mg_connection* connection, Role role, const std::string& path);
  int serve_get(mg_connection* connection, Role role, const std::string& path, RateLimit& bytes);
  bool is_from_here(mg_connection* connection) const;
  void stream(mg_connection* connection, Role role);
  std::string token(Role role) const { return tokens_.at(static_cast<std::size_t>(role)); }

  ServerAddress address_;
  ConsoleApi& api_;
  std::array<std::string, roles.size()> tokens_;
  std::atomic<bool> is_open_{false};  // its port is known
  std::atomic<bool> is_closing_{false};
  ClientLimits limits_;
  std::array<std::atomic<int>, roles.size()> streams_{};  // ever opened
  mg_context* context_{nullptr};
};
}  // namespace tapstudy::runner
