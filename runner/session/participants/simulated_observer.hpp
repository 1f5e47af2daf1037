#pragma once
#include <array>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "core/random/rng.hpp"
#include "device/hand/simulated_hand.hpp"
namespace tapstudy::runner {
// Perceptual features of one tap: third-octave vibration levels from 20 to 320 Hz, early (the first
// 40 ms from the impact on, rebounds included) and late (the next 120 ms), in decibels above the
// detection threshold. Early and late levels together capture amplitude and decay.
inline constexpr std::size_t bands = 13;
using Features = std::array<double, 2 * bands>;

struct FeltTap {
  core::Vec3 place_m;  // of the hand at first contact, device frame
  Features level_db;
};

// Extracts the taps from the recorded ticks. The contact spring is removed first: a moving hand can
// predict the compliant resistance (a linear fit of force against depth for each contact) and
// attends to the remainder. Levels are clamped at 0 dB: amplitudes below threshold are not felt.
std::vector<FeltTap> felt_taps(std::span<const device::FeltTick> felt, double dt_s,
                               double threshold_n);

// An observer model that compares felt vibration with its memory of real plates. Its input is
// forces and its own motion, never the name of a stimulus.
//
// A plate is remembered as the mean level of each feature at each place. A trial is represented by
// the mean difference from that memory over its taps; one draw of internal noise per feature is
// added (noise_db, the same for all candidates, so that only the difference between the plates
// matters), and the candidate at the smallest distance is the answer. Distances weight each feature
// by its noise and its variance between taps in memory. A bias favours some answers, by their place
// in the list.
class SimulatedObserver {
 public:
  struct Person {
    double noise_db;
    double bias;  // standard deviation over answers, of the distance
    std::uint64_t bias_seed;
  };
  SimulatedObserver(std::vector<core::Vec3> places_m, const Person& person, core::Rng rng);

  // Places never tapped are remembered as the plate's mean. Throws InvalidInput if taps is empty.
  void remember(const std::string& stimulus, std::span<const FeltTap> taps);
  // Which of the remembered plates is this most like? A guess if nothing was felt.
  std::size_t most_similar(std::span<const FeltTap> felt, const std::vector<std::string>& stimuli);
  // The noise of one percept: drawn once for each alternative of a trial.
  Features noise();
  struct Percept {
    std::span<const FeltTap> felt;
    Features noise;
  };
  // 0 at one remembered plate, 1 at another: the projection on the difference of the two, each
  // feature weighted by its noise. If nothing was felt, noise alone.
  double position(const Percept& percept, const std::string& from, const std::string& to) const;
  // Mean square over the features, in units of the noise of such a difference; places that only one
  // of two was tapped at say nothing.
  double distance(const Percept& first, const Percept& second) const;
  double distance(const Percept& percept, const std::string& stimulus) const;
  // Whether the distance of two percepts, features weighted by their noise and by their variance
  // between taps on the remembered plate, is beyond the quantile `share` of that of two percepts of
  // this plate: of random halves of the taps that it was remembered by, with new noise.
  bool are_different(const Percept& first, const Percept& second, const std::string& stimulus,
                     double share);
  // The mean over taps and features; noise alone if nothing was felt.
  double level_db(const Percept& percept) const;
  // Which of several felt alternatives is most like the remembered plate? One that was not felt is
  // excluded; if none was felt, a guess.
  std::size_t most_similar(const std::vector<std::vector<FeltTap>>& felt,
                           const std::string& stimulus);

 private:
  struct Memory {
    std::vector<FeltTap> taps;
    std::vector<Features> mean_db;  // at each place
    Features variance_db2{};
  };
  std::size_t place_of(const FeltTap& tap) const;
  Features difference(std::span<const FeltTap> felt, const Memory& memory) const;
  // The mean over places that both were tapped at, noise included.
  Features difference(const Percept& first, const Percept& second) const;
  double weighted_distance(const Percept& first, const Percept& second, const Memory& memory) const;
  double same_distance(const std::string& stimulus, std::size_t taps_each, double share);
  std::vector<std::vector<FeltTap>> by_place(std::span<const FeltTap> taps) const;
  double noise_variance_db2() const;
  std::size_t index_of_least(std::vector<double> distances);  // biased; ties broken at random
  double bias_towards(std::size_t answer) const;
  double distance(const Features& difference, const Features& noise, const Memory& memory) const;

  std::vector<core::Vec3> places_m_;
  Person person_;
  core::Rng rng_;
  std::map<std::string, Memory> memories_;
  std::map<std::tuple<std::string, std::size_t, double>, double> same_distances_;
};
}  // namespace tapstudy::runner
