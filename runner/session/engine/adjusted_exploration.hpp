#pragma once
#include <algorithm>
#include <optional>
#include <vector>

#include "device/loop/haptic_loop.hpp"
#include "protocols/protocol.hpp"
#include "runner/session/engine/trial_record.hpp"
#include "runner/session/trial_loop/exploration.hpp"
namespace tapstudy::runner {
// An exploration whose last alternative has settings, each rendered by itself: positions of the
// loop from that of the last alternative on are its settings (protocols::rendered). Each setting
// that is chosen is an event, the one it starts at too. Without settings nothing is changed.
static_assert(protocols::max_settings < device::max_alternatives);
class AdjustedExploration final : public ForwardedExploration {
 public:
  AdjustedExploration(Exploration& inner, const protocols::PlannedTrial& trial,
                      const protocols::Block& block, TrialEvents& events)
      : ForwardedExploration{inner},
        settings_{trial.task->settings(trial, block)},
        adjusted_{trial.alternatives.size() - 1},
        setting_{settings_ ? settings_->start : 0},
        events_{events} {
    note();
  }
  void switch_to(std::size_t alternative) override { inner().switch_to(position(alternative)); }
  std::size_t current() const override { return std::min(inner().current(), adjusted_); }
  void adjust(std::size_t setting) override {
    if (settings_ && setting < settings_->values.size()) {
      setting_ = setting;
      note();
      switch_to(adjusted_);
    }
  }
  std::size_t setting() const override { return setting_; }
  int contacts(std::size_t alternative) const override {
    return inner().contacts(position(alternative));
  }

 private:
  std::size_t position(std::size_t alternative) const {
    return alternative < adjusted_ ? alternative : adjusted_ + setting_;
  }
  void note() {
    if (settings_) {
      const double value = settings_->values[setting_].begin()->second;
      events_.add({time_s(), "setting", value});
    }
  }

  std::optional<protocols::Settings> settings_;
  std::size_t adjusted_;
  std::size_t setting_;
  TrialEvents& events_;
};
}  // namespace tapstudy::runner
