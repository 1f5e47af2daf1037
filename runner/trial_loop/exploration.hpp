#pragma once
#include <cstddef>
#include <functional>
namespace tapstudy::runner {
// What a participant can do while a trial's alternatives are rendered.
class Exploration {
 public:
  virtual ~Exploration() = default;
  virtual void switch_to(std::size_t alternative) = 0;
  // Lets the trial continue; returns early if a fault has ended it.
  virtual void pass_time(double seconds) = 0;
  virtual bool is_running() const = 0;
  virtual double time_s() const = 0;  // since the trial began
};
using Explore = std::function<void(Exploration&)>;
}  // namespace tapstudy::runner
