#include "protocols/procedures/read_prior.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "protocols/procedures/read_grid.hpp"
namespace tapstudy::protocols {
namespace {
enum class Prior { uniform, normal, log_normal, listed };

std::vector<double> bell_weights(MapReader& reader, const std::vector<double>& values,
                                 bool is_log) {
  const double mean = reader.number("mean", {-largest_value, largest_value});
  const double deviation = reader.number("sd", Range::positive(largest_value));
  if (values.empty()) {
    return {};
  }
  if (is_log && (mean <= 0.0 || values.front() <= 0.0)) {
    reader.reject("prior", "is log_normal, but its mean or its values are not all above 0");
    return {};
  }
  std::vector<double> weights;
  double sum = 0.0;
  for (const double value : values) {
    const double distance = is_log ? std::log10(value / mean) : value - mean;
    weights.push_back(std::exp(-0.5 * distance * distance / (deviation * deviation)));
    sum += weights.back();
  }
  if (!(sum > 0.0)) {
    reader.reject("prior", "excludes every value: mean is too far from them for this sd");
    return {};
  }
  return weights;
}

std::vector<double> listed_weights(MapReader& reader, std::size_t values) {
  std::vector<double> weights = reader.number_list("weights", {0.0, largest_value});
  if (values == 0) {
    return {};
  }
  if (weights.size() != values) {
    reader.reject("weights", fmt::format("are {}, values are {}", weights.size(), values));
    return {};
  }
  if (!(std::accumulate(weights.begin(), weights.end(), 0.0) > 0.0)) {
    reader.reject("weights", "are all 0: the prior excludes every value");
    return {};
  }
  return weights;
}

void refuse_keys_of_others(MapReader& reader, Prior prior) {
  const bool is_bell = prior == Prior::normal || prior == Prior::log_normal;
  for (const char* key : {"mean", "sd"}) {
    if (!is_bell && reader.has(key)) {
      reader.reject(key, "is for prior: normal or log_normal only");
    }
  }
  if (prior != Prior::listed && reader.has("weights")) {
    reader.reject("weights", "is for prior: listed only");
  }
}
}  // namespace

std::vector<double> read_prior(MapReader& reader, const std::vector<double>& values) {
  const auto prior = reader.one_of<Prior>("prior",
                                          {{"uniform", Prior::uniform},
                                           {"normal", Prior::normal},
                                           {"log_normal", Prior::log_normal},
                                           {"listed", Prior::listed}},
                                          "uniform");
  refuse_keys_of_others(reader, prior);
  if (prior == Prior::uniform) {
    return std::vector<double>(values.size(), 1.0);
  }
  if (prior == Prior::listed) {
    return listed_weights(reader, values.size());
  }
  return bell_weights(reader, values, prior == Prior::log_normal);
}
}  // namespace tapstudy::protocols
