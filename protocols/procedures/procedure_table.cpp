#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "protocols/procedures/shipped_procedures.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
const std::vector<const Procedure*>& procedures() {
  static const std::vector<const Procedure*> table{&constant_stimuli(), &staircase(), &quest_plus(),
                                                   &psi()};
  return table;
}

std::shared_ptr<const TrackSettings> read_procedure(MapReader& reader) {
  std::shared_ptr<const TrackSettings> settings;
  std::vector<std::string_view> names;
  int given = 0;
  for (const Procedure* procedure : procedures()) {
    names.push_back(procedure->name());
    reader.map(std::string{procedure->name()}, MapReader::Presence::optional,
               [&](MapReader& own) { settings = procedure->read(own); });
    given += reader.has(std::string{procedure->name()}) ? 1 : 0;
  }
  if (given != 1) {
    reader.reject(
        fmt::format("names {} procedures instead of one (of: {})", given, fmt::join(names, ", ")));
    return nullptr;
  }
  return settings;
}
}  // namespace tapstudy::protocols
