// Tapping points, stimuli and hypotheses.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/model/beam.hpp"
#include "core/model/shape/top_height.hpp"
#include "protocols/read_sections.hpp"
namespace tapstudy::protocols {
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
                                                   top_height.outline_words(at_m)));
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
                  fmt::format("'{}' is for {}", stimulus.technique->name, core::what_a_beam_is));
  }
  if (stimulus.recording && !stimulus.technique->has(core::recorded_transient)) {
    reader.reject("recording",
                  fmt::format("technique '{}' does not play it", stimulus.technique->name));
  }
}

}  // namespace

void read_points(MapReader& top, Protocol& protocol) {
  top.each_point("tapping_points_m", Presence::required,
                 [&](const std::string& name, const Eigen::Vector2d& at_m) {
                   protocol.tapping_points_m[name] = at_m;
                 });
}

std::vector<std::string> stimulus_names(const Protocol& protocol) {
  std::vector<std::string> names;
  std::ranges::transform(protocol.stimuli, std::back_inserter(names), &Stimulus::name);
  return names;
}

void read_stimuli(MapReader& top, Protocol& protocol) {
  top.each("stimuli", Presence::required, [&](const std::string& name, MapReader& reader) {
    Stimulus stimulus;
    stimulus.name = name;
    stimulus.label = reader.translated("label", name);
    stimulus.plate =
        named(protocol.plates, reader.word("plate", "plate", keys_of(protocol.plates)));
    stimulus.material =
        named(protocol.materials, reader.word("material", "material", keys_of(protocol.materials)));
    stimulus.technique =
        core::find_technique(reader.word("technique", "technique", core::technique_names()));
    if (reader.has("recording")) {
      stimulus.recording = named(
          protocol.recordings, reader.word("recording", "recording", keys_of(protocol.recordings)));
    }
    reader.each_text("factors", Presence::optional,
                     [&](const std::string& factor, const std::string& level) {
                       stimulus.factors[factor] = level;
                     });
    if (reader.has("contacts")) {
      stimulus.contacts = named(protocol.contacts, reader.word("contacts", "set of contacts",
                                                               keys_of(protocol.contacts)));
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

void read_hypotheses(MapReader& top, Protocol& protocol) {
  std::vector<std::string> blocks;
  std::ranges::transform(protocol.blocks, std::back_inserter(blocks), &Block::name);
  top.list("hypotheses", Presence::optional, [&](MapReader& reader) {
    Hypothesis hypothesis;
    hypothesis.name = reader.name("name");
    hypothesis.statement = reader.text("statement");
    hypothesis.block = reader.word("block", "block", blocks);
    hypothesis.claim =
        reader.one_of<Claim>("claim", {{"accuracy_above_chance", Claim::accuracy_above_chance},
                                       {"chosen_above_chance", Claim::chosen_above_chance},
                                       {"rated_highest", Claim::rated_highest}});
    const auto block = std::ranges::find(protocol.blocks, hypothesis.block, &Block::name);
    const bool is_known = block != protocol.blocks.end() && block->task != nullptr;
    if (hypothesis.claim != Claim::accuracy_above_chance) {
      hypothesis.stimulus = reader.word("stimulus", "stimulus of the block",
                                        is_known ? block->stimuli : stimulus_names(protocol));
    }
    if (is_known && block->task->claim() != hypothesis.claim) {
      reader.reject("claim", "does not fit the task of the block");
    } else if (is_known && block->comparison) {
      reader.reject("block", "has procedures: its threshold is estimated, and no claim is tested");
    }
    protocol.hypotheses.push_back(hypothesis);
  });
}
}  // namespace tapstudy::protocols
