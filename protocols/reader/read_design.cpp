// Tapping points and stimuli.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/model/beam.hpp"
#include "core/model/shape/shape.hpp"
#include "protocols/axes/axis_range.hpp"
#include "protocols/axes/presented_stimulus.hpp"
#include "protocols/reader/read_sections.hpp"
// The axes along which a stimulus varies, and what of rendering is its own.
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;
constexpr int max_count = 1000;

std::optional<SpacedValues> read_listed(MapReader& reader, const Range& allowed) {
  const std::size_t earlier_problems = reader.problems_in_file();
  SpacedValues listed{reader.number_list({"values", "what can be presented"}, allowed),
                      read_spacing(reader)};
  std::ranges::sort(listed.values);
  const auto twice = std::ranges::adjacent_find(listed.values);
  const bool are_different = twice == listed.values.end();
  reader.check("values", are_different, R"({"uniqueItems": true})",
               are_different ? "" : fmt::format("{} is listed twice", *twice));
  const bool is_read = reader.problems_in_file() == earlier_problems;
  return is_read && check_spacing(reader, listed.spacing, listed.values.front())
             ? std::optional{listed}
             : std::nullopt;
}

// nullopt: a problem was noted.
std::optional<AxisRange> read_range(MapReader& reader, const Axis& axis, const Range& allowed) {
  const EndKeys keys{"from", "to"};
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
  const auto range = read_range(
      reader, axis,
      reader.narrowed(axis.of_any_stimulus, why.empty() ? axis.allowed(own) : any_number()));
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
  stimulus_reader.map(
      {"rendering", "what is not the study's rendering: the gain of each part of the force"},
      Presence::optional, [&](MapReader& reader) {
        for (const Axis& axis : axes()) {
          const std::string name{axis.name};
          if (!axis.is_of_rendering) {
            continue;
          }
          const std::string why = why_refused(axis, studys);
          const Range range = why.empty() ? axis.allowed(studys) : any_number();
          const Key key{name, fmt::format("{}; unset: the study's", axis.meaning)};
          const double value =
              reader.number(key, reader.narrowed(axis.of_any_stimulus, range), 0.0);
          if (!reader.has(name)) {
            continue;
          }
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
  int named = 0;
  stimulus_reader.map(
      {"vary",
       "axes along which the stimulus varies, which makes it a family; trials without values "
       "present the stimulus's own; of a table the nearest value is presented, never an "
       "interpolated one; at most 200 models; unset: it does not vary"},
      Presence::optional, [&](MapReader& vary) {
        named = vary.count_given(axis_names(), Presence::at_least_one);
        for (const Axis& axis : axes()) {
          const Key key{std::string{axis.name},
                        fmt::format("{}; unset: the stimulus's own", axis.meaning)};
          const auto read = [&](MapReader& reader) { read_axis(reader, axis, own, stimulus.vary); };
          if (axis.kind == AxisKind::scaled) {
            vary.map_or_list(key, Presence::optional, {"from", "to", "spacing"}, read);
          } else {
            vary.map(key, Presence::optional, read);
          }
        }
        if (named == 0) {
          vary.reject(fmt::format("names no axis (one of: {})", fmt::join(axis_names(), ", ")));
        }
        check_models(vary, stimulus.vary, own);
      });
  stimulus.vary_stated_at = stimulus_reader.stated_at("vary");
  stimulus.is_vary_refused =
      stimulus_reader.has("vary") && (stimulus.vary.empty() || std::ssize(stimulus.vary) < named);
}

namespace {
using Presence = MapReader::Presence;
constexpr double same_height_m = 1e-3;

// By other bodies, but by nobody who takes part.
bool is_only_touched(const Plate& plate, const Protocol& protocol) {
  const auto is_this = [&](const std::shared_ptr<const Plate>& other) {
    return other.get() == &plate;
  };
  return std::ranges::none_of(protocol.stimuli, is_this, &Stimulus::plate) &&
         std::ranges::any_of(protocol.contacts, [&](const auto& contacts) {
           return std::ranges::any_of(contacts.second->plates, is_this);
         });
}

// Plates of one study must not be told apart by where or how high they are touched.
void check_points(MapReader& top, const Protocol& protocol) {
  std::map<std::string, double> height_of_point_m;
  for (const auto& [name, plate] : protocol.plates) {
    if (is_only_touched(*plate, protocol)) {
      continue;
    }
    const core::TopHeight top_height{plate->shape};
    for (const auto& [point, at_m] : plate->tapping_points_m) {
      const auto height_m = top_height.at_m(at_m);
      if (!height_m) {
        top.reject("tapping_points_m", fmt::format("{} is off plate '{}' ({})", point, name,
                                                   top_height.describe_touchable(at_m)));
        continue;
      }
      const auto known = height_of_point_m.emplace(point, *height_m).first;
      if (std::abs(known->second - *height_m) > same_height_m) {
        top.reject("tapping_points_m",
                   fmt::format("{}: plate '{}' is {:.4g} m high there, another {:.4g} m (plates "
                               "must not be distinguishable by height; within {} m)",
                               point, name, *height_m, known->second, same_height_m));
      }
    }
  }
}

// Reports break down accuracy by factor, so every stimulus needs a level of each.
void check_factors(MapReader& reader, const Stimulus& stimulus, const Protocol& protocol) {
  if (protocol.stimuli.empty()) {
    return;
  }
  const Stimulus& first = protocol.stimuli.front();
  if (keys_of(first.factors) != keys_of(stimulus.factors)) {
    reader.reject("factors",
                  fmt::format("are not those of stimulus '{}': all stimuli have the same factors",
                              first.name));
  }
}

void check_technique(MapReader& reader, const Stimulus& stimulus, const Protocol& protocol) {
  if (stimulus.technique == nullptr) {
    return;
  }
  core::RenderSettings settings = protocol.rendering;
  settings.recorded_taps = stimulus.recording;
  const std::string_view missing = stimulus.technique->missing(settings);
  if (!missing.empty()) {
    reader.reject("technique", fmt::format("'{}' needs {}", stimulus.technique->name, missing));
  }
  if (stimulus.technique->needs_beam() && stimulus.plate && !core::beam_of(*stimulus.plate)) {
    reader.reject("technique",
                  fmt::format("'{}' is for {}", stimulus.technique->name, core::beam_requirements));
  }
  if (stimulus.technique->needs_beam() && stimulus.material && stimulus.material->orthotropy) {
    reader.reject("technique", core::beams_are_isotropic);
  }
}

}  // namespace

void read_points(MapReader& top, Protocol& protocol) {
  top.each_point(
      {"tapping_points_m", "named points on the plates, from the centre: x right, y away"},
      Presence::required, [&](const std::string& name, const Eigen::Vector2d& at_m) {
        protocol.tapping_points_m[name] = at_m;
      });
}

std::vector<std::string> stimulus_names(const Protocol& protocol) {
  std::vector<std::string> names;
  std::ranges::transform(protocol.stimuli, std::back_inserter(names), &Stimulus::name);
  return names;
}

void read_stimuli(MapReader& top, Protocol& protocol) {
  top.each(
      {"stimuli", "what can be presented: a plate of a material, rendered by a technique"},
      Presence::required, [&](const std::string& name, MapReader& reader) {
        Stimulus stimulus;
        stimulus.name = name;
        stimulus.label = reader.translated(
            {"label", "what participants read; unset: the stimulus's name"}, name);
        stimulus.plate = named(protocol.plates, reader.word({"plate", "name of a plate"}, "plate",
                                                            keys_of(protocol.plates)));
        stimulus.material =
            named(protocol.materials, reader.word({"material", "name of a material"}, "material",
                                                  keys_of(protocol.materials)));
        stimulus.technique = core::find_technique(reader.word(
            {"technique",
             "added to the contact spring: nothing, decaying sinusoid at each impact, vibration of "
             "the plate, both, or a finger that stays on the vibrating plate, each acting on the "
             "other; or the vibration of a beam in closed form; or a measured transient at each "
             "impact; these without or with the sinusoid"},
            "technique", core::technique_names()));
        if (stimulus.technique != nullptr && !stimulus.technique->has(core::recorded_transient)) {
          reader.refuse("recording",
                        fmt::format("technique '{}' does not play it", stimulus.technique->name));
        } else if (stimulus.technique != nullptr || reader.has("recording")) {
          stimulus.recording = named(
              protocol.recordings,
              reader.word({"recording",
                           "name of a recording; techniques recorded and recorded+sinusoid only"},
                          "recording", keys_of(protocol.recordings)));
        }
        reader.each_text({"factors",
                          "factor and level, by which reports break down accuracy; the same "
                          "factors for all stimuli"},
                         Presence::optional,
                         [&](const std::string& factor, const std::string& level) {
                           stimulus.factors[factor] = level;
                         });
        if (reader.has("contacts")) {
          stimulus.contacts =
              named(protocol.contacts,
                    reader.word(
                        {"contacts",
                         "key in contacts, of this plate; youngs_modulus_pa, density_kg_per_m3 and "
                         "lateral_size_m cannot vary then; unset: the plate touches no other body"},
                        "set of contacts", keys_of(protocol.contacts)));
        }
        check_factors(reader, stimulus, protocol);
        check_technique(reader, stimulus, protocol);
        check_contacts(reader, stimulus, protocol);
        stimulus.rendering = read_own_rendering(reader, stimulus, protocol);
        read_vary(reader, protocol, stimulus);
        protocol.stimuli.push_back(stimulus);
      });
  check_points(top, protocol);
}
}  // namespace tapstudy::protocols
