#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "protocols/protocol.hpp"
#include "protocols/reader/earlier_defaults.hpp"
#include "protocols/surface/surface_file.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
// The sections of a protocol, each reading its part of the file into its part of the Protocol.
// Sections that refer to other sections are read after them.
void read_rendering(MapReader& top, Protocol& protocol);
void read_placement(MapReader& top, const Key& key, MapReader::Presence presence,
                    const std::function<void(const core::Placement&)>& take);
void read_materials(MapReader& top, Protocol& protocol);
void read_points(MapReader& top, Protocol& protocol);
void read_plates(MapReader& top, Protocol& protocol, const SurfaceFiles& files,
                 const EarlierDefaults& defaults);
void read_recordings(MapReader& top, Protocol& protocol);
void read_contacts(MapReader& top, Protocol& protocol);
// Of a stimulus whose other keys are read.
void check_contacts(MapReader& stimulus_reader, const Stimulus& stimulus, const Protocol& protocol);
inline constexpr const char* modal_ratios_in_contact =
    "its modal_ratios are of a plate's own modes, which it has no more in contact with others "
    "(give "
    "coefficients, measured ratios or one ratio)";
void read_stimuli(MapReader& top, Protocol& protocol);
// The axes of a stimulus whose other keys are read.
AxisValues read_own_rendering(MapReader& stimulus_reader, const Stimulus& stimulus,
                              const Protocol& protocol);
void read_vary(MapReader& stimulus_reader, const Protocol& protocol, Stimulus& stimulus);
// A picture beside what participants read.
std::optional<Picture> read_picture(MapReader& reader, const Key& key, const ReadFile& read_file,
                                    Protocol& protocol);
// One for each of so many, in their order; or none.
std::vector<Picture> read_pictures(MapReader& reader, const Key& key, std::size_t count,
                                   const ReadFile& read_file, Protocol& protocol);
// The key `instructions_picture` beside these instructions.
std::optional<Picture> read_instructions_picture(MapReader& reader, const std::string& instructions,
                                                 const ReadFile& read_file, Protocol& protocol);
void read_forms(MapReader& top, const ReadFile& read_file, Protocol& protocol);
std::vector<std::string> read_form_names(MapReader& reader, const Key& key,
                                         const Protocol& protocol);
// Of a block.
std::optional<AnswerCondition> read_presented_if(MapReader& block_reader, const Protocol& protocol);
void read_display(MapReader& top, Protocol& protocol);
void read_blocks(MapReader& top, const ReadFile& read_file, Protocol& protocol);
// Makes a block for each session of one that is in several.
void read_planned_sessions(MapReader& top, Protocol& protocol);
void read_block_order(MapReader& top, Protocol& protocol);
void read_groups(MapReader& top, Protocol& protocol);
// Of a block: what a participant reads and is asked besides the trials' question.
void read_between_trials(MapReader& block_reader, Block& block);
ExploreLimits read_explore(MapReader& block_reader, const Protocol& protocol, Presented presented);
// Of a block that is otherwise without problems.
void check_intervals(MapReader& block_reader, const Block& block);
// Two answers that read alike cannot be told apart by who gives them. Unset: they can.
std::optional<std::string> why_not_told_apart(const std::vector<Option>& options);
void check_labels_differ(MapReader& block_reader, const Protocol& protocol, const Block& block);
// Where as much is right by guessing, answers do not depend on the level, and a staircase wanders.
void check_targets(MapReader& block_reader, const Protocol& protocol, const Block& block);
void read_hypotheses(MapReader& top, Protocol& protocol);
void read_masking(MapReader& top, Protocol& protocol);
void read_simulation(MapReader& top, Protocol& protocol);

std::vector<std::string> stimulus_names(const Protocol& protocol);
// Of a row of a list whose rows have names of their own; kind: "group".
template <class Rows>
void check_name_is_new(MapReader& row_reader, const Rows& earlier, const std::string& name,
                       const char* kind) {
  if (std::ranges::any_of(earlier, [&](const auto& row) { return row.name == name; })) {
    row_reader.reject("name", fmt::format("'{}' is the name of an earlier {}", name, kind));
  }
}
// A null value for a name that was rejected.
template <class Value>
std::shared_ptr<const Value> named(const std::map<std::string, std::shared_ptr<const Value>>& all,
                                   const std::string& name) {
  const auto found = all.find(name);
  return found == all.end() ? nullptr : found->second;
}
template <class Value>
std::vector<std::string> keys_of(const std::map<std::string, Value>& named) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : named) {
    keys.push_back(key);
  }
  return keys;
}
}  // namespace tapstudy::protocols
