#pragma once
#include <Eigen/Core>
#include <array>
#include <complex>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>

#include "core/haptics/haptic_state.hpp"
#include "core/settings/actuator_settings.hpp"
#include "core/tick/contact.hpp"
#include "core/tick/impact_transients.hpp"
#include "core/tick/vibrating_plate.hpp"
namespace tapstudy::core {
// One tick of the haptic loop, as far as it concerns the actuator; plain bytes, for a ring buffer.
struct ActuatorTick {
  std::int64_t at_ns;       // by the loop's clock
  double passed_share;      // of the force rendered, what passed the device's limits: 0 to 1
  double impact_speed_m_s;  // in the tick of an impact
  std::array<double, 3> god_object_m;  // as in Contact
  std::array<double, 3> normal;
  std::array<double, 3> barycentric;
  int triangle;
  std::uint8_t alternative;
  bool touching;
  bool impact;
  bool is_last;  // the loop ends here, in order; no tick, and without contact
};
static_assert(std::is_trivially_copyable_v<ActuatorTick>);
ActuatorTick actuator_tick(const Contact& contact) noexcept;
double passed_share(double rendered_n, double passed_n) noexcept;

// A stimulus's vibration as the actuator renders it, sample by sample at audio rate: the law of
// PlateVibration, DecayingSinusoid and RecordedTransient (paper eq. 11 and 14 to 17), each mode
// exact at its own samples, so that the waveform is that of the closed form whatever the rate of
// the loop.
//
// Between two ticks the place that is touched moves on evenly: the modes' weights are interpolated,
// and a finger that slides is not heard in steps of the loop. A contact begins at once, with its
// impact, and ends within the samples of a tick.
//
// Each mode is multiplied by the actuator's inverse response at its frequency. Multiplying the
// rotating vector (q, (q' + zeta w q) / w_d) by a complex number scales and turns it; the sum over
// modes of k u + b u' is then as easily made as without.
class ActuatorVoice {
 public:
  // What begins anew at each impact, at the rate of the samples.
  struct Transients {
    std::optional<DecayingSinusoid> sinusoid{};
    std::optional<RecordedTransient> recorded{};
  };
  // plate: the actuator's share of the modes; nullptr if there are none. It must outlive the voice.
  // inverse: the actuator's inverse response at each of them.
  ActuatorVoice(const VibratingPlate* plate, std::span<const std::complex<double>> inverse,
                const RenderSettings& settings, Transients transients, double sample_s);
  // One sample later. Then, where a tick begins at this sample, begin(); then force_n().
  void advance() noexcept;
  // samples: until the next tick, >= 1.
  void begin(const ActuatorTick& tick, int samples) noexcept;
  // The contact ends, evenly over so many samples: nobody knows any more what the finger does.
  void fade(int samples) noexcept { pass(0.0, samples); }
  // On the finger, along the outward normal, before the limiter.
  double force_n() const noexcept;
  void reset() noexcept;

 private:
  void pass(double share, int samples) noexcept;
  // Calls what(transient) for each that there is.
  template <class What>
  void with_transients(const What& what) noexcept {
    if (transients_.sinusoid) {
      what(*transients_.sinusoid);
    }
    if (transients_.recorded) {
      what(*transients_.recorded);
    }
  }

  const VibratingPlate* plate_;
  double mass_kg_;
  Eigen::ArrayXd qq_, qv_, vq_, vv_;              // StateTransition, one per mode
  Eigen::ArrayXd of_displacement_, of_velocity_;  // force per unit of a mode's state
  Eigen::ArrayXd displacement_, velocity_, before_;
  Eigen::ArrayXd touched_, aim_, step_;  // the touched point's displacement along the normal
  Transients transients_;
  double share_{0.0};
  double share_step_{0.0};
  double share_aim_{0.0};
  int since_flush_{0};  // samples
  int left_{0};         // samples until touched_ and share_ are where they aim
  bool is_touching_{false};
};

// Never lets more through than the limits, and nothing that is not a number.
//
// Law: |out| <= peak, and with a = e^(-T/τ), τ = 1 s, the mean square
//     s_n = a s_{n-1} + (1 - a) out_n² <= rms²:
// the largest sample allowed is the root of (rms² - a s_{n-1}) / (1 - a), which is never below rms.
class ActuatorLimiter {
 public:
  // mean_square_n2: s of the sample before the first.
  ActuatorLimiter(const ActuatorLimits& limits, double sample_s,
                  double mean_square_n2 = 0.0) noexcept;
  double limited(double force_n) noexcept;
  double mean_square_n2() const noexcept { return mean_square_n2_; }

 private:
  ActuatorLimits limits_;
  double kept_;  // a
  double mean_square_n2_;
};
}  // namespace tapstudy::core
