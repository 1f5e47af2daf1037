#include "protocols/procedures/psychometric_model.hpp"

#include <cmath>
#include <numeric>
namespace tapstudy::protocols {
OutcomeModel psychometric_model(core::PsychometricShape shape) {
  const bool is_logarithmic = core::row_of(shape).is_logarithmic;
  return
      [shape, is_logarithmic](std::span<const double> stimulus, std::span<const double> parameters,
                              std::span<double> probabilities) {
        const auto further = stimulus.subspan(1);
        const double shift =
            std::inner_product(further.begin(), further.end(), parameters.begin() + 4, 0.0);
        const double threshold =
            is_logarithmic ? parameters[0] * std::pow(10.0, shift) : parameters[0] + shift;
        probabilities[1] = core::proportion(shape, stimulus[0], threshold, parameters[1],
                                            parameters[2], parameters[3]);
        probabilities[0] = 1.0 - probabilities[1];
      };
}
}  // namespace tapstudy::protocols
