#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "core/haptics/haptic_state.hpp"
#include "core/settings/device_settings.hpp"
#include "protocols/axes/presented_stimulus.hpp"
#include "protocols/reader/tap_script.hpp"
#include "protocols/rig.hpp"
#include "runner/session/stimuli/model_library.hpp"
namespace tapstudy::runner {
// The aim of the muscle of a scripted finger. Plate frame, with the height above the surface for z.
//
// A strike gets above its place in 0.3 s (unless it is the first) and comes down in 0.25 s, so that
// the hand has the speed when it hits. Then the aim goes on below the surface until the force is
// reached, and stays there until the next step.
class ScriptPath {
 public:
  // Throws InvalidInput, at the step's line, if a step starts before the finger can.
  ScriptPath(const protocols::TapScript& script, const core::HandBody& hand,
             double contact_stiffness_n_per_m);
  core::Vec3 at(double t_s) const;
  double duration_s() const { return duration_s_; }

 private:
  enum class Pace { even, gathering, minimum_jerk };
  struct Leg {
    double start_s;
    double duration_s;
    core::Vec3 from;
    core::Vec3 to;
    Pace pace;
  };
  void go(const core::Vec3& to, double duration_s, Pace pace);
  void wait_until(double start_s) { now_s_ = std::max(now_s_, start_s); }
  void strike(const protocols::TapStep& step, double below_m);
  double start_of(const protocols::TapStep& step, double earliest_s) const;

  std::vector<Leg> legs_;
  core::Vec3 here_{core::Vec3::Zero()};
  double now_s_{0.0};
  double duration_s_{0.0};
};

// The depth below the surface at which a muscle aims for this force of the contact spring at rest:
// spring and muscle in series.
double aim_below_m(double force_n, const core::HandBody& hand, double contact_stiffness_n_per_m);

// What device and actuator render of a tap, in virtual time.
struct TapTrace {
  std::vector<core::TraceSample> ticks;
  // On the finger, along the outward normal, sample by sample from the first tick on; empty unless
  // the protocol has a crossover. Before the limits of an actuator, without its delay.
  std::vector<float> actuator_n;
};
inline constexpr int tap_actuator_rate_hz = 48'000;

// One tap by the simulated hand with exactly this impact speed, and its trace.
struct ScriptedTap {
  protocols::PresentedStimulus stimulus;
  Eigen::Vector2d at_m{Eigen::Vector2d::Zero()};  // plate frame
  double speed_m_s{0.3};
  double seconds{0.5};
};
// Throws InvalidInput if the point is off the plate or the speed out of 0.001 to 10 m/s.
TapTrace trace_of(const ScriptedTap& tap, const protocols::Protocol& protocol,
                  const protocols::Rig& rig, ModelLibrary& models);

// The simulated hand does what a script says, and its trace. Throws InvalidInput, with the step's
// line, if the finger leaves the plate or cannot be where it should in time.
TapTrace trace_of(const protocols::PresentedStimulus& stimulus, const protocols::TapScript& script,
                  const protocols::Protocol& protocol, const protocols::Rig& rig,
                  ModelLibrary& models);

// "X,Y" in metres or the name of a tapping point. Throws InvalidInput if it is neither.
Eigen::Vector2d point_on_plate(const std::string& text, const protocols::Plate& plate);
}  // namespace tapstudy::runner
