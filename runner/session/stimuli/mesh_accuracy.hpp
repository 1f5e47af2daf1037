#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/model/body_modes.hpp"
#include "core/model/refinement/refinement.hpp"
#include "protocols/axes/presented_stimulus.hpp"
namespace tapstudy::runner {
// The solution of a stimulus's body, of the accuracy that is asked of its automatic mesh;
// nullptr: there is none.
using FindBody = std::function<std::shared_ptr<const core::BodyModes>(
    const protocols::PresentedStimulus& stimulus, double accuracy)>;

// Two stimuli of which the mesh could spoil the difference: their bodies differ in shape, fixations
// or mesh. Of two materials on one mesh the error is the same, or nearly: their ratio keeps.
struct SmallestDifference {
  std::string first;
  std::string second;
  double relative{};  // of the frequency that differs most, among those that both have in the band
};

struct AutomaticMesh {
  double accuracy{core::usual_accuracy};  // a tenth of the difference, between the bounds below
  std::optional<SmallestDifference> difference{};  // unset: no two such stimuli
};
inline constexpr double least_accuracy = 0.002;

// What `mesh: auto` asks for in this study, by its stimuli at their own values; where there are
// different bodies, these are solved to the usual accuracy first. nullopt: one is missing.
std::optional<AutomaticMesh> automatic_mesh(const protocols::Protocol& protocol,
                                            const FindBody& find);
bool has_automatic_mesh(const protocols::Protocol& protocol);
}  // namespace tapstudy::runner
