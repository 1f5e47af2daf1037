#include "runner/studies/study_verification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
#include "protocols/protocol.hpp"
#include "results/journal/journal.hpp"
#include "results/store/row_rules.hpp"
#include "results/store_error.hpp"
#include "runner/session/engine/open_study.hpp"
#include "runner/session/engine/stored_names.hpp"
#include "runner/studies/actuator_verification.hpp"
#include "runner/studies/session_times.hpp"
#include "runner/studies/stored_course.hpp"
#include "runner/studies/stored_study.hpp"
namespace tapstudy::runner {
namespace {
using Lines = std::vector<std::string>;

// Without a protocol it is a rule that knows no block.
results::TaskRule rule_of(const std::optional<protocols::Protocol>& protocol) {
  const auto block_of = [&protocol](const results::TrialRow& trial) -> const protocols::Block* {
    return protocol ? protocol->find_block(trial.block) : nullptr;
  };
  return {[block_of](const results::TrialRow& trial) { return block_of(trial) != nullptr; },
          [block_of](const results::TrialRow& trial,
                     const std::vector<results::AlternativeRow>& alternatives,
                     const std::string& response) {
            const protocols::Block& block = *block_of(trial);
            return block.task->is_correct(stored_trial(trial, alternatives, block), block,
                                          response);
          }};
}

std::optional<protocols::Protocol> protocol_of(results::Store& store, Lines& remarks) {
  try {
    return stored_protocol(store);
  } catch (const core::InvalidInput&) {
    remarks.emplace_back("the study's protocol cannot be read by this version");
    return std::nullopt;
  }
}

// Protocols that differ from the study's in more than texts for people.
void check_changed_texts(results::Store& store, const protocols::Protocol& protocol,
                         Lines& broken) {
  std::set<std::string> seen;
  for (const results::SessionRow& session : store.sessions()) {
    if (!session.protocol_text || !seen.insert(*session.protocol_text).second) {
      continue;
    }
    try {
      const auto changes = changes_in(protocol, *session.protocol_text);
      if (!changes.data_keys.empty()) {
        broken.push_back(
            fmt::format("session {}: its protocol is not the study's but for texts: {} differs",
                        session.id, core::shortened(changes.data_keys.front(), 60)));
      }
    } catch (const core::InvalidInput&) {
      broken.push_back(fmt::format("session {}: its protocol cannot be read", session.id));
    }
  }
}

void check_by_protocol(results::Store& store, const protocols::Protocol& protocol,
                       Verification& found) {
  std::ranges::move(unknown_names(store, protocol), std::back_inserter(found.broken));
  check_changed_texts(store, protocol, found.broken);
  CheckedCourse course = checked_course(store, protocol);
  std::ranges::move(course.wrong, std::back_inserter(found.broken));
  std::ranges::move(course.open_sessions, std::back_inserter(found.remarks));
  if (course.unknown_orders > 0) {
    found.remarks.push_back(
        fmt::format("this version would draw the orders of {} sessions otherwise: their trials are "
                    "not held against them",
                    course.unknown_orders));
  }
}

// Before 0.3 a session came into the journal with its first answer, if it had one.
std::vector<results::SessionRow> comparable_sessions(results::Store& store,
                                                     const results::JournalContent& journal) {
  std::vector<results::SessionRow> sessions = store.sessions();
  std::erase_if(sessions, [&](const results::SessionRow& session) {
    return is_before(session.program_version, 0, 3) &&
           std::ranges::find(journal.sessions, session.id, &results::SessionRow::id) ==
               journal.sessions.end();
  });
  return sessions;
}

// As multisets: a line that stands twice is missing once where it stands once.
void compare(Lines stored, Lines journalled, Verification& found) {
  std::ranges::sort(stored);
  std::ranges::sort(journalled);
  std::ranges::set_difference(stored, journalled, std::back_inserter(found.not_in_journal));
  std::ranges::set_difference(journalled, stored, std::back_inserter(found.not_in_database));
}
}  // namespace

bool Verification::is_sound() const {
  return recomputed.differences.empty() && broken.empty() && study_and_sessions.empty() &&
         not_in_journal.empty() && not_in_database.empty() && journal_fault.empty();
}

Verification verification_of(results::Store& store, const std::string& directory,
                             const core::CountHook& count) {
  Verification found;
  const results::StudyRow study = store.study();
  const std::optional<protocols::Protocol> protocol = protocol_of(store, found.remarks);
  found.recomputed = results::recompute(store, rule_of(protocol), count);
  found.broken = results::broken_rules(store);
  if (protocol) {
    check_by_protocol(store, *protocol, found);
  }
  ActuatorVerification actuators = checked_actuators(store, protocol);
  found.actuator_samples = actuators.samples;
  std::ranges::move(actuators.differences, std::back_inserter(found.recomputed.differences));
  std::ranges::move(actuators.remarks, std::back_inserter(found.remarks));
  CheckedTimes times = checked_session_times(store);
  std::ranges::move(times.wrong, std::back_inserter(found.broken));
  std::ranges::move(times.unlikely, std::back_inserter(found.remarks));
  found.trials = std::ssize(store.trials());
  const results::JournalEntries in_store = store.entries_for_journal();
  found.answers = std::ssize(in_store.answers);
  try {
    const results::JournalContent journal = results::read_journal(directory);
    found.journalled_answers = std::ssize(journal.entries.answers);
    found.study_and_sessions =
        results::differing_study_and_sessions(study, comparable_sessions(store, journal), journal);
    compare(results::to_lines(in_store), results::to_lines(journal.entries), found);
  } catch (const results::StoreError& error) {
    const bool is_unfinished = store.sessions().empty() && !results::Store::has_journal(directory);
    found.journal_fault = is_unfinished ? unfinished_beginning : error.what();
  }
  return found;
}
}  // namespace tapstudy::runner
