#include "protocols/tasks/shared_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.hpp"
#include "protocols/axes/presented_stimulus.hpp"
namespace tapstudy::protocols {
std::vector<std::string> axes_of(const Protocol& protocol, const std::string& stimulus) {
  std::vector<std::string> names;
  const auto found = std::ranges::find(protocol.stimuli, stimulus, &Stimulus::name);
  if (found != protocol.stimuli.end()) {
    for (const AxisRange& range : found->vary) {
      names.emplace_back(range.axis->name);
    }
  }
  return names;
}

bool is_vary_refused(const Protocol& protocol, const Block& block) {
  return std::ranges::any_of(block.stimuli, [&](const std::string& name) {
    const auto found = std::ranges::find(protocol.stimuli, name, &Stimulus::name);
    return found != protocol.stimuli.end() && found->is_vary_refused;
  });
}

std::string read_axis(MapReader& reader, const Protocol& protocol, const Block& block,
                      const std::vector<std::string>& axes) {
  const Key key{
      "axis",
      "with procedures: along which the comparison differs from its standard; magnitude: of the "
      "values; adjustment: that is moved along; unset: the only one of the stimulus"};
  if (reader.has(key.name) && is_vary_refused(protocol, block)) {
    return reader.text(key);
  }
  return reader.word(key, "axis of the stimuli", axes,
                     reader.depends_on_others(axes.size() == 1)
                         ? std::optional{axes.empty() ? std::string{} : axes.front()}
                         : std::nullopt);
}

double read_standard_value(MapReader& reader, const Range& range, double own) {
  return reader.number(
      {"standard",
       "with procedures, or adjustment without a reference: value on the axis, in its unit; "
       "adjustment: within the settings; unset: the stimulus's own"},
      range, own);
}

int read_alternatives(MapReader& reader, int low, int high, int usual) {
  return reader.integer(
      {"alternatives",
       "comparison: 2 to 8; odd_one_out: 3 or 4; match_to_sample: 2 to 4; unset: 2, or 3"},
      low, high, usual);
}

void read_response_labels(MapReader& reader, const std::vector<std::string>& responses,
                          Block& block) {
  reader.each_translated(
      {"response_labels",
       "by level of response_factor, or of same and different; unset: the level itself"},
      MapReader::Presence::optional, [&](const std::string& response, const std::string& label) {
        if (std::ranges::find(responses, response) == responses.end()) {
          reader.reject("response_labels", fmt::format("'{}' cannot be answered (one of: {})",
                                                       response, fmt::join(responses, ", ")));
        }
        block.response_labels[response] = label;
      });
}

std::vector<double> presented_on_axis(MapReader& reader, const std::string& key,
                                      const Protocol& protocol, const Block& block,
                                      const ValuesOnAxis& asked) {
  std::vector<double> values;
  try {
    for (const std::string& name : block.stimuli) {
      if (!protocol.stimulus(name).is_complete()) {
        return {};
      }
      values.clear();
      for (const double value : asked.values) {
        values.push_back(presented_values(protocol, protocol.stimulus(name), {{asked.axis, value}})
                             .at(asked.axis));
      }
    }
  } catch (const core::InvalidInput& error) {
    reader.reject(key, error.what());
    return {};
  }
  if (std::ranges::adjacent_find(values, std::greater_equal{}) != values.end()) {
    reader.reject(key, "are not in increasing order, each once, as they are presented");
    return {};
  }
  return values;
}
}  // namespace tapstudy::protocols
