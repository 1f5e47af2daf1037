#pragma once
#include <cstddef>
#include <functional>
namespace tapstudy::runner {
// A trial's loop while somebody explores what it renders. Requests take effect at the next moment
// without contact.
class Exploration {
 public:
  virtual ~Exploration() = default;
  virtual void request_position(std::size_t position) = 0;  // of the stimuli that the loop renders
  virtual void request_silence(bool is_silent) = 0;         // nothing is felt while it lasts
  virtual bool is_as_requested() const = 0;
  // The number of times that the finger has come down on a position.
  virtual int contacts(std::size_t position) const = 0;
  // Lets the loop run on; returns early if a fault has ended it.
  virtual void pass_time(double seconds) = 0;
  virtual bool is_running() const = 0;
  // False in a stall, too: an answer given then is none.
  virtual bool is_rendering() const = 0;
  virtual double time_s() const = 0;  // since the trial began
};
using Explore = std::function<void(Exploration&)>;
}  // namespace tapstudy::runner
