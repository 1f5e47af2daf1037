#include "runner/laboratory/identify/responses/response_identification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/modal/modes/mode_kinds.hpp"
#include "analysis/modal/modes/mode_shapes.hpp"
#include "analysis/modal/response/response_files.hpp"
#include "core/error.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "runner/laboratory/identify/fits_over_taps.hpp"
#include "runner/laboratory/identify/measurement_files.hpp"
namespace tapstudy::runner {
namespace {
analysis::RepeatedMode repeated(const analysis::ResponseMode& mode, std::size_t responses,
                                int derivatives) {
  analysis::RepeatedMode one;
  one.frequency_hz = mode.frequency_hz;
  one.damping_ratio = mode.damping_ratio;
  one.degrees_of_freedom = mode.degrees_of_freedom;
  one.standing = mode.standing;
  one.why = mode.why;
  // of what an impulse of force sets ringing, as it was measured
  one.amplitude = mode.residues.norm() *
                  std::pow(2.0 * std::numbers::pi * mode.frequency_hz.value, derivatives);
  one.taps = static_cast<int>(responses);
  one.agreed = one.taps;
  return one;
}

// A place's node, and 1 or -1 for motion along or against z, 0 for another direction. A place
// without a direction is along z.
struct DirectedPlace {
  std::string node;
  double along_z{1.0};
};
DirectedPlace directed(const std::string& place) {
  constexpr std::size_t direction = 2;  // "+Z"
  const std::size_t at = place.size() - std::min(place.size(), direction);
  const std::string end = place.substr(at);
  if (end.size() < direction || (end[0] != '+' && end[0] != '-') || end[1] < 'X' || end[1] > 'Z') {
    return {place};
  }
  return {place.substr(0, at), end[1] != 'Z' ? 0.0 : (end[0] == '+' ? 1.0 : -1.0)};
}

// One of the responses' places that was stated.
struct ComparedPlace {
  std::size_t place{};  // index
  Eigen::Vector2d at_m;
  double along_z{};
};

std::vector<ComparedPlace> compared_places(const ResponseIdentification& found) {
  const std::vector<NamedPlace> stated = read_named_places(found.question.places);
  const std::vector<std::string>& places = found.responses.places;
  std::vector<ComparedPlace> compared;
  for (const NamedPlace& one : stated) {
    bool is_known = false;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const DirectedPlace place = directed(places[i]);
      if (one.name == places[i] || one.name == place.node) {
        is_known = true;
        compared.push_back({i, one.at_m, place.along_z});
      }
    }
    if (!is_known) {
      throw core::InvalidInput{
          fmt::format("{}: no response is of the place '{}'", found.question.places, one.name)};
    }
  }
  std::erase_if(compared, [](const ComparedPlace& one) { return one.along_z == 0.0; });
  return compared;
}

// Unset where there are too few places, which is remarked on.
std::optional<MeasuredShapes> measured_shapes(ResponseIdentification& found) {
  const std::vector<ComparedPlace> compared = compared_places(found);
  if (compared.size() < fewest_places) {
    found.remarks.emplace_back(told_of_few_places);
    return std::nullopt;
  }
  if (compared.size() < found.responses.places.size()) {
    found.remarks.push_back(fmt::format(
        "shapes are compared at {} of {} places: the others were not stated, or are not along z",
        compared.size(), found.responses.places.size()));
  }
  MeasuredShapes measured;
  measured.shapes.resize(std::ssize(compared), std::ssize(found.agreed));
  for (std::size_t i = 0; i < compared.size(); ++i) {
    measured.places_m.push_back(compared[i].at_m);
    for (std::size_t mode = 0; mode < found.agreed.size(); ++mode) {
      const Eigen::VectorXcd& shape = found.responses.modes[found.agreed[mode]].shape;
      measured.shapes(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(mode)) =
          compared[i].along_z * shape[static_cast<Eigen::Index>(compared[i].place)];
    }
  }
  return measured;
}

void compare(const protocols::Protocol& protocol, const core::ProgressHook& hook,
             ResponseIdentification& found) {
  MeasuredModes measured;
  for (const std::size_t i : found.agreed) {
    measured.frequencies_hz.push_back(found.modes[i].frequency_hz);
  }
  if (!found.question.places.empty()) {
    measured.shapes = measured_shapes(found);
    measured.places_m = measured.shapes ? measured.shapes->places_m : measured.places_m;
  }
  const Eigen::ArrayXd& hz = found.responses.measured.frequency_hz;
  measured.from_hz = hz[0];
  found.model = compare_with_model(protocol, found.stimulus, measured, hz[hz.size() - 1], hook);
  for (const std::string& remark : remarks_on_springs(*found.model)) {
    found.remarks.push_back(remark);
  }
  if (found.model->update) {
    for (const std::string& remark : remarks_on_shapes(*found.model->update, found)) {
      found.remarks.push_back(remark);
    }
  }
}

// The modes as those of taps are, and what of them is made by others.
void take_modes(ResponseIdentification& found) {
  std::vector<analysis::ResponseMode>& all = found.responses.modes;
  const int derivatives = static_cast<int>(found.responses.measured.kind);
  for (const analysis::ResponseMode& mode : all) {
    found.modes.push_back(repeated(mode, found.responses.measured.pairs.size(), derivatives));
  }
  analysis::mark_combinations(found.modes, derivatives, [&](std::size_t one, std::size_t other) {
    return analysis::modal_assurance(all[one].residues, all[other].residues);
  });
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].standing = found.modes[i].standing;
    all[i].why = found.modes[i].why;
    if (all[i].standing != analysis::Standing::agreed) {
      found.others.push_back(fmt::format("{:.6g} Hz, damping ratio {:.3g}: {}: {}",
                                         all[i].frequency_hz.value, all[i].damping_ratio.value,
                                         name(all[i].standing), all[i].why));
    }
  }
}
}  // namespace

ResponseIdentification identify_responses(const ResponseQuestion& question, Progress& progress) {
  std::optional<protocols::Protocol> protocol;
  if (!question.protocol.empty()) {
    protocol = protocols::read_protocol(question.protocol);
    protocol->stimulus(question.stimulus);  // refused before the work if there is none
  }
  const core::ProgressHook hook = progress.hook();
  ResponseIdentification found;
  found.question = question;
  found.stimulus = question.stimulus;
  hook("modes");
  found.responses = analysis::find_response_modes(
      analysis::read_responses(question.files, question.kind), question.band);
  found.remarks = found.responses.remarks;
  const analysis::FrequencyResponses& measured = found.responses.measured;
  const Eigen::ArrayXd& hz = measured.frequency_hz;
  found.source = fmt::format("{} frequency responses, {}, {:g} to {:g} Hz", measured.pairs.size(),
                             name(measured.kind), hz[0], hz[hz.size() - 1]);
  take_modes(found);
  sum_up_modes(found);
  if (protocol) {
    found.loop_rate_hz = protocol->rate_hz;
    compare(*protocol, hook, found);
  }
  return found;
}
}  // namespace tapstudy::runner
