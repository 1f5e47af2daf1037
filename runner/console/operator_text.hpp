#pragma once
#include <string>

#include "runner/console/live_view.hpp"
#include "runner/console/operator_json.hpp"
namespace tapstudy::runner {
// For the operator's terminal: what the operator's page shows, as lines of text.
std::string status_text(const SessionInView& session, const DeskView& desk,
                        const LiveView::Totals& totals);

// One line of the running loop: force and height (above that place along the device's normal) as
// small curves over these steps, with their extremes, and contacts and late ticks.
std::string live_line(const LiveView::Steps& steps, const LiveView::Totals& totals,
                      double surface_along_normal_m);
}  // namespace tapstudy::runner
