#include "runner/console/operator_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/placement.hpp"
#include "device/device.hpp"
namespace tapstudy::runner {
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
  for (const std::string& warning : {session.last_fault, desk.held_by}) {
    text += warning.empty() ? "" : fmt::format("  {}\n", warning);
  }
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
