#pragma once
#include <cstdint>
#include <ctime>
#include <optional>
#include <string>

#include "protocols/protocol.hpp"
#include "protocols/rig.hpp"
#include "protocols/schedule/schedule.hpp"
#include "results/rows.hpp"
namespace tapstudy::runner {
// The study's own row, from the protocol's file and the files that it names.
results::StudyRow study_row(const protocols::Protocol& protocol, const std::string& file);
// These files; the row has to live as long. Throws InvalidInput for others.
protocols::ReadFile files_of(const results::StudyRow& study);

// The session data known before the first trial.
struct SessionPlan {
  std::string participant_id;
  int participant_index{};
  int order_index{};
  results::Mode mode{};
  std::uint64_t seed{};
  std::string device;
  std::string scheduler;   // real-time facilities granted
  std::string doctor;      // diagnosis of the machine, JSON
  std::string language{};  // of what the participant reads
  std::optional<results::GroupRow> group{};
  std::optional<std::string> planned_session{};
  std::optional<std::time_t> started{};  // unset: now
};
// As started_utc of a session has it. Throws InvalidInput where it is no such time.
std::time_t time_from(const std::string& utc);
results::SessionRow session_row(const SessionPlan& plan, const protocols::Protocol& protocol,
                                const protocols::Rig& rig, const protocols::Schedule& schedule);

// Throws InvalidInput, which names the option, for an id that is not safe in file names or tables.
void check_participant_id(const std::string& option, const std::string& id);
// Approximate tapping time of a simulated participant in a trial of the block.
double simulated_trial_s(const protocols::Protocol& protocol, const protocols::Block& block);
// Throws InvalidInput if that is so long that the trace would exhaust memory.
void check_trial_length(const protocols::Protocol& protocol);
// Throws InvalidInput if the protocol has nothing to run.
void check_has_blocks(const protocols::Protocol& protocol);
}  // namespace tapstudy::runner
