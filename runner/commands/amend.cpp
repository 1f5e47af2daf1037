#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <memory>

#include "core/error.hpp"
#include "results/store/recorder.hpp"
#include "results/store/store.hpp"
#include "runner/commands/amend_form.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/session/operators/operator_desk.hpp"
#include "runner/studies/stored_study.hpp"
#include "runner/terminal/session_lock.hpp"
namespace tapstudy::runner {
namespace {
struct AmendOptions {
  std::string directory;
  std::string participant;
  std::string action;
};

// The actions that remain possible once the session is over.
constexpr std::array amendments{OperatorAction::note, OperatorAction::correct,
                                OperatorAction::exclude, OperatorAction::include};

OperatorCommand amendment_in(const std::string& line) {
  const OperatorCommand command = parse_operator_command(line, amendments);
  if (std::ranges::find(amendments, command.action) == amendments.end()) {
    std::vector<std::string_view> names;
    std::ranges::transform(amendments, std::back_inserter(names), name);
    throw core::InvalidInput{fmt::format("{} concerns a running session (after one: {})",
                                         name(command.action), fmt::join(names, ", "))};
  }
  if (command.action == OperatorAction::correct && !command.trial) {
    throw core::InvalidInput{"which trial? \"correct @12 ANSWER\" corrects that of trial 12"};
  }
  const bool is_of_participant =
      command.action == OperatorAction::exclude || command.action == OperatorAction::include;
  if (is_of_participant && command.trial) {
    throw core::InvalidInput{
        fmt::format("{} concerns the participant, not a trial", name(command.action))};
  }
  return command;
}

// Uses the wall clock, because the session's own ended with it.
double seconds_since(const std::string& started_utc) {
  return std::max(0.0, std::difftime(std::time(nullptr), time_from(started_utc)));
}

// The one in which the trial was presented; without a trial the latest.
results::SessionRow session_of(const AmendOptions& options, std::optional<int> trial,
                               results::Store& store) {
  const auto latest = store.latest_session(options.participant);
  if (!latest) {
    throw core::InvalidInput{fmt::format("--participant: there is no '{}' in {}",
                                         options.participant, options.directory)};
  }
  if (!trial) {
    return *latest;
  }
  const auto id = store.session_of_trial(options.participant, *trial);
  if (!id) {
    throw core::InvalidInput{
        fmt::format("trial {} was not presented to participant '{}'", *trial, options.participant)};
  }
  const auto sessions = store.sessions();
  return *std::ranges::find(sessions, *id, &results::SessionRow::id);
}

// The participant's answer to that trial, as the operator would see it had it just been given.
results::JournalledAnswer answer_to(int trial, const AmendOptions& options, results::Store& store) {
  const auto given = store.answers_as_given(options.participant);
  const auto found = std::ranges::find(
      given, trial, [](const results::JournalledAnswer& answer) { return answer.trial.number; });
  if (found == given.end()) {
    throw core::InvalidInput{
        fmt::format("participant '{}' has not answered trial {}", options.participant, trial)};
  }
  return *found;
}

AnswerInView in_view(const results::JournalledAnswer& answer, const protocols::Protocol& protocol) {
  const protocols::Block& block = protocol.block(answer.trial.block);
  return {stored_trial(answer.trial, answer.alternatives, block),
          protocols::answers_of(block, protocol), answer.response.response};
}

struct CheckedStudy {
  results::StudyRow study;
  protocols::Protocol protocol;
};
// Before anything is written, to the journal either.
CheckedStudy checked_study(const std::string& directory) {
  results::Store store = results::Store::open_existing(directory);
  return {store.study(), checked_protocol(store)};
}

void amend(const AmendOptions& options) {
  if (corrects_form(options.action)) {
    fmt::print("participant {}: {}\n", options.participant,
               amend_form(options.directory, options.participant, options.action));
    return;
  }
  const OperatorCommand command = amendment_in(options.action);
  const CheckedStudy checked = checked_study(options.directory);
  const protocols::Protocol& protocol = checked.protocol;
  const ParticipantLock lock{options.directory, options.participant};
  results::Store store = results::Store::open_or_create(options.directory, checked.study);
  const results::SessionRow session = session_of(options, command.trial, store);
  results::Recorder recorder{store};
  OperatorDesk desk{
      {protocol, session.id, store.excluded_participants().contains(options.participant),
       [&] { return seconds_since(session.started_utc); }},
      recorder};
  std::string where;  // numbers count practice, which what participants read does not
  if (command.action == OperatorAction::correct) {
    const results::JournalledAnswer answer = answer_to(*command.trial, options, store);
    where = fmt::format(", block '{}'{}", answer.trial.block,
                        answer.trial.is_practice ? " (practice)" : "");
    desk.answer_is_stored(in_view(answer, protocol));
  } else if (command.trial) {
    desk.trial_was(*command.trial);
  }
  const PostedCommand posted = desk.post(command);
  posted.stored.get();
  fmt::print("participant {}{}: {}\n", options.participant, where, posted.said);
}
}  // namespace

void add_amend(CommandParser& line) {
  Command command = line.add("amend", "Add a note, a correction or an exclusion after a session");
  const auto options = std::make_shared<AmendOptions>();
  command.argument("directory", options->directory, "Directory of a study");
  command.argument(
      "action", options->action,
      "\"note TEXT\", \"correct @TRIAL ANSWER\", \"correct FORM.ITEM ANSWER\", \"exclude "
      "REASON\" or \"include\"");
  command.option("--participant", options->participant, "Participant's id", Need::required);
  command.on_run([options] { amend(*options); });
}
}  // namespace tapstudy::runner
