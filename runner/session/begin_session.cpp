#include "runner/session/begin_session.hpp"

#include <fmt/format.h>

#include <random>

#include "core/error.hpp"
#include "runner/session/given_up_trials.hpp"
#include "runner/session/participant_lock.hpp"
#include "runner/session/session_row.hpp"
namespace tapstudy::runner {
namespace {
std::uint64_t drawn_seed() {
  std::random_device source;
  return (static_cast<std::uint64_t>(source()) << 32U) | source();
}

std::optional<results::SessionRow> earlier_session(const SessionRequest& request,
                                                   results::Store& store) {
  auto earlier = store.latest_session(request.participant_id);
  if (earlier && request.resume == Resume::no) {
    throw core::InvalidInput{
        fmt::format("participant '{}' is in this study already (go on with "
                    "--resume, or choose another id)",
                    request.participant_id)};
  }
  const auto alike = earlier ? std::nullopt : store.participant_like(request.participant_id);
  if (!earlier && request.resume == Resume::yes) {
    throw core::InvalidInput{fmt::format("participant '{}' has no session to resume{}",
                                         request.participant_id,
                                         alike ? fmt::format(" ('{}' has)", *alike) : "")};
  }
  if (alike) {
    throw core::InvalidInput{fmt::format(
        "participant '{}': this study has a '{}' (ids must differ by more than letter case)",
        request.participant_id, *alike)};
  }
  return earlier;
}

// The order of a participant who resumes is the stored one.
void check_keeps_order(const SessionRequest& request, const results::SessionRow& earlier) {
  if (request.order_index) {
    throw core::InvalidInput{"--row: cannot be combined with --resume, which keeps the order"};
  }
  if (request.seed && *request.seed != earlier.seed) {
    throw core::InvalidInput{fmt::format(
        "--seed: this participant's order was drawn with seed {}, and --resume keeps it",
        earlier.seed)};
  }
}

void resume(const results::SessionRow& earlier, const protocols::Protocol& protocol,
            results::Store& store, BegunSession& session) {
  if (earlier.planned_order != session.row.planned_order) {
    throw core::InvalidInput{
        "--resume: this program would plan another order than the stored "
        "one; resume with the version that began the session"};
  }
  session.row.resumes = earlier.id;
  session.resumed_since_utc = earlier.started_utc;
  const auto as_given = store.answers_as_given(earlier.participant_id);
  session.earlier = {store.filled_forms(earlier.participant_id),
                     PracticeRecord{as_given},
                     as_given,
                     store.presentations(earlier.participant_id),
                     {}};
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
}  // namespace

BegunSession begin_session(const SessionRequest& request, const protocols::Protocol& protocol,
                           const protocols::Rig& rig, const PreflightReport& preflight,
                           results::Store& store) {
  SessionPlan plan;
  plan.participant_id = request.participant_id;
  plan.mode = request.mode;
  plan.device = preflight.device;
  plan.scheduler = preflight.diagnosis.idle.total.realtime;
  plan.doctor = to_json(preflight.diagnosis);
  BegunSession session;
  // sessions begun at the same time must not get the same index
  store.in_one_transaction([&] {
    const auto earlier = earlier_session(request, store);
    if (earlier) {
      check_keeps_order(request, *earlier);
    }
    const auto place = store.place_of(
        plan.participant_id, plan.mode,
        {[&](const std::string& id) { return is_in_session(store.directory(), id); },
         [&](const std::string& id) { return !trials_done(protocol, id, store).are_all(); }});
    plan.participant_index = place.participant_index;
    plan.order_index =
        earlier ? place.order_index : request.order_index.value_or(place.order_index);
    plan.language = request.language;
    plan.seed = earlier ? earlier->seed : request.seed ? *request.seed : drawn_seed();
    session.schedule = make_schedule(protocol, plan.seed, plan.order_index);
    session.row = session_row(plan, protocol, rig, session.schedule);
    if (earlier) {
      resume(*earlier, protocol, store, session);
    }
    store.add_session(session.row);
  });
  return session;
}
}  // namespace tapstudy::runner
