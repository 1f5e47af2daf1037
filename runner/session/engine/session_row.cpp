#include "runner/session/engine/session_row.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <ctime>

#include "core/error.hpp"
#include "core/files/sha256.hpp"
#include "core/text/plain_text.hpp"
#include "results/export/csv_file.hpp"
#include "runner/build_info/build_info.hpp"
#include "runner/session/participants/planned_taps.hpp"
namespace tapstudy::runner {
namespace {
constexpr double max_trial_ticks = 4e6;
}  // namespace

results::StudyRow study_row(const protocols::Protocol& protocol, const std::string& file) {
  results::StudyRow study{protocol.title, file, protocol.text, core::sha256(protocol.text), {}};
  for (const protocols::SurfaceSource& surface : protocol.surfaces) {
    study.surfaces.push_back({surface.file, surface.sha256, surface.bytes});
  }
  for (const protocols::Picture& picture : protocol.pictures) {
    study.surfaces.push_back({picture.file, core::sha256(*picture.bytes), *picture.bytes});
  }
  return study;
}

protocols::ReadFile files_of(const results::StudyRow& study) {
  return [&](const std::string& file) {
    const auto found = std::ranges::find(study.surfaces, file, &results::SurfaceRow::file);
    if (found == study.surfaces.end()) {
      throw core::InvalidInput{file + ": is not stored with the study"};
    }
    return found->bytes;
  };
}

results::SessionRow session_row(const SessionPlan& plan, const protocols::Protocol& protocol,
                                const protocols::Rig& rig, const protocols::Schedule& schedule) {
  results::SessionRow session;
  session.participant_id = plan.participant_id;
  session.participant_index = plan.participant_index;
  session.order_index = plan.order_index;
  session.mode = plan.mode;
  session.group = plan.group;
  session.seed = plan.seed;
  session.planned_order = protocols::described(schedule);
  session.language = plan.language;
  session.rate_hz = protocol.rate_hz;
  session.rig_text = rig.text;
  session.device = plan.device;
  session.scheduler = plan.scheduler;
  session.doctor = plan.doctor;
  session.program_version = program_version();
  session.git_hash = git_hash();
  session.compiler = compiler();
  session.planned_session = plan.planned_session;
  session.started_utc =
      fmt::format("{:%FT%TZ}", fmt::gmtime(plan.started.value_or(std::time(nullptr))));
  return session;
}

std::time_t time_from(const std::string& utc) {
  std::tm time{};
  if (strptime(utc.c_str(), "%Y-%m-%dT%H:%M:%SZ", &time) == nullptr) {
    throw core::InvalidInput{fmt::format("{} is no time of a session", core::quoted_name(utc))};
  }
  return timegm(&time);
}

void check_participant_id(const std::string& option, const std::string& id) {
  const auto is_allowed = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
  };
  if (id == results::missing_in_csv) {
    throw core::InvalidInput{fmt::format("{}: '{}' means a missing value in tables", option, id)};
  }
  if (id.empty() || id.size() > 64 || !std::ranges::all_of(id, is_allowed)) {
    throw core::InvalidInput{fmt::format(
        "{}: '{}' is not allowed (1 to 64 letters, digits, '-', '_' or '.')", option, id)};
  }
}

double simulated_trial_s(const protocols::Protocol& protocol, const protocols::Block& block) {
  const protocols::SimulatedTapSettings& taps = protocol.simulation.taps;
  const double run_up_m = 0.5 * taps.hover_m;  // at half the speed on average
  const auto scripted = scripted_tap(protocol, block.explore.scripted_taps);
  const double tap_s = scripted ? scripted->duration_s()
                                : (taps.hover_m + run_up_m + taps.press_m) / taps.speed_m_s +
                                      taps.dwell_s + taps.pause_s;
  const double taps_s = tap_s * taps.taps_per_visit * block.task->visits(block, taps);
  if (const auto& intervals = block.explore.intervals) {
    const int visits = block.task->visits(block, taps);
    return visits * intervals->gap_seconds + std::max(taps_s, visits * intervals->seconds);
  }
  return taps_s;
}

void check_trial_length(const protocols::Protocol& protocol) {
  for (const protocols::Block& block : protocol.blocks) {
    const double ticks = simulated_trial_s(protocol, block) * protocol.rate_hz;
    if (ticks > max_trial_ticks) {
      throw core::InvalidInput{fmt::format(
          "block '{}': a simulated trial would take {:.2g} ticks (at most {:.0g}: lower "
          "simulation.taps.taps_per_visit, visits, dwell_s or pause_s, or raise speed_m_s)",
          block.name, ticks, max_trial_ticks)};
    }
  }
}

void check_has_blocks(const protocols::Protocol& protocol) {
  if (protocol.blocks.empty()) {
    throw core::InvalidInput{
        fmt::format("'{}' has no blocks, so there is nothing to run", protocol.title)};
  }
}
}  // namespace tapstudy::runner
