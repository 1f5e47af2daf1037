#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "core/psychometric_function.hpp"
#include "core/random/rng.hpp"
#include "protocols/procedures/procedure.hpp"
#include "protocols/yaml/problems.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::testing {
// Answers correctly with the probability psi(x) of a known psychometric function.
class KnownObserver {
 public:
  struct Parameters {
    core::PsychometricShape shape{core::PsychometricShape::logistic};
    double threshold{};
    double slope{1.0};
    double guess{0.0};
    double lapse{0.0};
  };
  KnownObserver(const Parameters& parameters, std::uint64_t seed)
      : parameters_{parameters}, rng_{seed} {}

  double probability(double value) const {
    const Parameters& own = parameters_;
    return core::proportion(own.shape, value, own.threshold, own.slope, own.guess, own.lapse);
  }
  // The value at which it answers correctly with this probability.
  double value_at(double probability) const {
    const Parameters& own = parameters_;
    return core::value_at_proportion(own.shape, probability, own.threshold, own.slope, own.guess,
                                     own.lapse);
  }
  // 1: correct, 0: incorrect.
  std::size_t answer(double value) { return rng_.uniform() < probability(value) ? 1 : 0; }

 private:
  Parameters parameters_;
  core::Rng rng_;
};

// A procedure as a protocol states it, such as "psi: {...}". Throws InvalidInput.
inline std::shared_ptr<const protocols::TrackSettings> procedure_of(const std::string& yaml) {
  protocols::Problems problems{"p.yaml"};
  auto reader = protocols::MapReader::whole_file(yaml, "p.yaml", problems);
  auto settings = protocols::read_procedure(reader);
  reader.finish();
  problems.throw_if_any();
  return settings;
}
// Presents what is requested until the track ends.
template <typename Observer>
void run(protocols::Track& track, Observer&& observer) {
  while (const auto values = track.next()) {
    track.observe(*values, observer(*values));
  }
}
}  // namespace tapstudy::testing
