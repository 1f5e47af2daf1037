#pragma once
#include <vector>

#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
// The prior of a parameter, a weight for each of its values: `prior` uniform, normal (exp(-(x -
// mean)^2 / 2 sd^2)), log_normal (the same of log10 x and log10 mean; sd in decades) or listed
// (`weights`). Empty: a problem was noted, or there are no values.
std::vector<double> read_prior(MapReader& reader, const std::vector<double>& values);
}  // namespace tapstudy::protocols
