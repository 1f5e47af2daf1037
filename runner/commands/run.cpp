#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "core/error.hpp"
#include "results/store/store.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/commands/shared_options.hpp"
#include "runner/console/console_api.hpp"
#include "runner/live_session/live_session.hpp"
#include "runner/session/devices/rigs.hpp"
#include "runner/studies/stored_study.hpp"
#include "runner/terminal/logging.hpp"
#include "runner/terminal/typed_input.hpp"
namespace tapstudy::runner {
namespace {
struct RunOptions {
  std::string protocol;
  std::string participant;
  std::string directory;
  std::string rig;
  std::string seed;
  std::string row;
  std::string group;
  std::string console;
  std::string listen;
  std::string language;
  bool resume{false};
  bool pilot{false};
  bool at_any_time{false};
};

int number_for(const char* option, const std::string& text, int low, int high) {
  const std::optional<int> number = whole_number(text, low, high);
  if (!number) {
    throw core::InvalidInput{
        fmt::format("{}: '{}' is not a number from {} to {}", option, text, low, high)};
  }
  return *number;
}

std::optional<ConsoleRequest> console_of(const RunOptions& options) {
  if (options.console.empty()) {
    if (!options.listen.empty()) {
      throw core::InvalidInput{"--listen: there is no page to serve without --console"};
    }
    return std::nullopt;
  }
  constexpr int max_port = 65535;
  constexpr int first_unprivileged_port = 1024;
  ConsoleRequest request;
  request.address.port = number_for("--console", options.console, 0, max_port);
  if (request.address.port > 0 && request.address.port < first_unprivileged_port) {
    throw core::InvalidInput{
        fmt::format("--console: port {} is reserved (0: any free port, or {} to {})",
                    request.address.port, first_unprivileged_port, max_port)};
  }
  request.language = options.language;
  if (!options.listen.empty()) {
    request.address.host = options.listen;
  }
  return request;
}

SessionRequest request_of(const RunOptions& options) {
  SessionRequest request;
  request.participant_id = options.participant;
  request.mode = options.pilot ? results::Mode::pilot : results::Mode::real;
  request.language = options.language;
  request.group = options.group;
  request.at_any_time = options.at_any_time;
  request.resume = options.resume ? Resume::yes : Resume::no;
  if (!options.seed.empty()) {
    request.seed = seed_from(options.seed, "--seed");
  }
  if (!options.row.empty()) {
    constexpr int max_row = 1'000'000;
    request.order_index = number_for("--row", options.row, 1, max_row) - 1;
  }
  return request;
}

void warn_of_language(const protocols::Protocol& protocol, const RunOptions& options) {
  if (!protocols::is_language(options.language)) {
    throw core::InvalidInput{fmt::format(
        "--language: '{}' is not a language (two small letters, such as en)", options.language)};
  }
  const auto missing = protocols::texts_without(options.language, protocol.translations);
  if (!missing.empty()) {
    warn(fmt::format("texts of the study that are not given in '{}': {}", options.language,
                     fmt::join(missing, ", ")));
  }
  if (options.console.empty() && options.language != "en") {
    warn(fmt::format("the terminal's own words are English{}",
                     pages_speak(options.language)
                         ? fmt::format("; the pages (--console) have '{}'", options.language)
                         : ""));
  } else if (!pages_speak(options.language)) {
    warn(fmt::format("the pages' own words are not given in '{}': English", options.language));
  }
}

// A session goes on in the language that it was begun in, and who comes again reads the same one.
std::string language_of(const RunOptions& options) {
  if (!options.language.empty()) {
    return options.language;
  }
  if (results::Store::is_begun(options.directory)) {
    const auto earlier =
        results::Store::open_existing(options.directory).latest_session(options.participant);
    if (earlier && !earlier->language.empty()) {
      return earlier->language;
    }
  }
  return "en";
}

void run(RunOptions options) {
  options.language = language_of(options);
  protocols::Protocol protocol =
      protocol_to_go_on_with(options.protocol, options.language, options.directory);
  warn_of_language(protocol, options);
  const protocols::Rig rig = options.rig.empty() ? simulated_rig() : read_rig(options.rig);
  protocol.rendering.device_response = rig.vibration_response;
  const LiveOutcome outcome = run_live_session({protocol, options.protocol, rig, options.directory,
                                                request_of(options), console_of(options)});
  if (outcome.ending_answer) {
    fmt::print("participant {} takes no part: answered {}, stored in {}/study.db\n",
               options.participant, *outcome.ending_answer, options.directory);
    return;
  }
  fmt::print("participant {}: all {} trials{} are stored in {}/study.db{}{}\n", options.participant,
             outcome.answered + outcome.without_answer,
             outcome.session.empty() ? "" : " of session " + outcome.session, options.directory,
             outcome.without_answer == 0
                 ? ""
                 : fmt::format(", {} of them without an answer", outcome.without_answer),
             outcome.next_session.empty() ? "" : "; the next is " + outcome.next_session);
}
}  // namespace

void add_run(CommandParser& line) {
  Command command = line.add("run", "One participant's session, at the terminal or a page");
  const auto options = std::make_shared<RunOptions>();
  command.shipped_file("protocol", options->protocol, "Study (YAML)");
  command.option("--participant", options->participant, "Participant's id", Need::required);
  command.option("--out", options->directory, "Directory of the study", Need::required);
  command.shipped_file("--rig", options->rig, "Device and limits (YAML); else a simulated hand");
  command.option("--seed", options->seed, "Seed of the order; drawn and stored if not given");
  command.option("--row", options->row,
                 "Which of the balanced orders, from 1; default: the first unused one");
  command.option("--group", options->group,
                 "Group of a new participant; default: that of the order, which balances groups");
  command.option_with_or_without_value(
      "--console", options->console, "0",
      "Serve one page for the participant and one for the operator, on this port or a free one");
  command.option("--listen", options->listen,
                 "Address of this machine to serve the pages on; default: the loopback only");
  command.option("--language", options->language,
                 "Of what the participant reads: en, ja, …; else English, or as before");
  command.flag("--resume", options->resume, "Resume the participant's last session");
  command.flag("--any-time", options->at_any_time,
               "Begin the next session although it is too early or too late; that is noted");
  command.flag("--pilot", options->pilot, "Mark as a pilot, kept out of reports");
  command.on_run([options] { run(*options); });
}
}  // namespace tapstudy::runner
