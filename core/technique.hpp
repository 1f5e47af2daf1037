#pragma once
#include <array>
#include <string_view>
namespace tapstudy::core {
// A rendering technique is what is added to the penalty force of the soft contact spring.
struct Technique {
  std::string_view name;  // in protocols, stores and reports
  std::string_view summary;
  bool vibration;  // needs a plate's modal model
  bool sinusoid;
};

inline constexpr std::array<Technique, 4> techniques{{
    {"none", "the contact spring alone", false, false},
    {"sinusoid", "a decaying sinusoid at each impact, the same wherever one taps", false, true},
    {"fem", "the plate's own vibration at the contact point", true, false},
    {"fem+sinusoid", "the plate's vibration and the decaying sinusoid", true, true},
}};

// nullptr if there is none of that name.
constexpr const Technique* find_technique(std::string_view name) noexcept {
  for (const Technique& technique : techniques) {
    if (technique.name == name) {
      return &technique;
    }
  }
  return nullptr;
}
}  // namespace tapstudy::core
