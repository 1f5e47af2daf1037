#include "protocols/procedures/procedure.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/error.hpp"
#include "protocols/axes/axis_range.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
std::optional<std::vector<double>> Track::next() const {
  if (is_finished()) {
    return std::nullopt;
  }
  return request();
}

void Track::observe(const std::vector<double>& presented, std::size_t outcome) {
  if (presented.size() != axes_ ||
      !std::ranges::all_of(presented, [](double value) { return std::isfinite(value); })) {
    throw core::InvalidInput{
        fmt::format("a stimulus of this procedure is {} finite values", axes_)};
  }
  if (outcome >= outcomes_) {
    throw core::InvalidInput{
        fmt::format("outcome {}: outcomes of this procedure are 0 to {}", outcome, outcomes_ - 1)};
  }
  if (is_finished()) {
    throw core::InvalidInput{fmt::format("the procedure has ended after {} trials", trials_)};
  }
  take(presented, outcome);
  ++trials_;
}

const std::vector<const Procedure*>& procedures() {
  static const std::vector<const Procedure*> table{&constant_stimuli(), &staircase(), &quest_plus(),
                                                   &psi()};
  return table;
}

std::shared_ptr<const TrackSettings> read_procedure(MapReader& reader) {
  std::shared_ptr<const TrackSettings> settings;
  std::vector<std::string> names;
  for (const Procedure* procedure : procedures()) {
    names.emplace_back(procedure->name());
    reader.map({std::string{procedure->name()}, std::string{procedure->meaning()}},
               MapReader::Presence::optional,
               [&](MapReader& own) { settings = procedure->read(own); });
  }
  const int given = reader.count_given(names, MapReader::Presence::required);
  if (given != 1) {
    reader.reject(
        fmt::format("names {} procedures instead of one (of: {})", given, fmt::join(names, ", ")));
    return nullptr;
  }
  return settings;
}

namespace {
std::optional<std::vector<double>> listed(MapReader& reader, const Range& allowed) {
  for (const char* key : {"min", "max", "count", "spacing"}) {
    reader.refuse(key, "is not for values that are listed");
  }
  std::vector<double> values =
      reader.number_list({"values", "values to present, in increasing order"}, allowed);
  reader.check("values", values.size() <= max_grid_values,
               fmt::format(R"({{"maxItems": {}, "uniqueItems": true}})", max_grid_values),
               "are too many (at most 10000)");
  if (values.size() > max_grid_values) {
    return std::nullopt;
  }
  if (values.empty() || std::ranges::adjacent_find(values, std::greater_equal{}) != values.end()) {
    reader.reject("values", "are not in increasing order, each once");
    return std::nullopt;
  }
  return values;
}
}  // namespace

std::optional<std::vector<double>> read_grid(MapReader& reader, const Range& stated) {
  const Range allowed = reader.narrowed(stated, {-largest_value, largest_value});
  if (reader.has("values")) {
    return listed(reader, allowed);
  }
  const auto spaced = read_spaced(reader, {"min", "max"}, allowed, max_grid_values);
  return spaced ? std::optional{spaced->values} : std::nullopt;
}
}  // namespace tapstudy::protocols
