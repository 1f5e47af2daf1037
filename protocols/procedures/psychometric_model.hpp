#pragma once
#include "core/psychometric_function.hpp"
#include "protocols/procedures/likelihood_table.hpp"
namespace tapstudy::protocols {
// Two outcomes, 1 with the probability psi of a psychometric function of the first axis, whose
// threshold the further axes x2, x3, ... move (Watson 2017 so models contrast sensitivity):
//   on a linear axis of the shape  threshold + effect2 (x2 - o2) + effect3 (x3 - o3) + ...
//   on its log10 axis              threshold 10^(effect2 (x2 - o2) + effect3 (x3 - o3) + ...)
// where o2, o3, ... are origins, one for each further axis.
// Parameters in this order: threshold, slope, guess, lapse, then an effect for each further axis.
// The model throws InvalidInput where the psychometric function does.
OutcomeModel psychometric_model(core::PsychometricShape shape, std::vector<double> origins);
}  // namespace tapstudy::protocols
