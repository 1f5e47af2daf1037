#include "runner/console/operator_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "device/device.hpp"
#include "runner/console/answers_json.hpp"
#include "runner/console/parse_json.hpp"
namespace tapstudy::runner {
namespace {
using Json = nlohmann::ordered_json;

std::string dumped(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json json_of(const TrialInView& view, std::size_t current, bool is_blind) {
  Json alternatives = Json::array();
  const auto& labels = view.prompt.alternative_labels;
  for (std::size_t i = 0; i < view.trial.alternatives.size(); ++i) {
    Json alternative{{"label", labels.empty() ? "" : labels[i]}};
    if (!is_blind) {
      const protocols::Alternative& presented = view.trial.alternatives[i];
      alternative["stimulus"] =
          presented.values.empty()
              ? presented.stimulus
              : presented.stimulus + ", " + protocols::described(presented.values);
    }
    alternatives.push_back(alternative);
  }
  return {{"number", view.trial.number},
          {"total", view.prompt.total},
          {"attempt", view.attempt},
          {"block", view.trial.block},
          {"is_practice", view.trial.is_practice},
          {"question", view.prompt.block->question},
          {"answers", answers_json(view.prompt.answers)},
          {"alternatives", alternatives},
          {"current", current}};
}

Json json_of(const AnswerInView& answer, bool is_blind) {
  Json json{{"number", answer.trial.number}, {"answers", answers_json(answer.answers)}};
  if (!is_blind) {
    json["response"] = answer.response;
  }
  return json;
}

Json json_of(const MaskingInView& masking) {
  return {{"is_playing", masking.is_playing},
          {"level_db_fs", masking.level_db_fs},
          {"underruns", masking.underruns}};
}

Json actions_of(const DeskView& desk) {
  Json actions = Json::array();
  for (const ActionInfo& info : operator_actions()) {
    actions.push_back(
        {{"name", info.name},
         {"takes_text", info.text != ActionText::none},
         {"needs_text", info.text == ActionText::required},
         {"is_possible", std::ranges::find(desk.possible, info.action) != desk.possible.end()}});
  }
  return actions;
}

// A correction's text is an answer, or the stimulus behind a blind label.
Json log_of(const DeskView& desk, bool is_blind) {
  Json log = Json::array();
  for (const DeskView::Entry& entry : desk.log) {
    log.push_back(
        {{"t_s", entry.row.t_s},
         {"action", entry.row.action},
         {"text", is_blind && entry.row.action == name(OperatorAction::correct) ? std::string{}
                                                                                : entry.row.detail},
         {"is_stored", entry.is_stored}});
  }
  return log;
}
}  // namespace

std::string state_json(const SessionInView& session, const DeskView& desk,
                       const LiveView::Totals& totals) {
  Json json{
      {"study", session.title},
      {"participant", session.participant_id},
      {"mode", session.mode},
      {"is_blind", session.is_blind},
      {"state", session.state},
      {"progress", desk.trial ? Json{{"done", desk.trial->prompt.progress.done},
                                     {"total", desk.trial->prompt.progress.total}}
                              : Json{}},
      {"trial", desk.trial ? json_of(*desk.trial, desk.current, session.is_blind) : Json{}},
      {"last_answer", desk.last_answer ? json_of(*desk.last_answer, session.is_blind) : Json{}},
      {"actions", actions_of(desk)},
      {"log", log_of(desk, session.is_blind)},
      {"is_paused", desk.is_paused},
      {"participant_page", session.has_participant_page},
      {"device", session.device},
      {"force_is_off",
       desk.force == ForceState::unknown ? Json{} : Json(desk.force == ForceState::off)},
      {"ticks", {{"total", totals.ticks}, {"late", totals.late}}},
      {"masking", session.masking ? json_of(*session.masking) : Json{}},
      {"warnings", Json::array()}};
  const std::string force =
      desk.force == ForceState::unknown ? std::string{device::force_may_be_on} : std::string{};
  for (const std::string& warning : {force, session.last_fault, desk.held_by}) {
    if (!warning.empty()) {
      json["warnings"].push_back(warning);
    }
  }
  return dumped(json);
}

std::string live_json(const LiveView::Steps& steps, const LiveView::Totals& totals,
                      double surface_along_normal_m, const core::Placement& placement) {
  Json x = Json::array();
  Json y = Json::array();
  Json force = Json::array();
  Json height = Json::array();
  Json interval = Json::array();
  for (const LiveView::Step& step : steps.steps) {
    force.push_back(step.force_n);
    const core::Vec3 on_plate_m = placement.to_plate({step.lowest_m, {}}).position_m;
    x.push_back(on_plate_m.x());
    y.push_back(on_plate_m.y());
    height.push_back(core::along_normal(step.lowest_m) - surface_along_normal_m);
    interval.push_back(step.interval_s);
  }
  return dumped({{"t_s", LiveView::step_s * static_cast<double>(steps.end)},
                 {"step_s", LiveView::step_s},
                 {"force_n", force},
                 {"height_m", height},
                 {"x_m", x},
                 {"y_m", y},
                 {"interval_s", interval},
                 {"contacts", totals.contacts}});
}

std::string refusal_json(const std::string& why) {
  return dumped({{"accepted", false}, {"why", why}});
}

std::string command_in(const std::string& text) {
  try {
    return parse_json(text).at("command").get<std::string>();
  } catch (const Json::exception&) {
    throw core::InvalidInput{"is not a command"};
  }
}
}  // namespace tapstudy::runner
