#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/techniques/force_part.hpp"
namespace tapstudy::core {
// A rendering technique: which parts are added to the penalty force of the soft contact spring. The
// parts of a technique differ, and are added in their order.
struct Technique {
  std::string_view name;  // in protocols, stores and reports
  std::string_view summary;
  std::vector<const ForcePart*> parts;

  bool needs_model() const;
  // What of the settings it lacks: see ForcePart.
  std::string_view missing(const RenderSettings& settings) const;
};

// All there are; a new one is a row here, and a part of its own if it adds something new.
const std::vector<Technique>& techniques();
// nullptr if there is none of that name.
const Technique* find_technique(std::string_view name);
std::vector<std::string> technique_names();
}  // namespace tapstudy::core
