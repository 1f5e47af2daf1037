#include "runner/studies/rendered_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>

#include "core/model/plate.hpp"
#include "protocols/protocol.hpp"
#include "protocols/reader/read_rig.hpp"
#include "results/store/sqlite.hpp"
#include "results/store/study_queries.hpp"
#include "runner/session/stimuli/model_library.hpp"
#include "runner/studies/stored_study.hpp"
namespace tapstudy::runner {
// "600 × 600 × 50 mm", or "surface within ..." of any other shape.
std::string describe_size(const core::Shape& shape);
// "2 × vertex on both faces", fixations that are alike taken together; "free" without any.
std::string describe_fixations(const std::vector<core::Fixation>& fixations);
// "; touches table of 2.5e+09 Pa, 610 kg/m³ by 4 springs"; empty if it touches nothing.
std::string describe_joints(const protocols::Protocol& protocol,
                            const protocols::Stimulus& stimulus);

namespace {
std::string millimetres(double length_m) {
  return fmt::format("{:.4g}", 1e3 * length_m);
}

const char* describe_face(core::Face face) {
  switch (face) {
    case core::Face::top:
      return "on the tapped face";
    case core::Face::bottom:
      return "on the face below";
    case core::Face::both:
      return "on both faces";
    case core::Face::through:
      return "through the plate";
  }
  return "";
}

const char* describe_side(core::Side side) {
  switch (side) {
    case core::Side::left:
      return "left side";
    case core::Side::right:
      return "right side";
    case core::Side::front:
      return "front side";
    case core::Side::back:
      return "back side";
    case core::Side::bottom:
      return "underside";
    case core::Side::top:
      return "upper side";
  }
  return "";
}

std::string describe_region(const core::Fixation& fixation) {
  switch (fixation.shape) {
    case core::RegionShape::vertex:
      return fmt::format("vertex {}", describe_face(fixation.face));
    case core::RegionShape::disc:
      return fmt::format("disc of radius {} mm {}", millimetres(fixation.radius_m),
                         describe_face(fixation.face));
    case core::RegionShape::ball:
      return fmt::format("ball of radius {} mm", millimetres(fixation.radius_m));
    case core::RegionShape::box: {
      const core::Vec3 size_m = fixation.high_m - fixation.low_m;
      return fmt::format("box of {} × {} × {} mm", millimetres(size_m.x()), millimetres(size_m.y()),
                         millimetres(size_m.z()));
    }
    case core::RegionShape::side:
      return describe_side(fixation.side);
  }
  return "";
}

// Empty for a fixation along all axes.
std::string describe_axes(const core::Fixation& fixation) {
  if (fixation.springs_n_per_m) {
    const core::Vec3& springs = *fixation.springs_n_per_m;
    return fmt::format(", on springs of {:.3g}, {:.3g}, {:.3g} N/m", springs.x(), springs.y(),
                       springs.z());
  }
  std::string axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    axes += fixation.constrained_axes[axis] ? std::string(1, "xyz"[axis]) : "";
  }
  return axes == "xyz" ? "" : ", held along " + axes;
}
}  // namespace

std::string describe_size(const core::Shape& shape) {
  const core::Vec3 size_m = core::bounds(shape).size_m();
  return fmt::format("{}{} × {} × {} mm",
                     std::holds_alternative<core::Box>(shape) ? "" : "surface within ",
                     millimetres(size_m.x()), millimetres(size_m.y()), millimetres(size_m.z()));
}

std::string describe_fixations(const std::vector<core::Fixation>& fixations) {
  std::vector<std::pair<std::string, int>> alike;
  for (const core::Fixation& fixation : fixations) {
    const std::string words = describe_region(fixation) + describe_axes(fixation);
    const auto found = std::ranges::find(alike, words, &std::pair<std::string, int>::first);
    if (found == alike.end()) {
      alike.emplace_back(words, 1);
    } else {
      ++found->second;
    }
  }
  std::vector<std::string> parts;
  for (const auto& [words, times] : alike) {
    parts.push_back(times == 1 ? words : fmt::format("{} × {}", times, words));
  }
  return parts.empty() ? "free" : fmt::format("{}", fmt::join(parts, "; "));
}

std::string describe_joints(const protocols::Protocol& protocol,
                            const protocols::Stimulus& stimulus) {
  if (!stimulus.contacts) {
    return "";
  }
  std::vector<std::string> bodies;
  for (std::size_t i = 0; i < stimulus.contacts->bodies.size(); ++i) {
    const core::Material& material = stimulus.contacts->bodies[i].material;
    bodies.push_back(fmt::format("{} of {:.3g} Pa, {:.4g} kg/m³",
                                 name_in(protocol.plates, stimulus.contacts->plates.at(i + 1)),
                                 fmt::join(youngs_moduli_pa(material), ", "),
                                 material.density_kg_per_m3));
  }
  const std::size_t springs = stimulus.contacts->springs.size();
  return fmt::format("; touches {} by {} spring{}", fmt::join(bodies, ", "), springs,
                     springs == 1 ? "" : "s");
}

namespace {
using analysis::RenderedModel;
using analysis::RenderedStimulus;
using analysis::RenderedStudy;
using protocols::Protocol;
using protocols::Stimulus;

std::vector<double> listed(const Eigen::ArrayXd& values) {
  return {values.begin(), values.end()};
}

std::optional<double> largest_error(const core::FrequencyErrors& errors) {
  return errors.relative.size() > 0 ? std::optional{errors.largest()} : std::nullopt;
}

std::string relaxed_ratio(const core::ModelReport& report) {
  std::vector<std::string> relaxed;
  for (std::size_t i = 0; i < report.bodies.size(); ++i) {
    const core::RadiusEdgeRatio& ratio = report.bodies[i].radius_edge_ratio;
    if (ratio.is_relaxed()) {
      relaxed.push_back(fmt::format("{} instead of {}{}", ratio.used, ratio.asked,
                                    i == 0 ? "" : fmt::format(" (body {} that it touches)", i)));
    }
  }
  return fmt::format("{}", fmt::join(relaxed, ", "));
}

std::optional<RenderedModel> model_of(const Protocol& protocol, const Stimulus& stimulus,
                                      const core::ModelCache& cache) {
  if (!stimulus.technique->needs_model()) {
    return std::nullopt;
  }
  const std::optional<CachedModel> found = cached_model(protocol, stimulus, cache);
  if (!found) {
    return std::nullopt;
  }
  return RenderedModel{listed(found->modal.frequency_hz),
                       listed(found->modal.damping_ratio),
                       found->report.order(),
                       relaxed_ratio(found->report),
                       found->report.nodes,
                       found->report.tets,
                       found->report.worst_residual,
                       describe(found->dropped),
                       largest_error(found->errors)};
}

RenderedStimulus describe_stimulus(const Protocol& protocol, const Stimulus& stimulus,
                                   const core::ModelCache& cache) {
  return {stimulus.name,
          stimulus.label,
          name_in(protocol.plates, stimulus.plate),
          describe_size(stimulus.plate->shape),
          name_in(protocol.materials, stimulus.material),
          youngs_moduli_pa(*stimulus.material),
          stimulus.material->density_kg_per_m3,
          describe_fixations(stimulus.plate->fixations) + describe_joints(protocol, stimulus),
          std::string{stimulus.technique->name},
          stimulus.technique->needs_model(),
          !stimulus.vary.empty(),
          model_of(protocol, stimulus, cache)};
}

// Puts the taps of a store's traces where they belong.
class TapSorter {
 public:
  TapSorter(const Protocol& protocol, RenderedStudy& study)
      : protocol_{protocol},
        study_{study},
        cutter_{{protocol.rate_hz}, [this](const analysis::TracedTap& tap) { sort(tap); }} {
    for (std::size_t i = 0; i < study.stimuli.size(); ++i) {
      places_[study.stimuli[i].name] = i;
    }
  }

  void read(results::Store& store, results::Mode mode) {
    std::unordered_map<std::int64_t, const results::AnswerRow*> counted;
    const std::vector<results::AnswerRow> answers = counted_answers(store, mode);
    for (const results::AnswerRow& answer : answers) {
      counted[answer.trial_id] = &answer;
      study_.trials += answer.ticks > 0 ? 1 : 0;
    }
    const std::map<std::int64_t, core::Placement> placements = placements_of_trials(store);
    std::set<std::int64_t> traced;
    results::each_trace_chunk(
        store, [&](std::int64_t trial_id, std::span<const core::TraceSample> samples) {
          const auto found = counted.find(trial_id);
          if (found == counted.end()) {
            return;
          }
          if (traced.insert(trial_id).second) {
            cutter_.end_trial();
            trial_ = found->second;
            placement_ = placements.at(trial_id);
          }
          std::ranges::for_each(samples, [&](const auto& sample) { cutter_.add(sample); });
        });
    cutter_.end_trial();
    study_.traced_trials += static_cast<std::int64_t>(traced.size());
  }

 private:
  // A rig may have a placement of its own.
  std::map<std::int64_t, core::Placement> placements_of_trials(results::Store& store) const {
    std::map<std::int64_t, core::Placement> placements;
    std::map<std::string, core::Placement> known;  // by rig
    results::each_rig_of_trial(store, [&](std::int64_t trial_id, const std::string& text) {
      const auto [rig, is_new] = known.try_emplace(text);
      if (is_new) {
        rig->second = protocols::placement_in_stored_rig(rig->first).value_or(protocol_.placement);
      }
      placements.emplace(trial_id, rig->second);
    });
    return placements;
  }

  void sort(const analysis::TracedTap& tap) {
    const auto& alternatives = trial_->alternatives;
    if (alternatives.empty()) {
      return;
    }
    // settings of an adjusted alternative follow the last one
    const std::size_t position = std::min<std::size_t>(tap.alternative, alternatives.size() - 1);
    const auto place = places_.find(alternatives[position].stimulus);
    if (place == places_.end()) {
      return;
    }
    analysis::StimulusTaps& taps = study_.taps[place->second];
    taps.all.add(tap);
    analysis::TapsOfParticipant& own = study_.participants[trial_->participant_id];
    own.speeds_m_s.push_back(tap.speed_m_s);
    own.peaks_n.push_back(taps.all.commanded().peaks_n.back());
    own.contact_s +=
        static_cast<double>(std::ranges::count_if(
            tap.ticks, [](const analysis::TracedTick& tick) { return tick.is_touching; })) /
        protocol_.rate_hz;
    const core::HandState hand{{tap.position_m[0], tap.position_m[1], tap.position_m[2]},
                               core::Vec3::Zero()};
    const Eigen::Vector2d at_m = placement_.to_plate(hand).position_m.head<2>();
    const auto distance_m = [&](const analysis::PointTaps& point) {
      return (protocol_.tapping_points_m.at(point.point) - at_m).norm();
    };
    const auto nearest = std::ranges::min_element(taps.points, {}, distance_m);
    if (nearest != taps.points.end()) {
      nearest->taps.add(tap);
      nearest->distances_m.push_back(distance_m(*nearest));
    }
  }

  const Protocol& protocol_;
  RenderedStudy& study_;
  analysis::TapCutter cutter_;
  std::unordered_map<std::string, std::size_t> places_;  // of stimuli, by name
  const results::AnswerRow* trial_{};
  core::Placement placement_;  // in this trial
};
}  // namespace

analysis::RenderedStudy rendered_study(const Protocol& protocol,
                                       const std::vector<StudyStore>& stores, results::Mode mode,
                                       const DoneBlocks& done) {
  const core::ModelCache cache = user_model_cache();
  const analysis::TapWindow window{protocol.rate_hz};
  RenderedStudy study;
  const std::set<std::string> rendered = rendered_stimuli(protocol, done);
  for (const Stimulus& stimulus : protocol.stimuli) {
    if (!rendered.contains(stimulus.name)) {
      continue;
    }
    study.stimuli.push_back(describe_stimulus(protocol, stimulus, cache));
    analysis::StimulusTaps taps{analysis::TapStatistics{window}, {}};
    for (const auto& [point, at_m] : protocol.tapping_points_m) {
      taps.points.push_back({point, analysis::TapStatistics{window}, {}});
    }
    study.taps.push_back(std::move(taps));
  }
  for (const StudyStore& each : stores) {
    TapSorter{protocol, study}.read(*each.store, mode);
  }
  return study;
}
}  // namespace tapstudy::runner
