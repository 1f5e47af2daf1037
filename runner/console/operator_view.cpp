#include "runner/console/operator_view.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/error.hpp"
#include "core/haptics/haptic_state.hpp"
#include "device/device.hpp"
#include "runner/console/page_json.hpp"
namespace tapstudy::runner {
namespace {
constexpr std::int64_t kept_steps = 600;
constexpr auto step_ns = static_cast<std::int64_t>(1e9 * LiveView::step_s);
}  // namespace

void LiveView::begin_trial() {
  const std::lock_guard lock{mutex_};
  totals_.contacts = 0;
  was_touching_ = false;
  last_tick_ns_.reset();
  has_step_ = false;
}

void LiveView::add(const core::TraceSample& sample) {
  if (sample.fault != core::TickFault::none) {
    return;  // its position may be NaN
  }
  const auto& [x, y, z] = sample.force_n;
  const std::lock_guard lock{mutex_};
  const double interval_s =
      1e-9 * static_cast<double>(sample.t_ns - last_tick_ns_.value_or(sample.t_ns));
  const Step step{std::hypot(x, y, z), core::Vec3{sample.position_m.data()}, interval_s};
  last_tick_ns_ = sample.t_ns;
  pointer_ = {core::Vec3{sample.position_m.data()}, sample.touching, sample.alternative,
              pointer_.tick + 1};
  ++totals_.ticks;
  totals_.late += sample.late ? 1 : 0;
  totals_.contacts += sample.touching && !was_touching_ ? 1 : 0;
  was_touching_ = sample.touching;
  if (has_step_ && sample.t_ns >= step_ends_ns_) {
    ring_.resize(kept_steps);
    ring_[static_cast<std::size_t>(ended_steps_ % kept_steps)] = step_;
    ++ended_steps_;
    has_step_ = false;
  }
  if (has_step_) {
    const bool is_lower = core::along_normal(step.lowest_m) < core::along_normal(step_.lowest_m);
    step_ = {std::max(step_.force_n, step.force_n), is_lower ? step.lowest_m : step_.lowest_m,
             std::max(step_.interval_s, step.interval_s)};
  } else {
    step_ = step;
    step_ends_ns_ = sample.t_ns - sample.t_ns % step_ns + step_ns;
    has_step_ = true;
  }
}

LiveView::Pointer LiveView::pointer() const {
  const std::lock_guard lock{mutex_};
  return pointer_;
}

LiveView::Totals LiveView::totals() const {
  const std::lock_guard lock{mutex_};
  return totals_;
}

LiveView::Steps LiveView::since(std::int64_t begin) const {
  const std::lock_guard lock{mutex_};
  Steps found{ended_steps_, {}};
  const std::int64_t oldest = std::max<std::int64_t>(0, ended_steps_ - kept_steps);
  for (std::int64_t i = std::max(begin, oldest); i < ended_steps_; ++i) {
    found.steps.push_back(ring_[static_cast<std::size_t>(i % kept_steps)]);
  }
  return found;
}

namespace {
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

// Beside what is said of the force.
std::vector<std::string> warnings_of(const SessionInView& session, const DeskView& desk) {
  std::vector<std::string> warnings{session.last_fault};
  if (!desk.device_says.empty()) {
    warnings.push_back("The device says: " + desk.device_says);
  }
  std::erase(warnings, "");
  return warnings;
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
      {"progress", desk.trial ? progress_json(desk.trial->prompt.progress) : Json{}},
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
      {"waits_for", desk.held_by},
      {"warnings", Json::array()}};
  if (desk.force == ForceState::unknown) {
    json["warnings"].push_back(device::force_may_be_on);
  }
  for (const std::string& warning : warnings_of(session, desk)) {
    json["warnings"].push_back(warning);
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

namespace {
constexpr std::size_t columns = 25;
constexpr std::array<const char*, 8> bars{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};

// The largest value of each column, between the least and the greatest of all.
std::string curve(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax(values);
  const double length = std::max(high - low, 1e-12);
  const std::size_t shown = std::min(columns, values.size());
  const auto at = [&](std::size_t column) {
    return values.begin() + static_cast<std::ptrdiff_t>(column * values.size() / shown);
  };
  std::string text;
  for (std::size_t column = 0; column < shown; ++column) {
    const double share = (*std::max_element(at(column), at(column + 1)) - low) / length;
    text += bars.at(std::min(bars.size() - 1, static_cast<std::size_t>(share * bars.size())));
  }
  return text;
}

// The stimulus only where the operator is not blind.
std::string alternative_text(const TrialInView& view, std::size_t index, bool is_felt,
                             bool is_blind) {
  const auto& labels = view.prompt.alternative_labels;
  const protocols::Alternative& alternative = view.trial.alternatives[index];
  std::string text = labels.empty() ? "" : labels[index];
  if (!is_blind) {
    text += (text.empty() ? "" : " ") + alternative.stimulus;
    text += alternative.values.empty() ? "" : ", " + protocols::described(alternative.values);
  }
  return text + (is_felt && labels.size() > 1 ? " (felt)" : "");
}

std::string trial_text(const DeskView& desk, bool is_blind) {
  const TrialInView& view = *desk.trial;
  std::vector<std::string> presented;
  for (std::size_t i = 0; i < view.trial.alternatives.size(); ++i) {
    presented.push_back(alternative_text(view, i, i == desk.current, is_blind));
  }
  const std::string shown = fmt::format("{}", fmt::join(presented, "; "));
  return fmt::format("  trial {} of {}, {}'{}'{}\n{}", view.prompt.number, view.prompt.total,
                     view.trial.is_practice ? "practice " : "", view.trial.block,
                     view.attempt > 1 ? fmt::format(", attempt {}", view.attempt) : "",
                     shown.empty() ? "" : fmt::format("  presented: {}\n", shown));
}

std::string force_text(ForceState force) {
  switch (force) {
    case ForceState::off:
      return "force off";
    case ForceState::unknown:
      return device::force_may_be_on;
    default:
      return "force on";
  }
}

std::string masking_text(const MaskingInView& masking) {
  return fmt::format("  masking noise: {}, {:.1f} dB FS, {} underruns\n",
                     masking.is_playing ? "playing" : "silent", masking.level_db_fs,
                     masking.underruns);
}
}  // namespace

std::string status_text(const SessionInView& session, const DeskView& desk,
                        const LiveView::Totals& totals) {
  std::string text = fmt::format("{} ({}), {}{}\n", session.participant_id, session.mode,
                                 session.state, desk.is_paused ? ", paused" : "");
  text += desk.trial ? trial_text(desk, session.is_blind) : "";
  if (desk.last_answer) {
    text += fmt::format("  last answer: trial {}{}\n", desk.last_answer->trial.number,
                        session.is_blind ? "" : ", " + desk.last_answer->response);
  }
  text += fmt::format("  contacts: {}; late ticks: {} of {}\n  {}: {}\n", totals.contacts,
                      totals.late, totals.ticks, session.device, force_text(desk.force));
  text += session.masking ? masking_text(*session.masking) : "";
  text += session.has_participant_page ? "" : "  the participant's page is not open\n";
  for (const std::string& warning : warnings_of(session, desk)) {
    text += fmt::format("  {}\n", warning);
  }
  text += desk.held_by.empty() ? "" : fmt::format("  {} (then: resume)\n", desk.held_by);
  return text;
}

std::string live_line(const LiveView::Steps& steps, const LiveView::Totals& totals,
                      double surface_along_normal_m) {
  if (steps.steps.empty()) {
    return "  the loop is at rest\n";
  }
  std::vector<double> force_n;
  std::vector<double> height_mm;
  double longest_s = 0.0;
  for (const LiveView::Step& step : steps.steps) {
    force_n.push_back(step.force_n);
    height_mm.push_back(1e3 * (core::along_normal(step.lowest_m) - surface_along_normal_m));
    longest_s = std::max(longest_s, step.interval_s);
  }
  const auto [low_mm, high_mm] = std::ranges::minmax(height_mm);
  return fmt::format(
      "  force {} up to {:.2f} N, height {} {:.1f} to {:.1f} mm, contacts {}, late {}, longest "
      "interval {:.1f} ms\n",
      curve(force_n), std::ranges::max(force_n), curve(height_mm), low_mm, high_mm, totals.contacts,
      totals.late, 1e3 * longest_s);
}
}  // namespace tapstudy::runner
