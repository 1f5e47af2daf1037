#pragma once
#include <cstddef>
#include <functional>
#include <string>
namespace tapstudy::runner {
// Where a trial is whose alternatives come one after the other: before one of them, in its
// interval, or behind the last. leaving: the gap has not begun, since the finger is still on the
// plate.
struct IntervalState {
  enum class Phase { gap, leaving, open, over };
  Phase phase{Phase::gap};
  int replays_left{};
  bool operator==(const IntervalState& other) const = default;
};

// What a participant can do while a trial's alternatives are rendered.
class Exploration {
 public:
  virtual ~Exploration() = default;
  virtual void switch_to(std::size_t alternative) = 0;
  virtual std::size_t current() const { return 0; }  // the alternative last switched to
  // Lets the trial continue; returns early if a fault has ended it.
  virtual void pass_time(double seconds) = 0;
  virtual bool is_running() const = 0;
  // Whether the alternatives are rendered right now: an answer given in a stall is none.
  virtual bool is_rendering() const { return is_running(); }
  virtual double time_s() const = 0;  // since the trial began
  // Sets the last alternative, where it has settings, to one of them, from 0, and switches to it.
  virtual void adjust(std::size_t /*setting*/) {}
  virtual std::size_t setting() const { return 0; }
  // Lets nothing be felt, or something again, from the next moment without contact on.
  virtual void silence(bool /*is_silent*/) {}
  // Whether the alternative, or the silence, that was asked for last is what is felt by now.
  virtual bool is_as_asked() const { return true; }
  // nullptr: alternatives are switched freely.
  virtual const IntervalState* intervals() const { return nullptr; }
  // All intervals once more, where the last is over and replays are left.
  virtual void replay() {}
  // An answer that is entered, and may still be changed; empty: it was withdrawn.
  virtual void enter_answer(const std::string& /*answer*/) {}
  // How often the finger has come down on an alternative, as it is set.
  virtual int contacts(std::size_t alternative) const = 0;
};
using Explore = std::function<void(Exploration&)>;

// An exploration on top of another: what is not overridden, the inner one does.
class ForwardedExploration : public Exploration {
 public:
  explicit ForwardedExploration(Exploration& inner) : inner_{inner} {}
  void switch_to(std::size_t alternative) override { inner().switch_to(alternative); }
  std::size_t current() const override { return inner().current(); }
  void pass_time(double seconds) override { inner().pass_time(seconds); }
  bool is_running() const override { return inner().is_running(); }
  bool is_rendering() const override { return inner().is_rendering(); }
  double time_s() const override { return inner().time_s(); }
  void adjust(std::size_t setting) override { inner().adjust(setting); }
  std::size_t setting() const override { return inner().setting(); }
  void silence(bool is_silent) override { inner().silence(is_silent); }
  bool is_as_asked() const override { return inner().is_as_asked(); }
  const IntervalState* intervals() const override { return inner().intervals(); }
  void replay() override { inner().replay(); }
  void enter_answer(const std::string& answer) override { inner().enter_answer(answer); }
  int contacts(std::size_t alternative) const override { return inner().contacts(alternative); }

 protected:
  Exploration& inner() const { return inner_; }

 private:
  Exploration& inner_;
};
}  // namespace tapstudy::runner
