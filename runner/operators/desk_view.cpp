// What the operator sees of the desk.
#include <chrono>

#include "runner/operators/operator_desk.hpp"
namespace tapstudy::runner {
namespace {
bool is_over(const std::shared_future<void>& future) {
  return future.wait_for(std::chrono::seconds{0}) == std::future_status::ready;
}

bool has_succeeded(const std::shared_future<void>& future) {
  try {
    future.get();
    return true;
  } catch (const std::exception&) {
    return false;
  }
}
}  // namespace

// As far as it is stored.
bool OperatorDesk::is_excluded() const {
  bool is = session_.is_excluded;
  for (const Logged& logged : log_) {
    const bool is_about_it = logged.row.action == name(OperatorAction::exclude) ||
                             logged.row.action == name(OperatorAction::include);
    if (is_about_it && is_over(logged.stored) && has_succeeded(logged.stored)) {
      is = logged.row.action == name(OperatorAction::exclude);
    }
  }
  return is;
}

DeskView OperatorDesk::view() const {
  const std::lock_guard lock{mutex_};
  DeskView view{trial_, current_, last_answer_, {}, force_, is_paused_, held_by_, {}};
  for (const Logged& logged : log_) {
    const bool is_stored = is_over(logged.stored) && has_succeeded(logged.stored);
    view.log.push_back({logged.row, is_stored});
    if (is_stored && logged.row.action == name(OperatorAction::correct) && view.last_answer &&
        logged.row.number == view.last_answer->trial.number) {
      view.last_answer->response = logged.row.detail;
    }
  }
  for (const ActionInfo& info : operator_actions()) {
    if (is_possible(info.action)) {
      view.possible.push_back(info.action);
    }
  }
  return view;
}
}  // namespace tapstudy::runner
