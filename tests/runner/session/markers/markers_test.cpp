// Markers of a session, received by others.
#include "runner/session/markers/markers.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <lo/lo.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <tuple>

#include "core/error.hpp"
#include "runner/session/engine/session_states.hpp"
#include "runner/session/markers/marker_output.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using results::SessionEventRow;
using runner::Sent;
using testing::TempDirectory;

namespace {
// Both clocks as `date --utc --date @1769850600.5` has them.
const runner::Marker change{{1, 12.25, "faulted", 3, "the device did not reply"},
                            4'000'250'000'000,
                            1'769'850'600'500'000'000};
const runner::Marker between{
    {1, 13.5, "resting", std::nullopt, ""}, 4'001'500'000'000, 1'769'850'601'750'000'000};
const std::string line =
    "12.250000\tfaulted\t3\tthe device did not reply\t4000.250000\t2026-01-31T09:10:00.500000Z\n";
const std::string line_between =
    "13.500000\tresting\t-1\t\t4001.500000\t2026-01-31T09:10:01.750000Z\n";

// liblo aligns arguments to 4 bytes, less than their union asks for.
template <class Value>
Value value_of(const void* argument) {
  Value value{};
  std::memcpy(&value, argument, sizeof value);
  return value;
}

// liblo's own server, on a free port.
class Receiver {
 public:
  using Received = std::tuple<std::string, std::string, double, int, std::string, double, double>;
  Receiver() : server_{lo_server_new(nullptr, nullptr)} {
    REQUIRE(server_ != nullptr);
    lo_server_add_method(
        server_, nullptr, nullptr,
        [](const char* path, const char* types, lo_arg** arguments, int count, lo_message,
           void* to) {
          REQUIRE(count == 5);
          const void* const text = arguments[2];
          const auto utc = value_of<lo_timetag>(arguments[4]);
          constexpr double from_1900_to_1970_s = 2'208'988'800.0;
          static_cast<std::vector<Received>*>(to)->emplace_back(
              path, types, value_of<double>(arguments[0]), value_of<std::int32_t>(arguments[1]),
              static_cast<const char*>(text), value_of<double>(arguments[3]),
              utc.sec - from_1900_to_1970_s + utc.frac / 4'294'967'296.0);
          return 0;
        },
        &received);
  }
  ~Receiver() { lo_server_free(server_); }
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;
  int port() const { return lo_server_get_port(server_); }
  void receive(int count) {
    for (int i = 0; i < count; ++i) {
      REQUIRE(lo_server_recv_noblock(server_, 2000) > 0);
    }
  }
  std::vector<Received> received;

 private:
  lo_server server_;
};

class Descriptor {
 public:
  explicit Descriptor(int number) : number_{number} { REQUIRE(number >= 0); }
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  void close() {
    if (number_ >= 0) {
      ::close(number_);
    }
    number_ = -1;
  }
  std::string read_all() const {
    std::string all(1U << 20U, '\0');
    const ssize_t size = read(number_, all.data(), all.size());
    return all.substr(0, static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  }

 private:
  int number_;
};

std::string new_pipe(const TempDirectory& directory) {
  const std::string path = directory / "pipe";
  REQUIRE(mkfifo(path.c_str(), 0600) == 0);
  return path;
}
int reader_of(const std::string& pipe) {
  return open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
}

// The longest that any of these takes [s].
double slowest_of(int count, const std::function<void()>& task) {
  std::chrono::duration<double> slowest{0.0};
  for (int i = 0; i < count; ++i) {
    const auto begun = std::chrono::steady_clock::now();
    task();
    slowest =
        std::max<std::chrono::duration<double>>(slowest, std::chrono::steady_clock::now() - begun);
  }
  return slowest.count();
}
constexpr double at_once_s = 0.5;
}  // namespace

TEST_CASE("an OSC receiver gets each change with its time, trial and detail", "[runner][markers]") {
  Receiver receiver;
  const auto osc = runner::open_osc_markers({"localhost", receiver.port()});
  CHECK(osc->send(change) == Sent::yes);
  CHECK(osc->send(between) == Sent::yes);
  receiver.receive(2);
  using Received = Receiver::Received;
  CHECK(receiver.received[0] == Received{"/tapstudy/faulted", "disdt", 12.25, 3,
                                         "the device did not reply", 4000.25, 1'769'850'600.5});
  CHECK(receiver.received[1] ==
        Received{"/tapstudy/resting", "disdt", 13.5, -1, "", 4001.5, 1'769'850'601.75});
}

TEST_CASE("a host that is not known is refused before the session", "[runner][markers]") {
  CHECK_THROWS_WITH(runner::open_osc_markers({"no.such.host.invalid", 9000}),
                    Contains("markers.osc.host: 'no.such.host.invalid' is not found"));
}

TEST_CASE("a session's states are told to whoever listens, the first one too",
          "[runner][markers]") {
  std::vector<std::string> told;
  runner::SessionStates states{1, [] { return 2.0; },
                               [&](const SessionEventRow& row) {
                                 told.push_back(fmt::format("{} {}", row.t_s, row.state));
                               }};
  states.enter(runner::SessionState::ready, 4);
  CHECK(told == std::vector<std::string>{"2 begun", "2 ready"});
  CHECK(states.take_events().size() == 2);
}

TEST_CASE("a line stays one line of six columns", "[runner][markers]") {
  runner::Marker odd = change;
  odd.change.detail = "a\tb\nc" + std::string(10'000, 'x');
  const std::string text = runner::line_of(odd);
  CHECK(std::ranges::count(text, '\t') == 5);
  CHECK(std::ranges::count(text, '\n') == 1);
  CHECK(text.size() < 4096);  // PIPE_BUF
}

TEST_CASE("a marker's clocks are those of its change, however late it is sent",
          "[runner][markers]") {
  const auto begun = std::chrono::steady_clock::now() - std::chrono::seconds{3600};
  const runner::Marker early = runner::marker_of({1, 10.0, "impact", 1, ""}, begun);
  const runner::Marker late = runner::marker_of({1, 3500.0, "impact", 1, ""}, begun);
  const std::chrono::nanoseconds begun_ns = begun.time_since_epoch();
  CHECK(early.monotonic_ns == begun_ns.count() + 10'000'000'000);
  CHECK(late.monotonic_ns - early.monotonic_ns == 3'490'000'000'000);
  // as far apart by the other clock, but for its adjustment between two readings
  CHECK(1e-9 * static_cast<double>(late.utc_ns - early.utc_ns) == Approx(3490.0).epsilon(1e-6));
}

TEST_CASE("a file is made, and appended to", "[runner][markers]") {
  const TempDirectory directory;
  const std::string file = directory / "markers.tsv";
  CHECK(runner::open_line_markers(file)->send(change) == Sent::yes);
  CHECK(runner::open_line_markers(file)->send(between) == Sent::yes);
  CHECK(testing::contents(file) == line + line_between);
  testing::write(directory / "notes.txt", "not a marker\n");
  CHECK_THROWS_WITH(runner::open_line_markers(directory / "notes.txt"),
                    Contains("holds something other than markers"));
  CHECK_THROWS_WITH(runner::open_line_markers(directory / "no" + "/such"),
                    Contains("cannot be opened: No such file or directory"));
  CHECK_THROWS_WITH(runner::open_line_markers("/dev/no_such_port"),
                    Contains("cannot be opened: No such file or directory"));
}

TEST_CASE("a line that a full disk cut is finished once there is space, and torn by no other",
          "[runner][markers]") {
  const TempDirectory directory;
  const auto usual_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit usual{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &usual) == 0);
  const auto markers = runner::open_line_markers(directory / "markers.txt");
  const rlimit full{line.size() + 10, usual.rlim_max};
  setrlimit(RLIMIT_FSIZE, &full);
  CHECK(markers->send(change) == Sent::yes);
  CHECK(markers->send(change) == Sent::yes);  // in part
  CHECK(markers->send(between) == Sent::no);
  setrlimit(RLIMIT_FSIZE, &usual);
  std::signal(SIGXFSZ, usual_handler);
  CHECK(markers->send(change) == Sent::yes);
  CHECK(testing::contents(directory / "markers.txt") == line + line + line);
}

TEST_CASE("a serial port is set up raw at 115 200 baud and gets the lines", "[runner][markers]") {
  Descriptor instrument{posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)};
  REQUIRE(grantpt(instrument.number()) == 0);
  REQUIRE(unlockpt(instrument.number()) == 0);
  const auto lines = runner::open_line_markers(ptsname(instrument.number()));
  CHECK(lines->send(change) == Sent::yes);
  CHECK(instrument.read_all() == line);  // with output processing "\n" would be "\r\n"
  termios modes{};
  REQUIRE(tcgetattr(instrument.number(), &modes) == 0);
  CHECK(cfgetospeed(&modes) == B115200);
  CHECK((modes.c_cflag & CSIZE) == CS8);
  CHECK((modes.c_cflag & (PARENB | CSTOPB | CRTSCTS)) == 0U);
}

TEST_CASE("a serial port that nobody empties, or that is pulled out, loses markers at once",
          "[runner][markers]") {
  Descriptor instrument{posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)};
  REQUIRE(grantpt(instrument.number()) == 0);
  REQUIRE(unlockpt(instrument.number()) == 0);
  const auto lines = runner::open_line_markers(ptsname(instrument.number()));
  int taken = 0;
  CHECK(slowest_of(5000, [&] { taken += lines->send(change) == Sent::yes ? 1 : 0; }) < at_once_s);
  CHECK(taken > 10);
  CHECK(taken < 5000);
  std::string got;
  for (int i = 0; i < 100; ++i) {
    got += instrument.read_all();
    lines->send(between);
  }
  got += instrument.read_all();
  for (std::size_t begin = 0; begin < got.size(); begin = got.find('\n', begin) + 1) {
    const std::string one = got.substr(begin, got.find('\n', begin) + 1 - begin);
    REQUIRE((one == line || one == runner::line_of(between)));
  }
  instrument.close();
  CHECK(lines->send(change) == Sent::no);
  CHECK(slowest_of(100, [&] { lines->send(change); }) < at_once_s);
}

TEST_CASE("a pipe without a reader loses markers until one comes, and again when it goes",
          "[runner][markers]") {
  const auto usual_handler = std::signal(SIGPIPE, SIG_IGN);  // as the program has it
  const TempDirectory directory;
  const std::string pipe = new_pipe(directory);
  const auto lines = runner::open_line_markers(pipe);
  CHECK(lines->send(change) == Sent::no);
  Descriptor reader{reader_of(pipe)};
  CHECK(lines->send(change) == Sent::yes);
  CHECK(reader.read_all() == line);
  reader.close();
  CHECK(lines->send(change) == Sent::no);
  Descriptor second{reader_of(pipe)};
  CHECK(lines->send(between) == Sent::yes);
  CHECK(second.read_all() == runner::line_of(between));
  std::signal(SIGPIPE, usual_handler);
}

TEST_CASE("a reader that stops reading delays nobody; what it missed is counted",
          "[runner][markers]") {
  const TempDirectory directory;
  const std::string pipe = new_pipe(directory);
  const Descriptor reader{reader_of(pipe)};
  runner::Markers markers{{std::nullopt, std::nullopt, pipe}};
  constexpr int count = 5000;
  CHECK(slowest_of(count, [&] { markers.send(change); }) < at_once_s);
  const std::string got = reader.read_all();
  CHECK(markers.lost() > 0);
  CHECK(std::ranges::count(got, '\n') + markers.lost() == count);
  CHECK(got.substr(got.size() - line.size()) == line);  // not torn
}
