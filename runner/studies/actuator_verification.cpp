#include "runner/studies/actuator_verification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "core/error.hpp"
#include "device/audio/actuator_source.hpp"
#include "protocols/reader/read_rig.hpp"
#include "results/store/recomputation.hpp"
#include "results/store_error.hpp"
#include "results/traces/trace_collector.hpp"
#include "runner/build_info/build_info.hpp"
#include "runner/session/stimuli/model_library.hpp"
namespace tapstudy::runner {
namespace {
using results::StoredTrial;

// What the haptic loop told the actuator in the ticks of a trace. Contact follows from the hand
// alone; where the trace is not in contact, the loop was silent.
class ReplayedTicks {
 public:
  ReplayedTicks(std::span<const core::TraceSample> trace, TrialStimuli& stimuli,
                const core::Placement& placement, std::int64_t period_ns)
      : trace_{trace}, stimuli_{stimuli}, placement_{placement}, period_ns_{period_ns} {}

  // nullopt: it told no more.
  std::optional<core::ActuatorTick> next() {
    if (next_ < trace_.size()) {
      const core::TraceSample& sample = trace_[next_++];
      return sample.alternative < stimuli_.alternatives.size() ? std::optional{tick_of(sample)}
                                                               : std::nullopt;
    }
    const core::TraceSample& last = trace_.back();
    if (is_ended_ || last.fault != core::TickFault::none) {
      return std::nullopt;
    }
    is_ended_ = true;
    core::ActuatorTick end = core::actuator_tick({});
    end.at_ns = last.t_ns + period_ns_;
    end.alternative = last.alternative;
    end.is_last = true;
    return end;
  }
  // The first tick whose contact is not that of the hand; NaN: there is none.
  double differs_at_s() const { return differs_at_s_; }

 private:
  core::ActuatorTick tick_of(const core::TraceSample& sample) {
    core::TapRenderer& renderer = stimuli_.alternatives[sample.alternative];
    if (sample.alternative != current_) {
      renderer.take_over_from(stimuli_.alternatives[current_]);
      current_ = sample.alternative;
    }
    const core::HandState tip{core::Vec3::Map(sample.position_m.data()),
                              core::Vec3::Map(sample.velocity_m_s.data())};
    const core::Contact contact = renderer.tick(placement_.to_plate(tip)).contact;
    if (sample.touching && (!contact.touching || contact.impact != sample.impact)) {
      differs_at_s_ = std::isnan(differs_at_s_) ? results::time_s(sample) : differs_at_s_;
    }
    core::ActuatorTick tick = core::actuator_tick(sample.touching ? contact : core::Contact{});
    const double rendered_n =
        std::abs(sample.penalty_n + sample.vibration_n + sample.sinusoid_n) * contact.normal.norm();
    tick.at_ns = sample.t_ns;
    tick.passed_share = core::passed_share(sample.touching ? rendered_n : 0.0,
                                           core::Vec3::Map(sample.force_n.data()).norm());
    tick.alternative = sample.alternative;
    return tick;
  }

  std::span<const core::TraceSample> trace_;
  TrialStimuli& stimuli_;
  core::Placement placement_;
  std::int64_t period_ns_;
  std::size_t next_{0};
  std::size_t current_{0};
  bool is_ended_{false};
  double differs_at_s_{std::numeric_limits<double>::quiet_NaN()};
};

// Of the rig that a session was run with.
struct ActuatorOfRig {
  core::ActuatorOutput output;
  core::Placement placement;
};

class ActuatorComparison {
 public:
  ActuatorComparison(results::Store& store, const std::optional<protocols::Protocol>& protocol)
      : store_{store}, protocol_{protocol}, alternatives_{store.alternatives()} {
    for (results::SessionRow& session : store.sessions()) {
      sessions_.emplace(session.id, std::move(session));
    }
  }

  void compare(const StoredTrial& trial) {
    trial_ = &trial;
    try {
      const auto stored = store_.actuator(trial.id);
      const bool has_chunks = compare_chunks();
      if (!stored) {
        note_missing(has_chunks);
      } else if (protocol_) {
        compare(*stored);
      }
    } catch (const results::StoreError& error) {
      found_.differences.emplace_back(error.what());
    } catch (const core::Error& error) {  // of a protocol or rig that this version refuses
      found_.remarks.push_back(
          fmt::format("trial {}: its actuator is not rendered again: {}", trial.id, error.what()));
    }
  }
  ActuatorVerification result() { return std::move(found_); }

 private:
  void note(const std::string& what, const std::string& stored, const std::string& recomputed) {
    if (stored != recomputed) {
      found_.differences.push_back(results::difference_in(*trial_, what, stored, recomputed));
    }
  }
  // At the trial's begin.
  std::optional<double> event(const char* kind) {
    std::optional<double> value;
    store_.each_row(
        fmt::format("SELECT value FROM event WHERE trial_id = {} AND t_s = 0 AND kind = '{}'",
                    trial_->id, kind),
        [&](results::Statement& row) { value = row.real(0); });
    return value;
  }

  void note_missing(bool has_chunks) {
    const bool is_rendered = protocol_ && protocol_->stores_actuator && trial_->ticks > 0 &&
                             store_.has_tables_of_actuators() && event("actuator") &&
                             !event(results::untraced_event);
    note("actuator", is_rendered || has_chunks ? "missing" : "left out", "left out");
  }

  // One after the other, from the first period. Returns whether there are any.
  bool compare_chunks() {
    std::int64_t next = 0;
    if (!store_.has_tables_of_actuators()) {
      return false;
    }
    store_.each_row(fmt::format("SELECT first_period, periods FROM actuator_chunk "
                                "WHERE trial_id = {} ORDER BY first_period",
                                trial_->id),
                    [&](results::Statement& row) {
                      note("actuator_chunk.first_period", fmt::format("{}", row.integer(0)),
                           fmt::format("{}", next));
                      next += row.integer(1);
                    });
    return next != 0;
  }

  // What the rig and the trial's events say of it as well; false: it cannot be rendered by that.
  bool compare_settings(const results::ActuatorRow& row, const core::ActuatorOutput& output) {
    const std::size_t before = found_.differences.size();
    const auto compare_number = [&](const char* column, double stored, double expected) {
      note(fmt::format("actuator.{}", column), fmt::format("{}", stored),
           fmt::format("{}", expected));
    };
    compare_number("rate_hz", row.rate_hz, output.rate_hz);
    compare_number("full_scale_n", row.full_scale_n, output.full_scale_n);
    compare_number("delay_s", row.delay_s, event("actuator").value_or(0.0));
    const auto check = [&](const char* column, double value, double low, double high) {
      if (!(value >= low && value <= high)) {
        note(fmt::format("actuator.{}", column), fmt::format("{}", value),
             fmt::format("from {} to {}", low, high));
      }
    };
    constexpr double longest_delay_s = 10.0;
    constexpr double rounding = 1.0 + 1e-9;
    constexpr double most = 1e15;
    check("delay_s", row.delay_s, 0.0, longest_delay_s);
    check("mean_square_n2", row.mean_square_n2, 0.0,
          rounding * output.limits.rms_n * output.limits.rms_n);
    check("ticks_lost", static_cast<double>(row.ticks_lost), 0.0, most);
    check("dropped_periods", static_cast<double>(row.dropped_periods), 0.0, most);
    return found_.differences.size() == before;
  }

  // nullptr: it has no actuator.
  const ActuatorOfRig* rig_of_session() {
    const std::int64_t session_id = trial_->row.session_id;
    const auto known = rigs_.find(session_id);
    if (known != rigs_.end()) {
      return known->second ? &*known->second : nullptr;
    }
    const std::string& text = sessions_[session_id].rig_text;  // of a lost session: empty
    std::optional<ActuatorOfRig>& rig = rigs_[session_id];
    if (const auto output = text.empty() ? std::nullopt : protocols::actuator_in_stored_rig(text)) {
      rig = {*output, protocols::placement_in_stored_rig(text).value_or(protocol_->placement)};
    }
    return rig ? &*rig : nullptr;
  }

  TrialStimuli stimuli(const core::ActuatorOutput& output) {
    std::vector<protocols::PresentedStimulus> presented;
    for (const results::AlternativeRow& row : alternatives_[trial_->id]) {
      presented.push_back(
          protocols::stimulus_at(*protocol_, protocol_->stimulus(row.stimulus), row.axis_values));
    }
    return build_trial_stimuli(*protocol_, presented, models_, &output);
  }

  void compare(const results::Store::StoredActuator& stored) {
    const ActuatorOfRig* const rig = rig_of_session();
    if (rig == nullptr) {
      note("actuator", "there", "none, by the session's rig");
      return;
    }
    const std::vector<core::TraceSample> trace = store_.trace(trial_->id);
    note("actuator", trace.empty() ? "there" : "traced", "traced");
    if (!compare_settings(stored.row, rig->output) || trace.empty()) {
      return;
    }
    if (stored.row.dropped_periods > 0) {
      found_.remarks.push_back(fmt::format("trial {}: the last {} periods of its actuator are lost",
                                           trial_->id, stored.row.dropped_periods));
    }
    if (trial_->dropped > 0 || stored.row.ticks_lost > 0) {
      found_.remarks.push_back(
          fmt::format("trial {}: ticks are lost, its actuator is not rendered again", trial_->id));
      return;
    }
    TrialStimuli rendered = stimuli(rig->output);
    ReplayedTicks ticks{trace, rendered, rig->placement, std::llround(1e9 / protocol_->rate_hz)};
    const std::vector<core::ActuatorPeriod>& periods = stored.trace.periods;
    const bool is_whole = stored.row.dropped_periods == 0 && !has_fault() &&
                          (periods.empty() || periods.back().is_heard);
    if (render(stored, rig->output, ticks, rendered) == Heard::in_part && is_whole) {
      note("actuator", "there in part", "heard to its end");
    }
    if (!std::isnan(ticks.differs_at_s())) {
      note("contact of the trace", fmt::format("there at {} s", ticks.differs_at_s()), "another");
    }
  }

  // Of the loop or the card, after which not all is heard.
  bool has_fault() {
    bool is_there = false;
    store_.each_row(
        fmt::format("SELECT 1 FROM tick_statistics WHERE trial_id = {0} AND fault <> '' UNION "
                    "SELECT 1 FROM event WHERE trial_id = {0} AND kind = 'actuator_lost'",
                    trial_->id),
        [&](results::Statement& /*row*/) { is_there = true; });
    return is_there;
  }

  enum class Heard { wholly, in_part, otherwise };
  Heard render(const results::Store::StoredActuator& stored, const core::ActuatorOutput& output,
               ReplayedTicks& ticks, TrialStimuli& rendered) {
    const auto& [row, trace] = stored;
    device::ActuatorSource source{
        {row.rate_hz, row.full_scale_n, output.limits, protocol_->rendering.dt_s, row.delay_s},
        {row.last_n, row.mean_square_n2}};
    source.use(rendered.voices);
    float peak = 0.0F;
    for (const float sample : trace.samples) {
      peak = std::max(peak, std::abs(sample));
    }
    constexpr float of_peak = 1e-5F;
    const float allowed = of_peak * peak;
    std::uint32_t told = 0;
    std::size_t first = 0;
    std::vector<float> period;
    for (const core::ActuatorPeriod& at : trace.periods) {
      for (; told < at.ticks; ++told) {
        const auto tick = ticks.next();
        if (!tick) {
          note("actuator: ticks told", fmt::format("{}", at.ticks), fmt::format("{}", told));
          return Heard::otherwise;
        }
        source.ticks().try_push(*tick);
      }
      period.resize(at.samples);
      source.fill(period, at.heard_at_ns, at.frame_ns, at.filled_at_ns);
      const auto of_period = std::span{trace.samples}.subspan(first, at.samples);
      const auto [a, b] = std::ranges::mismatch(
          of_period, period, [&](float x, float y) { return std::abs(x - y) <= allowed; });
      if (a != of_period.end()) {
        const auto sample = static_cast<double>(a - of_period.begin());
        note_sample(1e-9 * (static_cast<double>(at.heard_at_ns) + sample * at.frame_ns), *a, *b);
        return Heard::otherwise;
      }
      first += at.samples;
      found_.samples += at.samples;
    }
    return !ticks.next() && source.is_done() ? Heard::wholly : Heard::in_part;
  }

  void note_sample(double heard_s, float stored, float recomputed) {
    const std::string version = sessions_[trial_->row.session_id].program_version;
    const std::string what = fmt::format("sample of the actuator at {} s", heard_s);
    if (version == program_version()) {
      note(what, fmt::format("{}", stored), fmt::format("{}", recomputed));
    } else {
      found_.remarks.push_back(
          fmt::format("{} (this version is not {}, which rendered it)",
                      results::difference_in(*trial_, what, fmt::format("{}", stored),
                                             fmt::format("{}", recomputed)),
                      version));
    }
  }

  results::Store& store_;
  const std::optional<protocols::Protocol>& protocol_;
  results::AlternativesOfTrials alternatives_;
  std::map<std::int64_t, results::SessionRow> sessions_;
  std::map<std::int64_t, std::optional<ActuatorOfRig>> rigs_;  // by session
  ModelLibrary models_;
  const StoredTrial* trial_{};
  ActuatorVerification found_;
};
}  // namespace

ActuatorVerification checked_actuators(results::Store& store,
                                       const std::optional<protocols::Protocol>& protocol) {
  ActuatorComparison comparison{store, protocol};
  for (const StoredTrial& trial : results::stored_trials(store)) {
    comparison.compare(trial);
  }
  return comparison.result();
}
}  // namespace tapstudy::runner
