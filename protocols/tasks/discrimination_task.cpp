#include "protocols/tasks/discrimination_task.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "protocols/axes/presented_stimulus.hpp"
#include "protocols/reader/read_sections.hpp"
#include "protocols/tasks/shared_keys.hpp"
namespace tapstudy::protocols {
namespace {
constexpr double any = 1e15;

const Stimulus* family_of(const Protocol& protocol, const Block& block) {
  const auto found =
      block.stimuli.size() == 1
          ? std::ranges::find(protocol.stimuli, block.stimuli.front(), &Stimulus::name)
          : protocol.stimuli.end();
  return found == protocol.stimuli.end() || found->vary.empty() ? nullptr : &*found;
}

// Whether it can be presented.
bool check_value(MapReader& reader, const std::string& key, const Protocol& protocol,
                 const Stimulus& family, const std::string& axis, double value) {
  try {
    presented_values(protocol, family, {{axis, value}});
    return true;
  } catch (const core::InvalidInput& error) {
    reader.reject(key, error.what());
    return false;
  }
}

// Whether the standard is presented as it is given. A table's nearest value in its place would be
// another standard: levels, what is right, and thresholds would be those of a plate that nobody
// felt.
bool check_standard(MapReader& reader, const Protocol& protocol, const Stimulus& family,
                    const Comparison& comparison) {
  const double standard = comparison.standard;
  if (!check_value(reader, "standard", protocol, family, comparison.axis, standard)) {
    return false;
  }
  const double presented =
      presented_values(protocol, family, {{comparison.axis, standard}}).at(comparison.axis);
  const bool is_built = std::abs(presented - standard) <= 1e-9 * std::abs(standard);
  if (!is_built) {
    reader.reject("standard", fmt::format("{:.6g} is not among the values of {} that are built "
                                          "(the nearest is {:.6g})",
                                          standard, comparison.axis, presented));
  }
  return is_built;
}

void check_further_axes(MapReader& reader, const Protocol& protocol, const Stimulus& family,
                        const Comparison& comparison, const TrackSettings& track) {
  const auto ranges = track.ranges();
  for (std::size_t i = 0; i < comparison.further_axes.size(); ++i) {
    const auto [low, high] = ranges[i + 1];
    for (const double value : {low, high}) {
      check_value(reader, fmt::format("further_axes[{}]", i), protocol, family,
                  comparison.further_axes[i], value);
    }
  }
}

void check_track(MapReader& reader, const Protocol& protocol, const Stimulus& family,
                 const Comparison& comparison, const TrackSettings& track) {
  const std::size_t axes = 1 + comparison.further_axes.size();
  if (track.axes() != axes || track.outcomes() != 2) {
    reader.reject(
        fmt::format("varies {} axes and has {} outcomes; the block has {} (`axis` and "
                    "`further_axes`) and 2, right and wrong",
                    track.axes(), track.outcomes(), axes));
    return;
  }
  check_further_axes(reader, protocol, family, comparison, track);
  const auto [low, high] = track.ranges().front();
  if (low < 0.0 && comparison.side != Side::either) {
    reader.reject(fmt::format(
        "may ask for the level {}: levels are at least 0 (or comparison: either)", low));
    return;
  }
  if (comparison.side != Side::either && !track.is_harder_below()) {
    reader.reject("after_correct", "must be decrease: greater levels are easier");
    return;
  }
  for (const double level : {low, high}) {
    const double value = comparison.value_at(level);
    try {
      const double presented =
          presented_values(protocol, family, {{comparison.axis, value}}).at(comparison.axis);
      if (level != 0.0 && presented == comparison.standard) {
        reader.reject(fmt::format(
            "may ask for the level {}, which is {} = {:.6g}: of the values that are built the "
            "standard itself is nearest",
            level, comparison.axis, value));
        return;
      }
    } catch (const core::InvalidInput& error) {
      reader.reject(fmt::format("may ask for the level {}, which is {} = {:.6g}: {}", level,
                                comparison.axis, value, error.what()));
      return;
    }
  }
}

std::vector<std::string> read_further_axes(MapReader& reader, const std::vector<std::string>& axes,
                                           const std::string& axis) {
  if (!reader.has("further_axes")) {
    return {};
  }
  std::vector<std::string> others = axes;
  std::erase(others, axis);
  return reader.words({"further_axes",
                       "with procedures of several axes only: the further ones, in their order; "
                       "all alternatives of a trial have the same values on them; unset: none"},
                      "further axis", others);
}

// Where the standard cannot be presented, which is said already, procedures are only read.
void read_tracks(MapReader& reader, const Protocol& protocol, const Stimulus* usable_family,
                 Comparison& comparison) {
  reader.list({"procedures",
               "what chooses the comparison's level from trial to trial; several are interleaved; "
               "unset: fixed stimuli"},
              MapReader::Presence::at_least_one, [&](MapReader& inner) {
                const auto track = read_procedure(inner);
                if (track == nullptr) {
                  return;
                }
                if (usable_family != nullptr) {
                  check_track(inner, protocol, *usable_family, comparison, *track);
                }
                comparison.tracks.push_back(track);
              });
}
// Unset: what the procedures assume, where it fits the side.
void read_function(MapReader& reader, Comparison& comparison) {
  const bool is_on_either_side = comparison.side == Side::either;
  // A point of equality is where F is 0.5.
  const auto fits = [&](core::PsychometricShape shape) {
    return !is_on_either_side ||
           (!core::row_of(shape).is_logarithmic && core::shape_value(shape, 0.0, 0.0, 1.0) == 0.5);
  };
  core::PsychometricShape assumed = is_on_either_side ? core::PsychometricShape::cumulative_gaussian
                                                      : core::PsychometricShape::weibull;
  for (const auto& track : comparison.tracks) {
    if (const auto shape = track->shape(); shape && fits(*shape)) {
      assumed = *shape;
      break;
    }
  }
  const auto* const row = core::find_psychometric_shape(
      reader.word({"function",
                   "with procedures only: the psychometric function that the report fits; on "
                   "either side of the standard logistic or cumulative_gaussian; unset: what the "
                   "first procedure assumes, else weibull, on either side cumulative_gaussian"},
                  "psychometric function", core::psychometric_shape_names(),
                  std::string{core::row_of(assumed).name}));
  if (row == nullptr) {
    return;  // noted
  }
  if (!fits(row->shape)) {
    reader.reject("function",
                  fmt::format("'{}' has no point of equality: with levels on either side "
                              "it is logistic or cumulative_gaussian",
                              row->name));
  }
  comparison.shape = row->shape;
}
}  // namespace

std::optional<Comparison> read_comparison(MapReader& reader, const Protocol& protocol,
                                          const Block& block, Sides sides) {
  Comparison comparison;
  const Stimulus* const family = family_of(protocol, block);
  const std::vector<std::string> axes =
      family == nullptr ? std::vector<std::string>{} : axes_of(protocol, family->name);
  if (reader.depends_on_others(family != nullptr)) {
    comparison.axis = read_axis(reader, protocol, block, axes);
    comparison.further_axes = read_further_axes(reader, axes, comparison.axis);
  }
  const bool is_known =
      std::ranges::find(axes, comparison.axis) != axes.end() && family->is_complete();
  const double own = is_known ? presented_values(protocol, *family, {}).at(comparison.axis) : 0.0;
  comparison.standard = read_standard_value(reader, {-any, any}, own);
  comparison.is_fraction =
      reader.one_of<bool>({"level",
                           "with procedures only: what they choose: a fraction of the standard, or "
                           "a difference in the axis's unit"},
                          {{"fraction", true}, {"difference", false}}, "fraction");
  comparison.side = reader.one_of<Side>(
      {"comparison",
       "with procedures only: where comparisons lie; levels are positive above and below. either "
       "(task comparison, two alternatives): levels have a sign, procedures follow how often the "
       "comparison is judged greater, and the report has points of subjective equality"},
      {{"above", Side::above}, {"below", Side::below}, {"either", Side::either}}, "above");
  if (comparison.side == Side::either && sides == Sides::one) {
    reader.reject("comparison", "lies on one side of the standard: above or below");
  }
  bool is_usable = is_known && check_standard(reader, protocol, *family, comparison);
  if (is_usable && comparison.is_fraction && comparison.standard <= 0.0) {
    reader.reject("level", "fractions are of a standard above 0");
    is_usable = false;
  }
  read_tracks(reader, protocol, is_usable ? family : nullptr, comparison);
  read_function(reader, comparison);
  const char* const one_that_varies = "procedures vary one stimulus, which must have `vary`";
  reader.check_count("stimuli", block.stimuli, 0, 1, one_that_varies);
  if (family == nullptr && !is_vary_refused(protocol, block)) {
    reader.reject("stimuli", one_that_varies);
  }
  return comparison.tracks.empty() ? std::nullopt : std::optional{comparison};
}

namespace {
// Of each way to present a trial, in a run of trials that is shuffled as a whole.
constexpr std::size_t times_in_run = 4;

std::size_t observations(const Comparison& comparison) {
  std::size_t count = 0;
  for (const auto& track : comparison.tracks) {
    count += track->max_trials();
  }
  return count;
}
}  // namespace

void DiscriminationTask::read(MapReader& reader, const Protocol& protocol, Block& block) const {
  if (reader.has("procedures")) {
    block.comparison = read_comparison(reader, protocol, block, sides());
    reader.refuse("repetitions", "is what the procedures make it");
  } else {
    reader.check_count("stimuli", block.stimuli, 2, max_stimuli,
                       "one stimulus is compared with itself only along an axis: give procedures, "
                       "or at least two stimuli");
  }
}

std::size_t DiscriminationTask::trials_per_repetition(const Block& block) const {
  if (block.comparison) {
    const auto trials = observations(*block.comparison) *
                        static_cast<std::size_t>(1 + empty_trials_per_observation());
    if (empty_trials_per_observation() == 0) {
      return trials;
    }
    // only whole runs hold as many observations as they should
    const std::size_t run = times_in_run * layouts(block).size();
    return (trials + run - 1) / run * run;
  }
  return pairs_of(block.stimuli.size()).size() * layouts(block).size();
}

int DiscriminationTask::visits(const Block& block, const SimulatedTapSettings& taps) const {
  return taps.visits * static_cast<int>(layouts(block).front().size());
}

// The comparison's value is chosen when its trial comes. Shuffled within runs, because procedures
// may end at any trial; runs are long enough that nobody foresees how one ends.
std::vector<PlannedTrial> DiscriminationTask::of_family(const Block& block, core::Rng& rng) const {
  const Comparison& comparison = *block.comparison;
  const Alternative standard{block.stimuli.front(), {{comparison.axis, comparison.standard}}};
  const Alternative varied{block.stimuli.front(), {}, true};
  std::vector<Layout> run;
  for (const Layout& way : layouts(block)) {
    run.insert(run.end(), times_in_run, way);
  }
  std::vector<PlannedTrial> all;
  for (std::size_t i = 0; i < trials_per_repetition(block); ++i) {
    if (i % run.size() == 0) {
      rng.shuffle(run);
    }
    PlannedTrial trial{0, block.name, this, block.is_practice, 1, {}};
    for (const bool is_comparison : run[i % run.size()]) {
      trial.alternatives.push_back(is_comparison ? varied : standard);
    }
    all.push_back(std::move(trial));
  }
  return all;
}

// Every pair in every way once in each repetition, in random order.
std::vector<PlannedTrial> DiscriminationTask::of_pairs(const Block& block, core::Rng& rng) const {
  return shuffled_repetitions(block, rng, [&](int repetition) {
    std::vector<PlannedTrial> part;
    for (const auto& [standard, comparison] : pairs_of(block.stimuli.size())) {
      for (const Layout& way : layouts(block)) {
        PlannedTrial trial{0, block.name, this, block.is_practice, repetition, {}};
        for (const bool is_comparison : way) {
          trial.alternatives.push_back(
              {block.stimuli[is_comparison ? comparison : standard], {}, is_comparison});
        }
        part.push_back(std::move(trial));
      }
    }
    return part;
  });
}

std::vector<PlannedTrial> DiscriminationTask::trials(const Block& block, const Draw& draw) const {
  core::Rng rng{core::derived_seed(draw.participant_seed, core::Purpose::labels, draw.block_index)};
  return block.comparison ? of_family(block, rng) : of_pairs(block, rng);
}
}  // namespace tapstudy::protocols
