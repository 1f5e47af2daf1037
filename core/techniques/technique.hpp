#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/model/plate.hpp"
#include "core/techniques/force_part.hpp"
namespace tapstudy::core {
// A rendering technique: the components added to the penalty force of the contact spring. The
// components of a technique are distinct, and are added in order.
struct Technique {
  std::string_view name;  // in protocols, stores and reports
  std::vector<const ForcePart*> parts;
  Theory theory{Theory::solid};  // of the model

  bool needs_model() const;
  bool needs_beam() const { return needs_model() && theory == Theory::beam; }
  bool has(const ForcePart& part) const;
  // Beside the contact spring's, of a slow press.
  double added_stiffness_n_per_m(const RenderSettings& settings) const;
  // The missing setting: see ForcePart.
  std::string_view missing(const RenderSettings& settings) const;
};

// All techniques; a new one is a row in this table, plus a ForcePart if it adds a new force. A
// force that is neither of the two in ForceParts is stored as a column of its own: ForceParts,
// TraceSample and its codec.
const std::vector<Technique>& techniques();
// nullptr if there is none of that name.
const Technique* find_technique(std::string_view name);
std::vector<std::string> technique_names();
// The one that vibrates as the body does, with nothing added.
const Technique& natural_vibration();
}  // namespace tapstudy::core
