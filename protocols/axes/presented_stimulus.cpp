#include "protocols/axes/presented_stimulus.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.hpp"
namespace tapstudy::protocols {
namespace {
std::vector<std::string> axes_of(const Stimulus& stimulus) {
  std::vector<std::string> names;
  std::ranges::transform(stimulus.vary, std::back_inserter(names),
                         [](const AxisRange& range) { return std::string{range.axis->name}; });
  return names;
}

// Throws InvalidInput unless the stimulus can be asked to vary so.
const AxisRange& range_of(const std::string& name, const Stimulus& stimulus,
                          const PresentedStimulus& unvaried) {
  const Axis* const axis = find_axis(name);
  if (axis == nullptr) {
    throw core::InvalidInput{fmt::format("'{}' is not an axis (one of: {}{})", name,
                                         fmt::join(axis_names(), ", "),
                                         did_you_mean(name, axis_names()))};
  }
  if (const std::string why = refusal(*axis, unvaried); !why.empty()) {
    throw core::InvalidInput{fmt::format("stimulus '{}': {}: {}", stimulus.name, name, why)};
  }
  const auto found = std::ranges::find(stimulus.vary, axis, &AxisRange::axis);
  if (found == stimulus.vary.end()) {
    throw core::InvalidInput{
        fmt::format("stimulus '{}' does not vary in {} ({})", stimulus.name, name,
                    stimulus.vary.empty()
                        ? "it has no vary"
                        : fmt::format("it varies in: {}", fmt::join(axes_of(stimulus), ", ")))};
  }
  return *found;
}

PresentedStimulus unvaried(const Protocol& protocol, const Stimulus& stimulus) {
  PresentedStimulus presented{stimulus.name,
                              stimulus.plate,
                              stimulus.material,
                              stimulus.technique,
                              protocol.rendering,
                              {},
                              {},
                              stimulus.plate,
                              stimulus.contacts};
  presented.rendering.lateral_ratio = stimulus.plate->lateral_ratio;
  presented.rendering.recorded_taps = stimulus.recording;
  for (const auto& [axis, value] : stimulus.rendering) {
    find_axis(axis)->set(presented, value);
  }
  return presented;
}
}  // namespace

std::string PresentedStimulus::title() const {
  return changed.empty() ? fmt::format("stimulus '{}'", name)
                         : fmt::format("stimulus '{}' at {}", name, described(changed));
}

PresentedStimulus stimulus_with(const Protocol& protocol, const Stimulus& stimulus,
                                const AxisValues& values) {
  PresentedStimulus presented = unvaried(protocol, stimulus);
  presented.vary_stated_at = stimulus.vary_stated_at;
  for (const AxisRange& range : stimulus.vary) {
    const std::string name{range.axis->name};
    const double own = range.axis->value(presented);
    const auto given = values.find(name);
    const double value = given == values.end() ? own : given->second;
    presented.values[name] = value;
    if (value != own) {
      presented.changed[name] = value;
      range.axis->set(presented, value);
    }
  }
  return presented;
}

AxisValues presented_values(const Protocol& protocol, const Stimulus& stimulus,
                            const AxisValues& asked) {
  const PresentedStimulus own = stimulus_with(protocol, stimulus);
  AxisValues values = own.values;
  for (const auto& [name, value] : asked) {
    const AxisRange& range = range_of(name, stimulus, own);
    try {
      values[name] = range.presented(value);
    } catch (const core::InvalidInput& error) {
      throw core::InvalidInput{fmt::format("stimulus '{}': {}", stimulus.name, error.what())};
    }
  }
  return values;
}

PresentedStimulus stimulus_at(const Protocol& protocol, const Stimulus& stimulus,
                              const AxisValues& asked) {
  return stimulus_with(protocol, stimulus, presented_values(protocol, stimulus, asked));
}

std::vector<AxisValues> table_of_models(const Protocol& protocol, const Stimulus& stimulus) {
  const AxisValues own = stimulus_with(protocol, stimulus).values;
  std::vector<AxisValues> rows{{}};
  for (const AxisRange& range : stimulus.vary) {
    const std::string name{range.axis->name};
    std::vector<AxisValues> longer = rows;
    for (const double value : range.table) {
      for (AxisValues values : value == own.at(name) ? std::vector<AxisValues>{} : rows) {
        values[name] = value;
        longer.push_back(std::move(values));
      }
    }
    rows = std::move(longer);
  }
  return rows;
}
}  // namespace tapstudy::protocols
