#pragma once
#include <memory>
#include <string>

#include "protocols/procedures/procedure.hpp"
#include "protocols/yaml/problems.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::testing {
// A procedure as a protocol states it, such as "psi: {...}". Throws InvalidInput.
inline std::shared_ptr<const protocols::TrackSettings> procedure_of(const std::string& yaml) {
  protocols::Problems problems{"p.yaml"};
  auto reader = protocols::MapReader::whole_file(yaml, "p.yaml", problems);
  auto settings = protocols::read_procedure(reader);
  reader.finish();
  problems.throw_if_any();
  return settings;
}
// Presents what is requested until the track ends.
template <typename Observer>
void run(protocols::Track& track, Observer&& observer) {
  while (const auto values = track.next()) {
    track.observe(*values, observer(*values));
  }
}
}  // namespace tapstudy::testing
