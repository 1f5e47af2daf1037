#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "core/placement.hpp"
#include "runner/console/live_view.hpp"
#include "runner/operators/operator_desk.hpp"
namespace tapstudy::runner {
struct MaskingInView {
  bool is_playing{};
  double level_db_fs{};
  std::int64_t underruns{};  // in this trial, or the last
};

struct SessionInView {
  std::string title;
  std::string participant_id;
  std::string mode;
  std::string device;
  bool is_blind{};
  std::string state;
  std::string last_fault;
  bool has_participant_page{};
  std::optional<MaskingInView> masking{};  // unset: the study has none
};

// For the operator's page.
std::string state_json(const SessionInView& session, const DeskView& desk,
                       const LiveView::Totals& totals);
// Heights are above that place along the device's normal.
std::string live_json(const LiveView::Steps& steps, const LiveView::Totals& totals,
                      double surface_along_normal_m, const core::Placement& placement);
std::string refusal_json(const std::string& why);
// Throws InvalidInput if there is none.
std::string command_in(const std::string& json);
}  // namespace tapstudy::runner
