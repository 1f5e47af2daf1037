#include "runner/session/participants/simulated_participant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "core/error.hpp"
#include "runner/session/participants/planned_taps.hpp"
#include "runner/session/participants/trial_control.hpp"
#include "runner/session/stimuli/model_library.hpp"
#include "runner/session/trial_loop/real_plates.hpp"
#include "runner/session/trial_loop/trial_loop.hpp"
namespace tapstudy::runner {
namespace {
using core::Purpose;

// The stimuli to be memorised for the tasks of the blocks that are tapped this way, in the order of
// the protocol.
std::vector<protocols::Remembered> all_remembered(
    const protocols::Protocol& protocol, const std::optional<protocols::ScriptedTaps>& taps) {
  std::vector<protocols::Remembered> all;
  for (const protocols::Block& block : protocol.blocks) {
    if (block.explore.scripted_taps != taps) {
      continue;
    }
    for (const protocols::Remembered& one : block.task->remembered(block, protocol.simulation)) {
      if (std::ranges::find(all, one.key, &protocols::Remembered::key) == all.end()) {
        all.push_back(one);
      }
    }
  }
  return all;
}

protocols::Simulation drawn_person(protocols::Simulation simulation, std::uint64_t seed) {
  core::Rng rng{core::derived_seed(seed, Purpose::person)};
  const protocols::SimulatedPeopleSettings& people = simulation.people;
  simulation.observer.noise_db = rng.log_normal(simulation.observer.noise_db, people.noise_spread);
  simulation.observer.threshold_n =
      rng.log_normal(simulation.observer.threshold_n, people.threshold_spread);
  simulation.taps.speed_m_s = rng.log_normal(simulation.taps.speed_m_s, people.speed_spread);
  return simulation;
}
}  // namespace

// One trial, with the taps felt of each alternative.
class SimulatedParticipant::Touch final : public protocols::SimulatedTouch {
 public:
  Touch(SimulatedParticipant& self, const TrialPrompt& prompt, TrialControl& control)
      : self_{self},
        observer_{self.observer_of(*prompt.block)},
        scripted_{prompt.block->explore.scripted_taps},
        control_{control},
        settings_{prompt.answers.settings},
        felt_(std::max<std::size_t>(1, prompt.alternative_labels.size())) {}
  void visit(std::size_t alternative) override {
    if (control_.intervals() != nullptr) {
      if (visits_[alternative]++ == presentations_) {
        attend();
      }
      return;
    }
    if (felt_.size() > 1) {
      control_.switch_to(alternative);
    }
    tap(alternative);
  }
  std::size_t most_similar_stimulus(const std::vector<std::string>& stimuli) override {
    return observer_.most_similar(felt_.front(), stimuli);
  }
  std::size_t most_similar_alternative(const std::string& stimulus) override {
    return observer_.most_similar(felt_, stimulus);
  }
  double position(std::size_t alternative, const std::string& from,
                  const std::string& to) override {
    return observer_.position(percept(alternative), from, to);
  }
  double distance(std::size_t first, std::size_t second) override {
    return observer_.distance(percept(first), percept(second));
  }
  double distance(std::size_t alternative, const std::string& stimulus) override {
    return observer_.distance(percept(alternative), stimulus);
  }
  bool are_different(const std::string& stimulus, double share) override {
    return observer_.are_different(percept(0), percept(1), stimulus, share);
  }
  double level_db(std::size_t alternative) override {
    return observer_.level_db(percept(alternative));
  }
  bool adjust(int settings) override {
    const auto wanted = static_cast<std::ptrdiff_t>(control_.setting()) + settings;
    if (wanted < 0 || wanted >= static_cast<std::ptrdiff_t>(settings_)) {
      return false;
    }
    control_.adjust(static_cast<std::size_t>(wanted));
    felt_.back().clear();
    if (noise_.size() == felt_.size()) {
      noise_.back() = observer_.noise();
    }
    return true;
  }
  std::size_t setting() const override { return control_.setting(); }
  core::Rng& rng() override { return self_.hand_rng_; }

 private:
  using Phase = IntervalState::Phase;
  void tap(std::size_t alternative) {
    control_.pass_time(self_.begin_taps(scripted_, self_.person_.taps.taps_per_visit));
    keep_felt(alternative);
  }
  void keep_felt(std::size_t alternative) {
    const auto taps = self_.just_felt();
    felt_.at(alternative).insert(felt_.at(alternative).end(), taps.begin(), taps.end());
  }
  // Taps that were begun in an interval end with it.
  void tap_in_interval() {
    const std::size_t alternative = control_.current();
    const double end_s =
        control_.time_s() + self_.begin_taps(scripted_, self_.person_.taps.taps_per_visit);
    while (control_.poll() && control_.intervals()->phase == Phase::open &&
           control_.current() == alternative && control_.time_s() < end_s) {
      control_.pass_time(poll_s);
    }
    keep_felt(alternative);
  }
  // All intervals, in the order in which they come; as often as there are replays.
  void attend() {
    if (presentations_++ > 0) {
      control_.replay();
    }
    while (control_.poll() && control_.intervals()->phase != Phase::over) {
      if (control_.intervals()->phase == Phase::open) {
        tap_in_interval();
      } else {
        control_.pass_time(poll_s);
      }
    }
  }

  static constexpr double poll_s = 0.01;
  SimulatedParticipant& self_;
  SimulatedObserver& observer_;
  const Scripted& scripted_;
  TrialControl& control_;
  std::size_t settings_;
  std::map<std::size_t, int> visits_;  // asked for, of intervals
  int presentations_{0};               // of all intervals
  // Noise is drawn with the first question: whoever asks for none leaves the stream as it was.
  SimulatedObserver::Percept percept(std::size_t alternative) {
    while (noise_.size() < felt_.size()) {
      noise_.push_back(observer_.noise());
    }
    return {felt_.at(alternative), noise_.at(alternative)};
  }

  std::vector<std::vector<FeltTap>> felt_;
  std::vector<Features> noise_;
};

SimulatedParticipant::SimulatedParticipant(const protocols::Protocol& protocol,
                                           const device::LoopSettings& settings,
                                           ModelLibrary& models, std::uint64_t seed)
    : protocol_{protocol},
      person_{drawn_person(protocol.simulation, seed)},
      settings_{settings},
      hand_{protocol.simulation.hand, protocol.rendering.dt_s, device::SimulatedHand::Memory::kept},
      hand_rng_{core::derived_seed(seed, Purpose::memory)},
      trained_observers_{trained_observers(seed)} {
  for (TrainedObserver& by : trained_observers_) {
    remember(models, by);
  }
  hand_rng_ = core::Rng{core::derived_seed(seed, Purpose::hand)};
}

// One for each way of tapping in the protocol; the participant's own comes first.
std::vector<SimulatedParticipant::TrainedObserver> SimulatedParticipant::trained_observers(
    std::uint64_t seed) const {
  std::vector<Scripted> ways{std::nullopt};
  for (const protocols::Block& block : protocol_.blocks) {
    if (std::ranges::find(ways, block.explore.scripted_taps) == ways.end()) {
      ways.push_back(block.explore.scripted_taps);
    }
  }
  std::vector<TrainedObserver> all;
  for (const Scripted& taps : ways) {
    all.push_back({taps,
                   {aims_m(protocol_, settings_.placement),
                    {person_.observer.noise_db, person_.people.bias, seed},
                    core::Rng{core::derived_seed(seed, Purpose::observer, all.size())}}});
  }
  return all;
}

SimulatedObserver& SimulatedParticipant::observer_of(const protocols::Block& block) {
  return std::ranges::find(trained_observers_, block.explore.scripted_taps, &TrainedObserver::taps)
      ->observer;
}

// A body that several stimuli share is tapped once.
void SimulatedParticipant::remember(ModelLibrary& models, TrainedObserver& by) {
  const protocols::Protocol reality = with_real_plates(protocol_);
  VirtualTrialLoop world{hand_, settings_, Keep::nothing};
  using Body = std::tuple<const core::Plate*, const core::Material*, const core::Joints*>;
  std::map<Body, std::vector<FeltTap>> felt;
  const auto felt_of = [&](const protocols::PresentedStimulus& stimulus) {
    TrialStimuli stimuli = build_trial_stimuli(reality, {stimulus}, models);
    const Rendered rendered{stimuli.alternatives, scripted_tap(protocol_, by.taps)};
    world.run(rendered, [&](Exploration& exploration) {
      exploration.pass_time(begin_taps(by.taps, person_.observer.familiarisation_taps));
    });
    return just_felt();
  };
  for (const protocols::Remembered& one : all_remembered(protocol_, by.taps)) {
    const protocols::Protocol& as = one.is_real ? reality : protocol_;
    const auto stimulus = protocols::stimulus_at(as, as.stimulus(one.stimulus), one.values);
    const Body body{stimulus.plate.get(), stimulus.material.get(), stimulus.contacts.get()};
    if (!one.is_real) {
      by.observer.remember(one.key, felt_of(stimulus));
      continue;
    }
    if (!felt.contains(body)) {
      felt[body] = felt_of(stimulus);
    }
    by.observer.remember(one.key, felt.at(body));
  }
}

double SimulatedParticipant::begin_taps(const Scripted& scripted, int count) {
  hand_.forget();
  if (!scripted) {
    return hand_.follow(draw_taps(protocol_, person_.taps, settings_.placement, count, hand_rng_));
  }
  const double duration_s = count * scripted_tap(protocol_, scripted)->duration_s();
  hand_.hold(duration_s);
  return duration_s;
}

std::vector<FeltTap> SimulatedParticipant::just_felt() const {
  return felt_taps(hand_.felt(), protocol_.rendering.dt_s, person_.observer.threshold_n);
}

void SimulatedParticipant::refused(const TrialPrompt& prompt, const TooEarly& why) {
  constexpr int patience = 1000;  // visits
  refusals_ = prompt.number == refused_trial_ ? refusals_ + 1 : 1;
  refused_trial_ = prompt.number;
  if (refusals_ > patience) {
    throw core::InvalidInput{
        fmt::format("trial {}: a simulated participant cannot meet the block's explore limits ({})",
                    prompt.number, to_text(why))};
  }
}

void SimulatedParticipant::timed_out(const TrialPrompt& prompt, bool is_presented_again) {
  if (is_presented_again) {  // it would take as long again, without end
    throw core::InvalidInput{fmt::format(
        "trial {}: a simulated participant takes longer than the block's explore.max_seconds "
        "(lower simulation.taps.taps_per_visit or visits, or raise max_seconds)",
        prompt.number)};
  }
}

std::optional<std::string> SimulatedParticipant::perform(const TrialPrompt& prompt,
                                                         TrialControl& control) {
  Touch touch{*this, prompt, control};
  return prompt.block->task->simulated_answer(*prompt.block, person_, touch);
}
}  // namespace tapstudy::runner
