#pragma once
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/rng.hpp"
#include "runner/participants/touch_features.hpp"
namespace tapstudy::runner {
// Remembers what real plates feel like and compares what it feels with them. It is given forces
// and its own motion, never the name of a stimulus.
//
// A plate is remembered as the mean level of each feature at each place. A trial is the mean
// difference from that memory over its taps; to every feature of the trial one draw of internal
// noise is added (noise_db, the same for all candidates, so that nothing but the plates' own
// difference counts), and the candidate at the least distance is the answer. Distances weigh each
// feature by its noise and by how much it varied from tap to tap in memory.
class SimulatedObserver {
 public:
  SimulatedObserver(std::vector<core::Vec3> places_m, double noise_db, core::Rng rng);

  // Places never tapped are remembered as the plate's mean. Throws InvalidInput without taps.
  void remember(const std::string& plate, std::span<const FeltTap> taps);
  // Which of the remembered plates is this most like? A guess if nothing was felt.
  std::size_t most_similar(std::span<const FeltTap> felt, const std::vector<std::string>& plates);
  // Which of several felt things is most like the one remembered plate? One that was not felt at
  // all is like nothing; if none was, a guess.
  std::size_t most_similar(const std::vector<std::vector<FeltTap>>& felt, const std::string& plate);

 private:
  struct Memory {
    std::vector<Features> mean_db;  // at each place
    Features variance_db2{};
  };
  std::size_t place_of(const FeltTap& tap) const;
  Features difference(std::span<const FeltTap> felt, const Memory& memory) const;
  Features noise();
  std::size_t index_of_least(const std::vector<double>& values);  // a draw among equals
  double distance(const Features& difference, const Features& noise, const Memory& memory) const;

  std::vector<core::Vec3> places_m_;
  double noise_db_;
  core::Rng rng_;
  std::map<std::string, Memory> memories_;
};
}  // namespace tapstudy::runner
