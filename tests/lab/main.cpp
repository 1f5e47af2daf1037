// A laboratory in a box: tapstudy, unmodified, in a process of its own, on a kernel that is mocked
// (umockdev must be preloaded), with simulated SPIDARs plugged in and somebody at the terminal who
// holds the grip in the middle when asked to, taps while a trial runs, and answers at random.
//
//   tapstudy_lab REPORT.json [options] -- PROGRAM ARGUMENT...
#include <fcntl.h>
#include <linux/capability.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "lab/mocked_board.hpp"
#include "lab/processes.hpp"
using namespace tapstudy;
using lab::MockedBoard;

namespace {
constexpr int exchanges_a_trial = 500;
constexpr int exchanges_to_home = 300;
constexpr int exchanges_a_tap = 200;
constexpr int firm_pull_dac_counts = 50;  // more than the tension of strings at rest
constexpr int enough_without_force = 51;
constexpr unsigned max_run_s = 90;

struct Options {
  std::string report;
  int boards{1};
  double tick_s{2e-3};
  bool is_forbidden{false};
  // Troubles come in that trial, once a string is pulled; 0: never.
  int kill_in_trial{0};
  int signal{SIGKILL};
  int stop_in_trial{0};
  int kill_guardian_in_trial{0};
  int unplug_in_trial{0};
  int amplifier_off_in_trial{0};
  int halt_in_trial{0};
  int hang_in_trial{0};
  int nak_in_trial{0};
  bool is_silent{false};
  bool answers_nonsense{false};
  std::vector<std::string> command;
};

struct Pipe {
  std::array<int, 2> ends{};
  Pipe() {
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
      throw std::runtime_error{"no pipe"};
    }
  }
};

class Lab {
 public:
  explicit Lab(const Options& options) : options_{options}, bed_{umockdev_testbed_new()} {
    for (int i = 0; i < options.boards; ++i) {
      plug_in_another();
    }
  }
  ~Lab() {
    boards_.clear();
    g_object_unref(bed_);
  }
  Lab(const Lab&) = delete;
  Lab& operator=(const Lab&) = delete;
  Lab(Lab&&) = delete;
  Lab& operator=(Lab&&) = delete;

  int run() {
    start();
    attend();
    int status = 0;
    waitpid(child_, &status, 0);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    if (stopped_.joinable()) {
      stopped_.join();
    }
    nlohmann::json report{{"exit_code", code},
                          {"requests_before_trouble", requests_before_trouble_.load()},
                          {"without_force_while_stopped", without_force_while_stopped_.load()}};
    for (const auto& board : boards_) {
      const MockedBoard::Log log = board->log();
      report["boards"].push_back(
          {{"requests", log.requests},
           {"max_dac_counts", log.max_dac_counts},
           {"requests_without_force_at_the_end", log.requests_without_force_at_the_end}});
    }
    std::ofstream{options_.report} << report.dump(2) << '\n';
    return code;
  }

 private:
  void plug_in_another() {
    const int i = static_cast<int>(boards_.size());
    auto& board = boards_.emplace_back(std::make_unique<MockedBoard>(
        bed_, 7 + i, [this, i](int exchange) { after_exchange(i, exchange); }));
    board->with_hardware([&](testing::SimulatedSpidar& spidar) {
      spidar.turn_rotary_switch_to(3 + i);
      spidar.pass_with_each_request(options_.tick_s);
      spidar.start_counters_at(65'000);
      if (options_.answers_nonsense) {
        spidar.echo_wrongly();
      }
    });
    if (options_.is_silent) {
      board->fall_silent();
    }
    board->plug_in();
    if (options_.is_forbidden) {
      g_autofree gchar* root = umockdev_testbed_get_root_dir(bed_);
      chmod((root + board->node()).c_str(), 0);
    }
  }

  // Root may open what nobody may, unless it has given that right away.
  void start() {
    child_ = fork();
    if (child_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);  // nothing answers it any more
      dup2(keyboard_.ends[0], STDIN_FILENO);
      dup2(screen_.ends[1], STDERR_FILENO);
      if (options_.is_forbidden) {
        prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE);
        prctl(PR_CAPBSET_DROP, CAP_DAC_READ_SEARCH);
      }
      std::vector<char*> words;
      for (const std::string& word : options_.command) {
        words.push_back(const_cast<char*>(word.c_str()));
      }
      words.push_back(nullptr);
      execv(words.front(), words.data());
      _exit(127);
    }
    close(keyboard_.ends[0]);
    close(screen_.ends[1]);
  }

  // Until tapstudy and its guardian have let go of the screen.
  void attend() {
    std::array<char, 512> bytes{};
    while (true) {
      pollfd waiting{screen_.ends[0], POLLIN, 0};
      const int ready = poll(&waiting, 1, 10);
      if (ready > 0) {
        const ssize_t count = read(screen_.ends[0], bytes.data(), bytes.size());
        if (count <= 0) {
          return;
        }
        unanswered_.append(bytes.data(), static_cast<std::size_t>(count));
        fwrite(bytes.data(), 1, static_cast<std::size_t>(count), stderr);
      }
      answer();
    }
  }

  void answer() {
    if (unanswered_.ends_with("press Enter. ")) {
      if (unanswered_.find("not there yet") != std::string::npos) {
        plug_in_another();
      }
      is_tapping_ = false;
      switch_amplifier(true);
      if (options_.nak_in_trial > 0 || options_.hang_in_trial > 0) {
        boards_.front()->take_again();
      }
      boards_.back()->set_heir(guardian());  // the device may have been opened anew
      type("\n");
    } else if (unanswered_.ends_with("type resume.\n")) {  // a session with pages
      boards_.back()->set_heir(guardian());
      is_tapping_ = false;
      type("resume\n");
      taps_from_exchange_ = exchange_ + exchanges_to_home;
    } else if (unanswered_.ends_with("> ")) {
      if (!is_tapping_.exchange(true)) {
        trial_began_ = exchange_.load();
        trial_ = answers_ + 1;  // one that was interrupted comes again
      } else if (exchange_ >= trial_began_ + exchanges_a_trial) {
        is_tapping_ = false;
        type(std::to_string(1 + dice_() % 4) + "\n");
        ++answers_;
      }
    }
  }
  void type(const std::string& text) {
    unanswered_.clear();
    fwrite(text.data(), 1, text.size(), stderr);
    if (write(keyboard_.ends[1], text.data(), text.size()) < 0) {
      perror("keyboard");
    }
  }

  void switch_amplifier(bool is_on) {
    boards_.front()->with_hardware(
        [is_on](testing::SimulatedSpidar& spidar) { spidar.switch_amplifier(is_on); });
  }

  // Not while it waits for the mocked kernel: program and guardian share the connection, and one
  // would take the other's answer.
  static void stop_at_rest(pid_t process) {
    constexpr int patience = 1000;
    for (int i = 0; i < patience; ++i) {
      kill(process, SIGSTOP);
      std::this_thread::sleep_for(std::chrono::milliseconds{1});
      if (lab::is_at_rest(process)) {
        return;
      }
      kill(process, SIGCONT);
      std::this_thread::sleep_for(std::chrono::microseconds{1300});
    }
  }

  // As Ctrl-Z does. The program finds out what became of its loop before the guardian goes on.
  void suspend_for_a_while() {
    stop_at_rest(child_);
    std::this_thread::sleep_for(std::chrono::seconds{1});
    const auto without_force = [this] {
      return boards_.front()->log().requests_without_force_at_the_end;
    };
    constexpr int patience = 20'000;
    for (int i = 0; i < patience && without_force() < enough_without_force; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds{1});  // the guardian may be slow
    }
    without_force_while_stopped_ = without_force();
    const pid_t heir = guardian();
    stop_at_rest(heir);
    kill(child_, SIGCONT);
    std::this_thread::sleep_for(std::chrono::milliseconds{100});
    kill(heir, SIGCONT);
  }

  pid_t guardian() const { return lab::youngest_child(child_); }

  // The plate's face lies in the middle; up is +y in the frame of the maker.
  void after_exchange(int board, int exchange) {
    exchange_ = exchange;
    if (exchange == taps_from_exchange_) {
      is_tapping_ = true;
    }
    if (exchange == 1) {
      boards_.at(static_cast<std::size_t>(board))->set_heir(guardian());
    }
    const bool is_down = exchange / (exchanges_a_tap / 2) % 2 == 1;
    const double height_m = !is_tapping_ ? 0.0 : is_down ? -0.006 : 0.006;
    boards_.at(static_cast<std::size_t>(board))
        ->with_hardware([&](testing::SimulatedSpidar& spidar) {
          spidar.hold_at({0.0, height_m, 0.0});
        });
    if (board > 0) {
      return;  // trouble comes to the first
    }
    if (const MockedBoard::Log log = boards_.front()->log();
        requests_before_trouble_ == 0 && is_tapping_ && log.dac_counts > firm_pull_dac_counts) {
      trouble(log.requests);
    }
  }

  // However late this process and the program are, a string is pulled now.
  void trouble(int requests) {
    const auto come = [&](int in_trial, const auto& act) {
      if (in_trial > 0 && in_trial == trial_) {
        requests_before_trouble_ = requests;
        act();
      }
    };
    MockedBoard& board = *boards_.front();
    come(options_.kill_in_trial, [&] { kill(child_, options_.signal); });
    come(options_.stop_in_trial,
         [&] { stopped_ = std::thread{[this] { suspend_for_a_while(); }}; });
    come(options_.kill_guardian_in_trial, [&] { kill(guardian(), SIGKILL); });
    come(options_.unplug_in_trial, [&] { board.unplug(); });
    come(options_.halt_in_trial, [&] { board.halt(); });
    come(options_.hang_in_trial, [&] { board.hang(); });
    come(options_.nak_in_trial, [&] { board.stop_taking(); });
    come(options_.amplifier_off_in_trial, [&] { switch_amplifier(false); });
  }

  Options options_;
  UMockdevTestbed* bed_;
  std::vector<std::unique_ptr<MockedBoard>> boards_;
  Pipe keyboard_;
  Pipe screen_;
  pid_t child_{-1};
  std::string unanswered_;
  std::atomic<bool> is_tapping_{false};
  std::atomic<int> exchange_{0};
  std::atomic<int> taps_from_exchange_{-1};
  std::atomic<int> trial_{0};  // that is on the screen, from 1
  std::atomic<int> requests_before_trouble_{0};
  int trial_began_{0};
  int answers_{0};
  std::mt19937 dice_{5};
  std::thread stopped_;
  std::atomic<int> without_force_while_stopped_{0};
};
}  // namespace

int main(int count, char** words) {
  alarm(max_run_s);
  Options options;
  CLI::App app{"tapstudy in a laboratory in a box"};
  app.add_option("report", options.report)->required();
  app.add_option("--boards", options.boards);
  app.add_option("--tick-s", options.tick_s);
  app.add_flag("--forbidden", options.is_forbidden);
  app.add_option("--kill-in-trial", options.kill_in_trial);
  app.add_option("--signal", options.signal);
  app.add_option("--stop-in-trial", options.stop_in_trial);
  app.add_option("--kill-guardian-in-trial", options.kill_guardian_in_trial);
  app.add_option("--unplug-in-trial", options.unplug_in_trial);
  app.add_option("--amplifier-off-in-trial", options.amplifier_off_in_trial);
  app.add_option("--halt-in-trial", options.halt_in_trial);
  app.add_option("--hang-in-trial", options.hang_in_trial);
  app.add_option("--nak-in-trial", options.nak_in_trial);
  app.add_flag("--silent", options.is_silent);
  app.add_flag("--nonsense", options.answers_nonsense);
  char** const end = words + count;
  char** const dashes = std::find(words, end, std::string_view{"--"});
  options.command.assign(std::min(dashes + 1, end), end);
  CLI11_PARSE(app, static_cast<int>(dashes - words), words);
  return Lab{options}.run();
}
