#include "runner/session/stimuli/mesh_accuracy.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/model/plate_model.hpp"
#include "core/techniques/technique.hpp"
namespace tapstudy::runner {
namespace {
struct StimulusOnMesh {
  protocols::PresentedStimulus stimulus;
  std::string body;  // equal text: on one mesh
  Eigen::ArrayXd frequencies_hz{};
};

StimulusOnMesh on_mesh(protocols::PresentedStimulus stimulus) {
  const std::string joints =
      stimulus.contacts ? core::content_key(*stimulus.contacts) : std::string{};
  std::string body = core::content_key(*stimulus.plate) + joints;
  return {std::move(stimulus), std::move(body)};
}

std::optional<double> difference(const StimulusOnMesh& a, const StimulusOnMesh& b) {
  const Eigen::Index both = std::min(a.frequencies_hz.size(), b.frequencies_hz.size());
  if (both == 0 || a.body == b.body) {
    return std::nullopt;
  }
  const double most =
      (a.frequencies_hz.head(both) / b.frequencies_hz.head(both) - 1.0).abs().maxCoeff();
  return most > 0.0 ? std::optional{most} : std::nullopt;
}

std::optional<SmallestDifference> smallest_of(const std::vector<StimulusOnMesh>& all) {
  std::optional<SmallestDifference> smallest;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto found = difference(all[j], all[i]);
      if (found && (!smallest || *found < smallest->relative)) {
        smallest = SmallestDifference{all[j].stimulus.name, all[i].stimulus.name, *found};
      }
    }
  }
  return smallest;
}
}  // namespace

bool has_automatic_mesh(const protocols::Protocol& protocol) {
  return std::ranges::any_of(protocol.stimuli, [](const protocols::Stimulus& stimulus) {
    return stimulus.technique->needs_model() && stimulus.plate->mesh.is_automatic;
  });
}

std::optional<AutomaticMesh> automatic_mesh(const protocols::Protocol& protocol,
                                            const FindBody& find) {
  std::vector<StimulusOnMesh> all;
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (stimulus.technique->needs_model() && !stimulus.technique->needs_beam()) {
      all.push_back(on_mesh(stimulus_with(protocol, stimulus)));
    }
  }
  const auto differs = [&](const StimulusOnMesh& one) { return one.body != all.front().body; };
  if (std::ranges::none_of(all, differs)) {
    return AutomaticMesh{};
  }
  for (StimulusOnMesh& one : all) {
    const auto body = find(one.stimulus, core::usual_accuracy);
    if (!body) {
      return std::nullopt;
    }
    const double unit = core::kappa_rad_per_m(1.0, *one.stimulus.material);
    const Eigen::ArrayXd hz = body->kappa_rad_per_m / unit;
    one.frequencies_hz = hz.head((hz < protocol.band_limit_hz).count());
  }
  AutomaticMesh mesh;
  mesh.difference = smallest_of(all);
  if (mesh.difference) {
    constexpr double share = 0.1;
    mesh.accuracy =
        std::clamp(share * mesh.difference->relative, least_accuracy, core::usual_accuracy);
  }
  return mesh;
}
}  // namespace tapstudy::runner
