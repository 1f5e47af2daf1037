#include "runner/studies/simulated_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>
#include <set>
#include <thread>
#include <vector>

#include "analysis/statistics/resampling/replicates.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "device/device.hpp"
#include "protocols/schedule/groups.hpp"
#include "protocols/schedule/schedule.hpp"
#include "results/store/recorder.hpp"
#include "results/store/store.hpp"
#include "results/store_error.hpp"
#include "runner/session/devices/actuator_card.hpp"
#include "runner/session/devices/device_kind.hpp"
#include "runner/session/devices/rigs.hpp"
#include "runner/session/engine/open_study.hpp"
#include "runner/session/engine/remaining_trials.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/session/engine/trial_engine.hpp"
#include "runner/session/participants/simulated_participant.hpp"
#include "runner/session/trial_loop/real_plates.hpp"
#include "runner/session/trial_loop/trial_loop.hpp"
#include "runner/terminal/logging.hpp"
#include "runner/terminal/process_exit.hpp"
namespace tapstudy::runner {
namespace {
struct SimulatedSession {
  std::int64_t id{};
  protocols::Schedule schedule;
};
// One participant's, in order.
struct SimulatedSessions {
  std::uint64_t seed{};
  std::vector<SimulatedSession> sessions;
};

// One, or those of the protocol in which the participant has trials.
SimulatedSessions add_sessions(SessionPlan plan, const protocols::Protocol& protocol,
                               const protocols::Rig& rig, results::Store& store) {
  const protocols::Schedule whole = make_schedule(protocol, plan.seed, plan.order_index);
  SimulatedSessions added{plan.seed, {}};
  const auto add = [&](const protocols::Schedule& schedule) {
    results::SessionRow row = session_row(plan, protocol, rig, whole);
    store.add_session(row);
    added.sessions.push_back({row.id, schedule});
  };
  for (const protocols::PlannedSession& session : protocol.sessions) {
    plan.planned_session = session.name;
    if (auto part = trials_of_session(whole, protocol, session.name); !part.empty()) {
      add(part);
    }
  }
  if (protocol.sessions.empty()) {
    add(whole);
  }
  return added;
}

// The places of simulated participants follow from their numbers, whatever share they are in.
void check_has_none(results::Store& store, const protocols::Protocol& protocol,
                    const std::string& directory) {
  std::vector<results::SessionRow> sessions = store.sessions();
  std::erase_if(sessions, [](const auto& one) { return one.mode != results::Mode::simulated; });
  if (sessions.empty()) {
    return;
  }
  const bool are_all_done = std::ranges::all_of(sessions, [&](const auto& session) {
    return trials_done(protocol, session.participant_id, store).are_all();
  });
  throw core::InvalidInput{fmt::format(
      "{}: participant '{}' is in this study already{} (choose another --out)", directory,
      sessions.front().participant_id,
      are_all_done ? "" : ", and not all of its trials are simulated (was its program ended?)")};
}

std::vector<SimulatedSessions> add_participants(const SimulatedStudy& study,
                                                const protocols::Protocol& protocol,
                                                const protocols::Rig& rig, results::Store& store) {
  std::vector<SimulatedSessions> participants;
  const SharedOut part = part_of(study.share, study.participants, "participants");
  for (int i = part.first; i < part.end; ++i) {
    SessionPlan plan{
        fmt::format("sim-{:02}", i + 1),
        i,
        i,
        results::Mode::simulated,
        core::derived_seed(study.seed, core::Purpose::participant, static_cast<std::uint64_t>(i)),
        "simulated hand",
        "virtual time",
        ""};
    if (const protocols::Group* const group = group_of(protocol, plan.order_index)) {
      plan.group = results::GroupRow{group->name};
    }
    participants.push_back(add_sessions(plan, protocol, rig, store));
  }
  return participants;
}

// A participant who does not get through practice leaves, as a person would: then false.
bool run_schedule(TrialEngine& engine, const protocols::Schedule& schedule) {
  std::set<int> done;
  try {
    if (const auto interruption = engine.run(schedule, done)) {
      throw device::DeviceError{to_text(*interruption)};
    }
  } catch (const PracticeMissed& missed) {
    warn(missed.what());
    return false;
  }
  return true;
}

struct Tapped {
  std::atomic<std::int64_t> ticks{0};
  std::atomic<int> trials{0};
};

// The parts shared by all sessions.
struct SharedParts {
  const SimulatedStudy& study;
  const protocols::Protocol& protocol;
  const device::LoopSettings& settings;
  const core::ActuatorOutput* actuator;  // nullptr: none that is stored
  ModelLibrary& models;
};

// The same person in every session.
void run_participant(const SharedParts& shared, const SimulatedSessions& of_participant,
                     results::Recorder& recorder, Tapped& tapped) {
  const auto& [study, protocol, settings, actuator, models] = shared;
  SimulatedParticipant participant{protocol, settings, models, of_participant.seed};
  VirtualTrialLoop trial_loop{participant.hand(), settings,
                              study.keeps_traces ? Keep::trace : Keep::events};
  if (actuator != nullptr) {
    trial_loop.use(*actuator, protocol.rendering.dt_s);
  }
  SimulatedReality reality{protocol, models, participant.hand(), settings};
  Operator nobody;
  bool stays = true;
  for (const SimulatedSession& session : of_participant.sessions) {
    const TrialEngine* running = nullptr;
    SessionStates states{session.id, [&running, rate_hz = shared.protocol.rate_hz] {
                           const std::int64_t ticks = running == nullptr ? 0 : running->ticks();
                           return static_cast<double>(ticks) / rate_hz;
                         }};
    TrialEngine engine{{protocol,
                        models,
                        trial_loop,
                        reality,
                        participant,
                        nobody,
                        states,
                        of_participant.seed,
                        {},
                        actuator},
                       recorder};
    running = &engine;
    stays = stays && run_schedule(engine, session.schedule);
    tapped.ticks += engine.ticks();
    tapped.trials += engine.trials();
  }
}

void run_participants(const SharedParts& shared, const std::vector<SimulatedSessions>& participants,
                      results::Store& store, Tapped& tapped) {
  std::optional<Progress> progress;
  if (!shared.study.progress.empty()) {
    progress.emplace(shared.study.progress);
  }
  const core::CountHook count = progress ? progress->count() : core::CountHook{};
  std::atomic<std::size_t> done{0};
  results::Recorder recorder{store};
  // one more than there are processors: each waits while its trial is stored
  const unsigned all = std::max(1U, std::thread::hardware_concurrency()) + 1;
  analysis::parallel_for(participants.size(), shared.study.threads > 0 ? shared.study.threads : all,
                         [&](std::size_t i) {
                           run_participant(shared, participants[i], recorder, tapped);
                           core::tell_count(count, ++done, participants.size());
                         });
}
}  // namespace

namespace {
protocols::Rig rig_of(const SimulatedStudy& study, const protocols::Protocol& protocol) {
  if (study.rig_file.empty()) {
    return simulated_rig();
  }
  protocols::Rig rig = read_rig(study.rig_file);
  if (&kind_of(rig) != &simulated_hand()) {
    throw core::InvalidInput{fmt::format(
        "{}: is no rig of simulated participants (device: simulated_hand)", study.rig_file)};
  }
  check_fits(protocol, rig);
  return rig;
}
}  // namespace

SimulatedTime simulate(const SimulatedStudy& study, const protocols::Protocol& protocol) {
  ModelLibrary models;
  return simulate(study, protocol, models);
}

SimulatedTime simulate(const SimulatedStudy& study, const protocols::Protocol& protocol,
                       ModelLibrary& models) {
  const auto start = std::chrono::steady_clock::now();
  const protocols::Rig rig = rig_of(study, protocol);
  const device::LoopSettings settings = loop_settings(protocol, rig);
  models.build_all(protocol);
  const bool is_new = !results::Store::has_database(study.directory);
  results::Store store = open_study(study.directory, protocol, study.protocol_file);
  std::vector<SimulatedSessions> participants;
  store.in_one_transaction([&] {
    check_has_none(store, protocol, study.directory);
    participants = add_participants(study, protocol, rig, store);
  });
  if (is_new) {
    store.suspend_sync();
  }
  Tapped tapped;
  try {
    const core::ActuatorOutput* const actuator =
        study.keeps_traces && protocol.stores_actuator ? actuator_of(protocol, rig) : nullptr;
    run_participants({study, protocol, settings, actuator, models}, participants, store, tapped);
  } catch (...) {
    try {
      store.resume_sync();
    } catch (const results::StoreError&) {  // NOLINT(bugprone-empty-catch): the first says why
    }
    throw;
  }
  store.resume_sync();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  return {tapped.trials, static_cast<double>(tapped.ticks) / protocol.rate_hz, wall.count()};
}
}  // namespace tapstudy::runner
