#include "protocols/procedures/psychometric_model.hpp"

#include <cmath>
#include <utility>
namespace tapstudy::protocols {
OutcomeModel psychometric_model(core::PsychometricShape shape, std::vector<double> origins) {
  const bool is_logarithmic = core::row_of(shape).is_logarithmic;
  return [shape, is_logarithmic, origins = std::move(origins)](std::span<const double> stimulus,
                                                               std::span<const double> parameters,
                                                               std::span<double> probabilities) {
    double shift = 0.0;
    for (std::size_t i = 0; i < origins.size(); ++i) {
      shift += parameters[4 + i] * (stimulus[1 + i] - origins[i]);
    }
    const double threshold =
        is_logarithmic ? parameters[0] * std::pow(10.0, shift) : parameters[0] + shift;
    probabilities[1] = core::proportion(shape, stimulus[0], threshold, parameters[1], parameters[2],
                                        parameters[3]);
    probabilities[0] = 1.0 - probabilities[1];
  };
}
}  // namespace tapstudy::protocols
