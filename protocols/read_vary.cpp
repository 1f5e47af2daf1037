// The axes along which a stimulus varies, and what of rendering is its own.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "protocols/axes/presented_stimulus.hpp"
#include "protocols/axes/read_spaced.hpp"
#include "protocols/read_sections.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;
constexpr int max_count = 1000;

std::optional<SpacedValues> read_listed(MapReader& reader, const Range& allowed) {
  const std::size_t earlier_problems = reader.problems_in_file();
  SpacedValues listed{reader.number_list("values", allowed), read_spacing(reader)};
  std::ranges::sort(listed.values);
  if (const auto twice = std::ranges::adjacent_find(listed.values); twice != listed.values.end()) {
    reader.reject("values", fmt::format("{} is listed twice", *twice));
  }
  const bool is_read = reader.problems_in_file() == earlier_problems;
  return is_read && check_spacing(reader, listed.spacing, listed.values.front())
             ? std::optional{listed}
             : std::nullopt;
}

// nullopt: a problem was noted.
std::optional<AxisRange> read_range(MapReader& reader, const Axis& axis, const Range& allowed) {
  constexpr EndKeys keys{"from", "to"};
  if (axis.kind == AxisKind::scaled) {
    const auto ends = read_ends(reader, keys, allowed);
    return ends ? std::optional{AxisRange{&axis, ends->low, ends->high, ends->spacing}}
                : std::nullopt;
  }
  const auto table = reader.has("values") ? read_listed(reader, allowed)
                                          : read_spaced(reader, keys, allowed, max_count);
  return table ? std::optional{AxisRange{&axis, table->values.front(), table->values.back(),
                                         table->spacing, table->values}}
               : std::nullopt;
}

// Where a name was rejected, something in its place, so that reading can continue.
Stimulus whole(Stimulus stimulus) {
  if (!stimulus.plate) {
    Plate plate;
    plate.shape = core::Box{core::Vec3::Ones()};
    stimulus.plate = std::make_shared<const Plate>(std::move(plate));
  }
  if (!stimulus.material) {
    stimulus.material = std::make_shared<const Material>();
  }
  return stimulus;
}

// The stimulus's own values are presented too.
void check_models(MapReader& vary, const std::vector<AxisRange>& ranges,
                  const PresentedStimulus& own) {
  std::size_t models = 1;
  std::vector<std::string> counts;
  for (const AxisRange& range : ranges) {
    if (range.axis->kind == AxisKind::tabled) {
      const bool has_own =
          std::ranges::find(range.table, range.axis->value(own)) != range.table.end();
      models *= range.table.size() + (has_own ? 0 : 1);
      counts.push_back(fmt::format("{} of {}{}", range.table.size(), range.axis->name,
                                   has_own ? "" : " and the stimulus's own"));
    }
  }
  if (models > max_models_of_a_stimulus) {
    vary.reject(fmt::format("asks for {} models: {} (at most {} for one stimulus)", models,
                            fmt::join(counts, ", times "), max_models_of_a_stimulus));
  }
}

Range any_number() {
  return {std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max()};
}
// Whether it is used is not known where the technique was rejected.
std::string why_refused(const Axis& axis, const PresentedStimulus& own) {
  return own.technique == nullptr ? std::string{} : refusal(axis, own);
}
// A refused axis is read all the same, so that its keys are not reported as unknown.
void read_axis(MapReader& reader, const Axis& axis, const PresentedStimulus& own,
               std::vector<AxisRange>& ranges) {
  const std::string why = why_refused(axis, own);
  const auto range = read_range(reader, axis, why.empty() ? axis.allowed(own) : any_number());
  if (!why.empty()) {
    reader.reject(why);
  } else if (range) {
    ranges.push_back(*range);
  }
}
}  // namespace

AxisValues read_own_rendering(MapReader& stimulus_reader, const Stimulus& stimulus,
                              const Protocol& protocol) {
  AxisValues values;
  const PresentedStimulus studys = stimulus_with(protocol, whole(stimulus));
  stimulus_reader.map("rendering", Presence::optional, [&](MapReader& reader) {
    for (const Axis& axis : axes()) {
      const std::string name{axis.name};
      if (!axis.is_of_rendering) {
        continue;
      }
      if (!reader.has(name)) {
        reader.number(name, any_number(), 0.0);  // a known key, if not given
        continue;
      }
      const std::string why = why_refused(axis, studys);
      const double value = reader.number(name, why.empty() ? axis.allowed(studys) : any_number());
      if (why.empty()) {
        values[name] = value;
      } else {
        reader.reject(name, why);
      }
    }
  });
  return values;
}

void read_vary(MapReader& stimulus_reader, const Protocol& protocol, Stimulus& stimulus) {
  const PresentedStimulus own = stimulus_with(protocol, whole(stimulus));
  std::size_t named = 0;
  stimulus_reader.map("vary", Presence::optional, [&](MapReader& vary) {
    for (const Axis& axis : axes()) {
      named += vary.has(std::string{axis.name}) ? 1 : 0;
      const auto read = [&](MapReader& reader) { read_axis(reader, axis, own, stimulus.vary); };
      if (axis.kind == AxisKind::scaled) {
        vary.map_or_list(std::string{axis.name}, Presence::optional, {"from", "to", "spacing"},
                         read);
      } else {
        vary.map(std::string{axis.name}, Presence::optional, read);
      }
    }
    if (named == 0) {
      vary.reject(fmt::format("names no axis (one of: {})", fmt::join(axis_names(), ", ")));
    }
    check_models(vary, stimulus.vary, own);
  });
  stimulus.vary_stated_at = stimulus_reader.stated_at("vary");
  stimulus.is_vary_refused =
      stimulus_reader.has("vary") && (stimulus.vary.empty() || stimulus.vary.size() < named);
}
}  // namespace tapstudy::protocols
