#include "runner/session/stimuli/mesh_accuracy.hpp"

#include <algorithm>
#include <vector>

#include "core/model/plate_model.hpp"
#include "core/techniques/technique.hpp"
namespace tapstudy::runner {
namespace {
struct SolvedStimulus {
  std::string name;
  std::string body;  // equal text: on one mesh
  Eigen::ArrayXd frequencies_hz;
};

std::optional<double> difference(const SolvedStimulus& a, const SolvedStimulus& b) {
  const Eigen::Index both = std::min(a.frequencies_hz.size(), b.frequencies_hz.size());
  if (both == 0 || a.body == b.body) {
    return std::nullopt;
  }
  const double most =
      (a.frequencies_hz.head(both) / b.frequencies_hz.head(both) - 1.0).abs().maxCoeff();
  return most > 0.0 ? std::optional{most} : std::nullopt;
}

std::optional<SmallestDifference> smallest_of(const std::vector<SolvedStimulus>& all) {
  std::optional<SmallestDifference> smallest;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto found = difference(all[j], all[i]);
      if (found && (!smallest || *found < smallest->relative)) {
        smallest = SmallestDifference{all[j].name, all[i].name, *found};
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
  std::vector<SolvedStimulus> all;
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (!stimulus.technique->needs_model() || stimulus.technique->needs_beam()) {
      continue;
    }
    const protocols::PresentedStimulus own = stimulus_with(protocol, stimulus);
    const auto body = find(own, core::usual_accuracy);
    if (!body) {
      return std::nullopt;
    }
    const double unit = core::kappa_rad_per_m(1.0, *own.material);
    const Eigen::ArrayXd hz = body->kappa_rad_per_m / unit;
    const std::string joints = own.contacts ? core::content_key(*own.contacts) : std::string{};
    all.push_back({stimulus.name, core::content_key(*own.plate) + joints,
                   hz.head((hz < protocol.band_limit_hz).count())});
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
