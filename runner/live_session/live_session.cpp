#include "runner/live_session/live_session.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <functional>
#include <optional>
#include <random>
#include <utility>

#include "analysis/report/answer_tables/foreign_text.hpp"
#include "core/error.hpp"
#include "device/loop/sleep_inhibitor.hpp"
#include "protocols/schedule/groups.hpp"
#include "runner/live_session/live_trials.hpp"
#include "runner/session/devices/actuator_card.hpp"
#include "runner/session/devices/device_kind.hpp"
#include "runner/session/devices/masking_card.hpp"
#include "runner/session/devices/rigs.hpp"
#include "runner/session/engine/open_study.hpp"
#include "runner/session/engine/planned_sessions.hpp"
#include "runner/session/engine/remaining_trials.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/session/engine/stored_names.hpp"
#include "runner/session/markers/markers.hpp"
#include "runner/session/operators/operator.hpp"
#include "runner/terminal/logging.hpp"
#include "runner/terminal/operator_dialogue.hpp"
#include "runner/terminal/process_exit.hpp"
#include "runner/terminal/session_lock.hpp"
#include "runner/terminal/terminal_output.hpp"
namespace tapstudy::runner {
namespace {
constexpr double measured_s = 0.5;
}

PreflightReport run_preflight(const protocols::Rig& rig, SessionDevice& device,
                              device::Nanoseconds period, const std::string& sleep) {
  PreflightReport report{device.description(),
                         diagnose(rig.realtime, period, measured_s, Under::no_load)};
  report.diagnosis.round_trip = device.round_trip();
  report.diagnosis.release = device.release();
  report.diagnosis.sleep = sleep;
  for (const auto& refusal : report.diagnosis.idle.realtime.refusals) {
    warn(fmt::format("the system refused {} (for what to do run `tapstudy doctor`)", refusal.what));
  }
  const Verdict verdict = verdict_of(report.diagnosis);
  if (!verdict.holds) {
    warn(verdict.words + " (recorded with the session; for details run `tapstudy doctor`)");
  }
  return report;
}

namespace {
std::uint64_t drawn_seed() {
  std::random_device source;
  return (static_cast<std::uint64_t>(source()) << 32U) | source();
}

// Another participant whose id people would read as this one.
std::optional<std::string> participant_alike(const std::string& id, results::Store& store) {
  for (const std::string& other : store.participant_ids()) {
    if (other != id && analysis::first_alike({other, id})) {
      return other;
    }
  }
  return std::nullopt;
}

std::optional<results::SessionRow> earlier_session(const SessionRequest& request,
                                                   const protocols::Protocol& protocol,
                                                   results::Store& store) {
  auto earlier = store.latest_session(request.participant_id);
  if (earlier && request.resume == Resume::no && protocol.sessions.empty()) {
    throw core::InvalidInput{
        fmt::format("participant '{}' is in this study already (go on with "
                    "--resume, or choose another id)",
                    request.participant_id)};
  }
  const auto alike = earlier ? std::nullopt : participant_alike(request.participant_id, store);
  if (!earlier && request.resume == Resume::yes) {
    throw core::InvalidInput{fmt::format("participant '{}' has no session to resume{}",
                                         request.participant_id,
                                         alike ? fmt::format(" ('{}' has)", *alike) : "")};
  }
  if (alike) {
    throw core::InvalidInput{
        fmt::format("participant '{}': this study has a '{}', which reads alike: if it is the same "
                    "person, take that id, else one that differs by more than letter case and "
                    "zeros of numbers",
                    request.participant_id, *alike)};
  }
  return earlier;
}

// The order of a participant who resumes or comes again is the stored one.
void check_keeps_order(const SessionRequest& request, const results::SessionRow& earlier) {
  const char* const keeping = request.resume == Resume::yes ? "--resume" : "a later session";
  if (request.order_index) {
    throw core::InvalidInput{
        fmt::format("--row: cannot be combined with {}, which keeps the order", keeping)};
  }
  if (request.seed && *request.seed != earlier.seed) {
    throw core::InvalidInput{
        fmt::format("--seed: this participant's order was drawn with seed {}, and {} keeps it",
                    earlier.seed, keeping)};
  }
  if (!request.group.empty() && (!earlier.group || request.group != earlier.group->name)) {
    throw core::InvalidInput{fmt::format(
        "--group: this participant is in {}, and {} keeps it",
        earlier.group ? "'" + earlier.group->name + "'" : std::string{"no group"}, keeping)};
  }
}

// nullptr: none is asked for. Throws InvalidInput if there is no such group.
const protocols::Group* asked_group(const SessionRequest& request,
                                    const protocols::Protocol& protocol) {
  if (request.group.empty()) {
    return nullptr;
  }
  if (protocol.groups.empty()) {
    throw core::InvalidInput{"--group: this protocol has no groups"};
  }
  try {
    return &protocol.group(request.group);
  } catch (const core::InvalidInput& error) {
    throw core::InvalidInput{fmt::format("--group: {}", error.what())};
  }
}

// Which order indices are of the group; without one, all.
std::function<bool(int order_index)> orders_of(const protocols::Protocol& protocol,
                                               const protocols::Group* asked) {
  if (asked == nullptr) {
    return {};
  }
  return [&protocol, asked](int order_index) {
    return protocols::group_of(protocol, order_index) == asked;
  };
}

// Of a participant with this order index, of whom there was no session before.
std::optional<results::GroupRow> group_row(const protocols::Protocol& protocol, int order_index,
                                           const protocols::Group* asked) {
  const protocols::Group* const group = protocols::group_of(protocol, order_index);
  if (group == nullptr) {
    return std::nullopt;
  }
  if (asked != nullptr && asked != group) {
    throw core::InvalidInput{fmt::format(
        "--row: order {} is of group '{}', not of '{}' (--group alone takes the first unused order "
        "of its group)",
        order_index + 1, group->name, asked->name)};
  }
  return results::GroupRow{group->name, asked != nullptr};
}

void resume(const results::SessionRow& earlier, const protocols::Protocol& protocol,
            results::Store& store, BegunSession& session) {
  session.earlier.forms = store.form_answers_of(earlier.participant_id);
  if (const auto answer = ending_answer(protocol, session.earlier.forms)) {
    throw core::InvalidInput{
        fmt::format("participant '{}' takes no part: answered {}, which ends the session",
                    earlier.participant_id, *answer)};
  }
  if (earlier.planned_order != session.row.planned_order) {
    throw core::InvalidInput{
        "this program would plan another order than the stored one; go on with the version that "
        "began the study with this participant"};
  }
  session.row.resumes = earlier.id;
  session.resumed_since_utc = earlier.started_utc;
  const auto as_given = store.answers_as_given(earlier.participant_id);
  session.earlier.practice = PracticeRecord{as_given};
  session.earlier.as_given = as_given;
  session.earlier.attempts = store.presentations(earlier.participant_id);
  for (const results::UnansweredTrial& trial : store.unanswered_trials(earlier.participant_id)) {
    session.earlier.requeued.push_back(trial.number);
  }
  const std::vector<int> answered = store.answered_trials(earlier.participant_id);
  session.done = {answered.begin(), answered.end()};
  for (const auto& trials : {given_up_trials(protocol, earlier.participant_id, store),
                             unneeded_trials(protocol, earlier.participant_id, store)}) {
    session.done.insert(trials.begin(), trials.end());
  }
}

// Where the protocol has sessions: which of them it is. Only its trials are left then.
void take_up_session(const SessionRequest& request, const protocols::Protocol& protocol,
                     const std::optional<results::SessionRow>& earlier, results::Store& store,
                     BegunSession& session) {
  if (protocol.sessions.empty()) {
    return;
  }
  const protocols::PlannedSession* planned = nullptr;
  if (earlier && request.resume == Resume::yes) {
    planned = protocol.find_session(earlier->planned_session.value_or(""));
  } else {
    planned =
        &next_session(protocol, session.schedule, session.done, earlier ? &*earlier : nullptr);
    session.row.resumes.reset();
    session.resumed_since_utc.clear();
  }
  // a session that was opened and had no trial is no visit
  const auto visit = store.latest_session(request.participant_id, true);
  const auto problem = visit && request.resume == Resume::no
                           ? too_early_or_late(*planned, *visit, request.now())
                           : std::nullopt;
  if (problem && !request.at_any_time) {
    throw core::InvalidInput{
        fmt::format("participant '{}': {} (--any-time begins it all the same, "
                    "and notes that with the session)",
                    request.participant_id, *problem)};
  }
  session.note = problem ? *problem + " (--any-time)" : "";
  session.row.planned_session = planned->name;
  session.earlier.comes_again = comes_again(*planned, protocol, session.schedule);
  session.schedule = trials_of_session(session.schedule, protocol, planned->name);
  const auto is_of_another = [&](int number) {
    return std::ranges::find(session.schedule, number, &protocols::PlannedTrial::number) ==
           session.schedule.end();
  };
  std::erase_if(session.done, is_of_another);
  std::erase_if(session.earlier.as_given, [&](const results::JournalledAnswer& answer) {
    return is_of_another(answer.trial.number);
  });
}

void add_note(const BegunSession& session, results::Store& store) {
  if (!session.note.empty()) {
    store.add_operator_action(
        {session.row.id, 0.0, std::string{name(OperatorAction::note)}, {}, session.note});
  }
}

bool has_balanced_orders(const protocols::Protocol& protocol) {
  const auto is_balanced = [](const auto& of) { return of.order == protocols::Order::williams; };
  return !protocol.groups.empty() || is_balanced(protocol.block_order) ||
         std::ranges::any_of(protocol.blocks, is_balanced);
}

// Orders are balanced where each is used once: --row can give one again, and who goes on may find
// theirs dealt to somebody who came between.
void tell_who_has_order(int order_index, const std::map<int, std::string>& used) {
  if (const auto other = used.find(order_index); other != used.end()) {
    warn(
        fmt::format("row {} of the balanced orders, which this participant has, is {}'s, too: they "
                    "are balanced only where each is used once",
                    order_index + 1, other->second));
  }
}

protocols::Schedule schedule_of(const SessionPlan& plan, const protocols::Protocol& protocol,
                                const std::optional<results::SessionRow>& earlier) {
  return earlier ? make_schedule(protocol, plan.seed, plan.order_index, earlier->planned_order)
                 : make_schedule(protocol, plan.seed, plan.order_index);
}
}  // namespace

BegunSession begin_session(const SessionRequest& request, const protocols::Protocol& protocol,
                           const protocols::Rig& rig, const PreflightReport& preflight,
                           results::Store& store) {
  SessionPlan plan;
  plan.participant_id = request.participant_id;
  plan.mode = request.mode;
  plan.device = preflight.device;
  plan.scheduler = preflight.diagnosis.idle.realtime.text;
  plan.doctor = to_json(preflight.diagnosis);
  BegunSession session;
  // sessions begun at the same time must not get the same index
  store.in_one_transaction([&] {
    const auto earlier = earlier_session(request, protocol, store);
    if (earlier) {
      check_keeps_order(request, *earlier);
    }
    const protocols::Group* const asked = asked_group(request, protocol);
    const results::Store::OtherParticipants others{
        [&](const std::string& id) { return is_in_session(store.directory(), id); },
        [&](const std::string& id) { return !trials_done(protocol, id, store).are_all(); }};
    const auto place =
        store.place_of(plan.participant_id, plan.mode, others, orders_of(protocol, asked));
    plan.participant_index = place.participant_index;
    plan.order_index =
        earlier ? place.order_index : request.order_index.value_or(place.order_index);
    plan.group = earlier ? earlier->group : group_row(protocol, plan.order_index, asked);
    plan.language = request.language;
    plan.seed = earlier ? earlier->seed : request.seed ? *request.seed : drawn_seed();
    session.schedule = schedule_of(plan, protocol, earlier);
    plan.started = request.now();
    session.row = session_row(plan, protocol, rig, session.schedule);
    if (earlier) {
      resume(*earlier, protocol, store, session);
    }
    take_up_session(request, protocol, earlier, store, session);
    if (has_balanced_orders(protocol)) {
      tell_who_has_order(plan.order_index,
                         store.orders_used_beside(plan.participant_id, plan.mode, others));
    }
    store.add_session(session.row);
  });
  add_note(session, store);
  return session;
}

namespace {
// All checks possible before the device and the store are opened.
void check(const LiveSession& live) {
  check_has_blocks(live.protocol);
  check_participant_id("--participant", live.request.participant_id);
  static_cast<void>(asked_group(live.request, live.protocol));
  check_fits(live.protocol, live.rig);
  if (live.console) {
    check_can_listen(live.console->address);
  }
  if (live.request.resume == Resume::yes) {
    results::Store earlier = results::Store::open_existing(live.directory);  // or there is none
    const results::StudyRow study = study_row(live.protocol, live.protocol_file);
    if (earlier.study().protocol_sha256 == study.protocol_sha256) {
      check_names(earlier, live.protocol);  // before anything is written
    }
  }
}

// A hand that is not a participant's makes the session a rehearsal.
SessionRequest request_of(const LiveSession& live) {
  SessionRequest request = live.request;
  if (!kind_of(live.rig).has_participant() && request.mode == results::Mode::real) {
    request.mode = results::Mode::pilot;
    warn(
        "this session is a rehearsal and stored as a pilot: the hand is simulated or replayed "
        "(--rig names a participant's device)");
  }
  return request;
}

void say_what_was_found(const BegunSession& session) {
  if (const auto& group = session.row.group) {
    say("participant {} is in group {} ({})\n", session.row.participant_id, group->name,
        group->is_given ? "given by the operator" : "assigned by the study's counterbalancing");
  }
  if (const auto& planned = session.row.planned_session) {
    say("participant {} does session {}: {} trials{}\n", session.row.participant_id, *planned,
        session.schedule.size(), session.note.empty() ? "" : "; " + session.note);
  }
  if (session.resumed_since_utc.empty()) {
    return;
  }
  const std::size_t done = session.done.size();
  say("participant {} goes on with the session begun {}: {} of {} trials are done, {} left\n",
      session.row.participant_id, session.resumed_since_utc, done, session.schedule.size(),
      session.schedule.size() - done);
}
}  // namespace

namespace {
std::size_t count_in(const protocols::Schedule& schedule, const std::vector<int>& numbers) {
  return static_cast<std::size_t>(
      std::ranges::count_if(schedule, [&](const protocols::PlannedTrial& trial) {
        return std::ranges::find(numbers, trial.number) != numbers.end();
      }));
}

// "day_2, 24 to 48 h after this one began"; empty: it was the last.
std::string next_session_in_words(const BegunSession& session,
                                  const protocols::Protocol& protocol) {
  if (!session.earlier.comes_again) {
    return "";
  }
  const protocols::Schedule whole =
      make_schedule(protocol, session.row.seed, session.row.order_index, session.row.planned_order);
  const protocols::PlannedSession* next =
      protocol.find_session(session.row.planned_session.value_or("")) + 1;
  while (trials_of_session(whole, protocol, next->name).empty()) {
    ++next;
  }
  const std::string interval = described_interval(*next);
  return next->name + (interval.empty() ? "" : ", " + interval + " after this one began");
}

LiveOutcome outcome_of(const BegunSession& session, const protocols::Protocol& protocol,
                       results::Store& store) {
  const std::string& id = session.row.participant_id;
  const std::size_t given_up = count_in(session.schedule, given_up_trials(protocol, id, store));
  const std::size_t unneeded = count_in(session.schedule, unneeded_trials(protocol, id, store));
  return {session.schedule.size() - given_up - unneeded, given_up,
          ending_answer(protocol, store.form_answers_of(id)),
          session.row.planned_session.value_or(""), next_session_in_words(session, protocol)};
}
}  // namespace

LiveOutcome run_live_session(const LiveSession& live) {
  const device::LoopSettings settings = loop_settings(live.protocol, live.rig);
  check(live);
  ModelLibrary models;
  models.build_all(live.protocol);
  const ParticipantLock lock{live.directory, live.request.participant_id};
  listen_for_stop();
  const NoFlowControl no_flow_control{STDIN_FILENO};
  LineInput input{STDIN_FILENO};
  std::optional<device::SleepInhibitor> inhibitor;
  if (live.rig.has_hardware) {
    inhibitor.emplace();
  }
  TypedCommands commands;
  AskOperator ask_operator = [&](const std::string& task) {
    return asked_and_done(input, commands, "\n" + task + " When that is done (quit stops here),");
  };
  const DeviceRequest device_request{live.protocol, live.rig,
                                     [&](const std::string& task) { return ask_operator(task); }};
  std::unique_ptr<SessionDevice> device = kind_of(live.rig).open(device_request);
  Markers markers{live.rig.markers};
  std::unique_ptr<device::PcmSink> card = open_masking_card(live.protocol, live.rig);
  const core::ActuatorOutput* const actuator = actuator_of(live.protocol, live.rig);
  if (live.protocol.rendering.crossover && actuator == nullptr) {
    warn(
        "the rig has no section 'actuator': what rendering.crossover_hz leaves to one is not "
        "rendered");
  }
  std::unique_ptr<device::ActuatorPlayer> actuated =
      actuator == nullptr ? nullptr : actuator_player(*actuator, live.protocol, live.rig);
  results::Store store = open_study(live.directory, live.protocol, live.protocol_file);
  check_names(store, live.protocol);
  BegunSession session = begin_session(
      request_of(live), live.protocol, live.rig,
      run_preflight(live.rig, *device, settings.period, inhibitor ? inhibitor->outcome() : ""),
      store);
  say_what_was_found(session);
  device->begin_session(session.row.seed);
  const auto masking = masking_player(std::move(card), live.protocol, live.rig, session.row.seed);
  LiveTrials{{live, settings, models, device_request, input, commands, ask_operator, masking.get(),
              actuated, markers, store, session},
             std::move(device)}
      .run();
  return outcome_of(session, live.protocol, store);
}
}  // namespace tapstudy::runner
