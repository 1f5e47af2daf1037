#pragma once
#include <cstdint>

#include "core/psychometric_function.hpp"
#include "core/rng.hpp"
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
}  // namespace tapstudy::testing
