#include "runner/studies/study_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/report/comparison.hpp"
#include "analysis/report/study/confidence.hpp"
#include "analysis/report/study/course.hpp"
#include "analysis/report/study/groups.hpp"
#include "analysis/report/study/rendered.hpp"
#include "analysis/report/study/retest.hpp"
#include "core/error.hpp"
#include "core/model/fixation.hpp"
#include "core/model/shells/shell_elements.hpp"
#include "core/random/rng.hpp"
#include "core/techniques/technique.hpp"
#include "core/text/plain_text.hpp"
#include "protocols/axes/axis.hpp"
#include "protocols/schedule/catch_trials.hpp"
#include "protocols/schedule/groups.hpp"
#include "protocols/schedule/ordering.hpp"
#include "protocols/schedule/schedule.hpp"
#include "results/store/study_queries.hpp"
#include "runner/session/engine/open_study.hpp"
#include "runner/session/engine/practice.hpp"
#include "runner/session/engine/stored_names.hpp"
#include "runner/studies/methods_section.hpp"
#include "runner/studies/mixed_models/data.hpp"
#include "runner/studies/rendered_study.hpp"
#include "runner/studies/stored_results.hpp"
#include "runner/studies/stored_study.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
namespace {
// Participants may read one label for several stimuli; a reader of the report must not.
std::vector<analysis::Item> with_distinct_labels(std::vector<analysis::Item> items) {
  std::map<std::string, int> times;
  for (const analysis::Item& item : items) {
    ++times[item.label];
  }
  for (analysis::Item& item : items) {
    if (times[item.label] > 1) {
      item.label += " (" + item.name + ")";
    }
  }
  return items;
}

std::vector<analysis::Item> presented_items(const protocols::Protocol& protocol,
                                            const protocols::Block& block) {
  std::vector<analysis::Item> items;
  for (const std::string& name : block.stimuli) {
    const protocols::Stimulus& stimulus = protocol.stimulus(name);
    const auto right = block.right_response.find(name);
    items.push_back({stimulus.name, stimulus.label, stimulus.factors,
                     right == block.right_response.end() ? std::string{} : right->second,
                     block.presented == protocols::Presented::real_plates
                         ? std::string{}
                         : std::string{stimulus.technique->name}});
  }
  return with_distinct_labels(std::move(items));
}

// An answer that names a level says nothing about other factors.
std::vector<analysis::Item> answered_items(const protocols::Protocol& protocol,
                                           const protocols::Block& block) {
  std::vector<analysis::Item> items;
  for (const std::string& name : block.responses) {
    if (block.response_factor.empty()) {
      const protocols::Stimulus& stimulus = protocol.stimulus(name);
      items.push_back({stimulus.name, stimulus.label, stimulus.factors});
    } else {
      items.push_back({name, name, {{block.response_factor, name}}});
    }
  }
  return with_distinct_labels(std::move(items));
}

constexpr int not_counted = -1;

// All participants of one draw share its counterbalancing. Catch trials stay in their places.
analysis::BlockDesign::Redraw redraw_of(const protocols::Protocol& protocol,
                                        std::size_t block_index) {
  std::vector<protocols::Block> of_groups;
  for (const protocols::Group* const group : protocols::groups_of(protocol)) {
    of_groups.push_back(protocols::block_of(group, protocol.blocks[block_index]));
  }
  const std::vector<std::string>& all = protocol.blocks[block_index].stimuli;
  const std::uint64_t study_seed = protocol.counterbalancing_seed;
  const std::size_t groups = protocol.groups.size();
  return [of_groups, all, block_index, study_seed, groups](const analysis::Place& place,
                                                           std::uint64_t draw) {
    const std::uint64_t seed = core::derived_seed(
        draw, core::Purpose::participant, static_cast<std::uint64_t>(place.participant_index));
    protocols::Draw redrawn = protocols::draw_of(
        study_seed, block_index, seed, protocols::index_in_group(groups, place.order_index));
    redrawn.counterbalancing_seed = draw;
    const protocols::Block& block =
        groups == 0 ? of_groups.front()
                    : of_groups[protocols::place_of_group(study_seed, groups, place.order_index)];
    std::vector<int> stimuli;
    for (const auto& next : protocols::ordered_conditions(block, redrawn)) {
      const std::string& name = block.stimuli[protocols::stimulus_of(block, next.condition)];
      stimuli.push_back(static_cast<int>(std::ranges::find(all, name) - all.begin()));
    }
    for (const std::size_t at : protocols::catch_places(block, redrawn, stimuli.size())) {
      stimuli.insert(stimuli.begin() + static_cast<std::ptrdiff_t>(at), not_counted);
    }
    return stimuli;
  };
}

// Only a random order can be drawn again.
void add_redraw(const protocols::Protocol& protocol, std::size_t block_index,
                analysis::BlockDesign& design) {
  constexpr std::size_t constrained_cost = 20;
  const protocols::Block& block = protocol.blocks[block_index];
  if (block.task->uses_order() && block.order != protocols::Order::listed) {
    design.redraw = redraw_of(protocol, block_index);
    design.redraw_cost = block.constraints.are_any() ? constrained_cost : 1;
  }
}

// The axis has passed the protocol's reader.
analysis::AxisName name_of(const std::string& axis) {
  const protocols::Axis& row = *protocols::find_axis(axis);
  return {axis, std::string{row.quantity}, std::string{row.unit}};
}

void add_task_settings(const protocols::Block& block, const protocols::Protocol& protocol,
                       analysis::BlockDesign& part) {
  part.decision_model = block.task->decision_model(block);
  part.guess_rate = block.task->guess_rate(block, protocol);
  part.has_own_guess_rate = block.task->has_own_guess_rate();
  part.alternatives = block.alternatives > 0 ? block.alternatives : 2;
  part.steps =
      block.rating && block.rating->kind == protocols::ScaleKind::likert ? block.rating->steps : 0;
  part.has_ties = !block.tie.empty();
  if (block.adjustment) {
    const protocols::Adjustment& of = *block.adjustment;
    part.adjusted = analysis::AdjustedAxis{name_of(of.axis), of.spacing == protocols::Spacing::log,
                                           of.middle(), of.standard};
  }
  if (block.on_axis) {
    part.axis = analysis::VariedAxis{name_of(block.on_axis->axis), 0.0, false, false};
  }
  if (block.comparison) {
    const protocols::Comparison& comparison = *block.comparison;
    part.axis = analysis::VariedAxis{
        name_of(comparison.axis), comparison.standard, comparison.is_fraction,
        comparison.side == protocols::Side::below, comparison.is_standard_right};
    std::ranges::transform(comparison.further_axes, std::back_inserter(part.further_axes), name_of);
    part.shape = comparison.shape;
  }
}

std::string question_of(const protocols::Block& block) {
  return block.presented == protocols::Presented::real_plates ? block.question + " (real plates)"
                                                              : block.question;
}

analysis::Vote vote_of(const protocols::Block& block) {
  return block.vote == protocols::Vote::first ? analysis::Vote::first : analysis::Vote::majority;
}

std::vector<std::string> labels_of(const std::vector<std::string>& groups,
                                   const protocols::Protocol& protocol) {
  std::vector<std::string> labels;
  std::ranges::transform(groups, std::back_inserter(labels), [&](const std::string& name) {
    return std::ranges::find(protocol.groups, name, &protocols::Group::name)->label;
  });
  return labels;
}

void add_hypothesis(const protocols::Hypothesis& hypothesis, const protocols::Protocol& protocol,
                    analysis::BlockDesign& part) {
  const analysis::PlannedHypothesis planned{hypothesis.name, hypothesis.statement,
                                            hypothesis.stimulus};
  using enum protocols::Claim;
  if (hypothesis.claim == interaction || hypothesis.claim == equivalent ||
      hypothesis.claim == threshold_ratio || hypothesis.claim == threshold_below ||
      hypothesis.claim == groups_differ) {
    part.comparisons.push_back(
        {planned, hypothesis.factors, hypothesis.other_stimulus, hypothesis.other_block,
         hypothesis.within,
         hypothesis.claim == threshold_below ? std::optional{hypothesis.below} : std::nullopt,
         labels_of(hypothesis.groups, protocol)});
  } else {
    part.hypotheses.push_back(planned);
  }
}

std::string chance_assumption(const protocols::Protocol& protocol) {
  const protocols::SimulatedObserverSettings& observer = protocol.simulation.observer;
  return fmt::format(
      "simulated participants take the body of '{}', vibrating as by technique '{}', for the real "
      "one; what they choose follows from that",
      observer.reference, observer.reality->name);
}
}  // namespace

analysis::StudyDesign design_of(const protocols::Protocol& protocol, results::Mode mode) {
  analysis::StudyDesign design{protocol.title, protocol.notes, {}};
  for (std::size_t i = 0; i < protocol.blocks.size(); ++i) {
    const protocols::Block& block = protocol.blocks[i];
    if (block.is_practice) {
      continue;
    }
    analysis::BlockDesign part{block.name,
                               std::string{block.task->name()},
                               question_of(block),
                               std::string{block.task->statistic(block)},
                               presented_items(protocol, block),
                               answered_items(protocol, block),
                               {},
                               {},
                               {},
                               vote_of(block)};
    add_task_settings(block, protocol, part);
    add_redraw(protocol, i, part);
    if (mode == results::Mode::simulated && block.task->needs_reference()) {
      part.premise = chance_assumption(protocol);
    }
    for (const protocols::Hypothesis& hypothesis : protocol.hypotheses) {
      if (hypothesis.block == block.name) {
        add_hypothesis(hypothesis, protocol, part);
      }
    }
    design.blocks.push_back(part);
  }
  return design;
}

namespace {
using results::ParticipantCourseRow;

using Answers = std::vector<results::JournalledAnswer>;

// The share of right answers in the practice of one block; no trials if it was not practised, or
// has no right answers.
analysis::Proportion practice_accuracy(const protocols::Block& block, const Answers& answers) {
  analysis::Proportion right;
  for (const results::JournalledAnswer& answer : answers) {
    const auto& is_correct = answer.response.is_correct;
    if (answer.trial.is_practice && answer.trial.block == block.name && is_correct) {
      right.add(*is_correct);
    }
  }
  return right;
}

bool is_practised(const protocols::Block& block, const Answers& answers) {
  return std::ranges::any_of(answers, [&](const results::JournalledAnswer& answer) {
    return answer.trial.is_practice && answer.trial.block == block.name;
  });
}

void add_practice(const protocols::Protocol& protocol, const std::string& participant,
                  results::Store& store, std::vector<analysis::PracticeResult>& practice) {
  const Answers answers = store.answers_as_given(participant);
  const PracticeRecord record{answers};
  for (const protocols::Block& block : protocol.blocks) {
    if (is_practised(block, answers)) {
      analysis::PracticeResult result{participant, block.name, practice_accuracy(block, answers)};
      if (block.criterion) {
        result.is_criterion_met = record.is_met(block);
      }
      practice.push_back(result);
    }
  }
}

analysis::ReportSection course(const protocols::Protocol& protocol,
                               const std::vector<StudyStore>& stores, results::Mode mode) {
  std::vector<ParticipantCourseRow> participants;
  std::vector<analysis::PracticeResult> practice;
  for (const StudyStore& each : stores) {
    for (const ParticipantCourseRow& row : results::participant_courses(*each.store)) {
      if (row.mode == mode) {
        participants.push_back(row);
        add_practice(protocol, row.participant_id, *each.store, practice);
      }
    }
  }
  return analysis::course_section(participants, practice, protocol.masking.has_value());
}

std::vector<analysis::ConfidenceScale> confidence_scales(const protocols::Protocol& protocol) {
  std::vector<analysis::ConfidenceScale> scales;
  for (const protocols::Block& block : protocol.blocks) {
    if (block.confidence) {
      const protocols::Confidence& asked = *block.confidence;
      scales.push_back({block.name, asked.steps, asked.low, asked.high});
    }
  }
  return scales;
}

// Answers are read only where confidence was asked.
analysis::ReportSection confidence(const protocols::Protocol& protocol,
                                   const std::vector<StudyStore>& stores, results::Mode mode) {
  const std::vector<analysis::ConfidenceScale> scales = confidence_scales(protocol);
  std::vector<results::AnswerRow> answers;
  for (std::size_t i = 0; i < stores.size() && !scales.empty(); ++i) {
    std::ranges::move(counted_answers(*stores[i].store, mode), std::back_inserter(answers));
  }
  return analysis::confidence_section(scales, answers);
}

// Blocks of the file that participants did in several sessions.
std::vector<analysis::RepeatedBlock> repeated_blocks(const protocols::Protocol& protocol) {
  std::vector<analysis::RepeatedBlock> repeated;
  for (const protocols::Block& block : protocol.blocks) {
    if (block.session.empty() || block.is_practice) {
      continue;
    }
    const auto known = std::ranges::find(repeated, block.measure, &analysis::RepeatedBlock::name);
    if (known == repeated.end()) {
      repeated.push_back({block.measure, {block.name}});
    } else {
      known->blocks.push_back(block.name);
    }
  }
  std::erase_if(repeated, [](const auto& block) { return block.blocks.size() < 2; });
  return repeated;
}

bool has_parts(const protocols::Block& block) {
  return block.comparison && !block.comparison->further_axes.empty();
}

// What a report of the study can have. Which parts a block has at further values of its stimuli is
// known only once its answers are read.
std::vector<std::string> names_of_parts(const protocols::Protocol& protocol) {
  namespace names = analysis::study_sections;
  std::vector<std::string> parts;
  for (const protocols::Block& block : protocol.blocks) {
    if (!block.is_practice) {
      parts.push_back(block.name);
    }
  }
  const bool asks_confidence = std::ranges::any_of(
      protocol.blocks, [](const auto& block) { return block.confidence.has_value(); });
  const std::array<std::pair<std::string_view, bool>, 4> absent{
      {{names::contrasts, parts.size() < 2 && std::ranges::none_of(protocol.blocks, has_parts)},
       {names::groups, protocol.groups.empty()},
       {names::retest, repeated_blocks(protocol).empty()},
       {names::confidence, !asks_confidence}}};
  for (const std::string_view name : names::all) {
    if (std::ranges::find(absent, std::pair{name, true}) == absent.end()) {
      parts.emplace_back(name);
    }
  }
  return parts;
}

bool is_part_of_block(const std::string& name, const protocols::Protocol& protocol) {
  return std::ranges::any_of(protocol.blocks, [&](const protocols::Block& block) {
    return has_parts(block) && name.starts_with(block.name + "_at_");
  });
}

// Which parts of a report are asked for. Throws InvalidInput for a name that is none.
class Wanted {
 public:
  Wanted(const std::vector<std::string>& only, const protocols::Protocol& protocol)
      : only_{only},
        is_all_{only.empty() || std::ranges::any_of(only, [&](const std::string& name) {
                  return is_part_of_block(name, protocol);
                })} {
    std::vector<std::string> parts = names_of_parts(protocol);
    std::ranges::copy_if(only, std::back_inserter(parts),
                         [&](const std::string& name) { return is_part_of_block(name, protocol); });
    analysis::check_are_parts(only, parts);
  }
  bool has(std::string_view name) const {
    return is_all_ || std::ranges::find(only_, name) != only_.end();
  }

 private:
  const std::vector<std::string>& only_;
  bool is_all_{};
};

// Whether a block is shown whose levels procedures chose.
bool wants_tracks(const protocols::Protocol& protocol, const Wanted& wanted) {
  return std::ranges::any_of(protocol.blocks, [&](const protocols::Block& block) {
    return block.comparison && wanted.has(block.name);
  });
}

std::vector<analysis::TrackResult> track_results(const std::vector<StudyStore>& stores,
                                                 results::Mode mode,
                                                 std::vector<ReplayedTracks>& tracks) {
  std::vector<analysis::TrackResult> results;
  for (std::size_t i = 0; i < stores.size(); ++i) {
    std::ranges::move(tracks[i].results_of(participants_of(*stores[i].store, mode)),
                      std::back_inserter(results));
  }
  return results;
}

// The sections of a report besides the results of its blocks.
std::vector<analysis::ReportSection> sections_of(const protocols::Protocol& protocol,
                                                 const std::vector<StudyStore>& stores,
                                                 results::Mode mode, const DoneBlocks& done,
                                                 const Wanted& wanted,
                                                 std::vector<ReplayedTracks>& tracks) {
  namespace names = analysis::study_sections;
  std::vector<analysis::ReportSection> sections;
  const auto add = [&](std::string_view name, const auto& compute) {
    if (wanted.has(name)) {
      sections.push_back(compute());
    }
  };
  add(names::sessions, [&] { return course(protocol, stores, mode); });
  add(names::confidence, [&] { return confidence(protocol, stores, mode); });
  add(names::procedures,
      [&] { return analysis::procedures_section(track_results(stores, mode, tracks)); });
  add(names::questionnaires, [&] {
    return analysis::questionnaires_section(questionnaires_of(protocol),
                                            given_answers(stores, mode));
  });
  add(names::rendered,
      [&] { return analysis::rendered_section(rendered_study(protocol, stores, mode, done)); });
  return sections;
}
}  // namespace

namespace {
using analysis::Summary;
using results::Mode;

std::vector<std::pair<std::string, std::string>> provenance(
    const results::StudyRow& study, const protocols::Protocol& protocol,
    const std::vector<results::SessionRow>& sessions) {
  std::set<std::string> programs;
  std::set<std::string> devices;
  std::vector<std::string> seeds;
  for (const results::SessionRow& session : sessions) {
    programs.insert(
        fmt::format("{} ({}, {})", session.program_version, session.git_hash, session.compiler));
    devices.insert(
        fmt::format("{}, {} Hz, {}", session.device, session.rate_hz, session.scheduler));
    seeds.push_back(fmt::format("{} {}", session.participant_id, session.seed));
  }
  std::vector<std::pair<std::string, std::string>> all{
      {"protocol", study.protocol_file},
      {"protocol SHA-256", study.protocol_sha256},
      {"tapstudy", fmt::format("{}", fmt::join(programs, "; "))},
      {"device", fmt::format("{}", fmt::join(devices, "; "))},
      {"seeds", fmt::format("{}", fmt::join(seeds, ", "))}};
  for (const protocols::SurfaceSource& surface : protocol.surfaces) {
    if (const std::string noise = surface.noise.describe(); !noise.empty()) {
      all.emplace_back("surface " + surface.file, noise);
    }
    if (!surface.changes.empty()) {
      all.emplace_back("surface " + surface.file,
                       fmt::format("{}", fmt::join(surface.changes, "; ")));
    }
  }
  return all;
}

// Whether its model has elements: not a beam's, in closed form.
bool is_meshed(const protocols::Stimulus& stimulus) {
  return stimulus.technique->needs_model() && !stimulus.technique->needs_beam();
}

// Of studies of which some were begun before the usual element order changed, a later one.
void check_states_orders(results::Store& later, const std::vector<std::string>& directories) {
  const protocols::Protocol protocol = stored_protocol(later);
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (is_meshed(stimulus) && stimulus.plate->mesh.order == core::chosen_order) {
      throw core::InvalidInput{fmt::format(
          "{}: the plate of '{}' states no mesh.order, so that its elements are linear in studies "
          "begun by tapstudy before 0.3, and in the others are not: their answers cannot be put "
          "into one report",
          fmt::join(directories, ", "), stimulus.name)};
    }
  }
}

bool says_the_same(results::Store& store, const std::string& other_text) {
  const protocols::ChangesOfFile changes = changes_in(stored_protocol(store), other_text);
  return changes.data_keys.empty() && changes.texts.empty();
}

void check_same_protocol(const std::vector<StudyStore>& stores) {
  const results::StudyRow first = stores.front().store->study();
  std::vector<std::string> directories;
  results::Store* later = nullptr;
  results::Store* of_linear_ones = nullptr;
  for (const StudyStore& other : stores) {
    const results::StudyRow study = other.store->study();
    if (study.surfaces != first.surfaces ||
        (study.protocol_sha256 != first.protocol_sha256 &&
         !says_the_same(*stores.front().store, study.protocol_text))) {
      throw core::InvalidInput{fmt::format(
          "{} and {} hold different protocols: their answers cannot be put into one report",
          stores.front().directory, other.directory)};
    }
    directories.push_back(other.directory);
    const bool is_linear = defaults_of(*other.store).element_order == 1;
    (is_linear ? of_linear_ones : later) = other.store;
  }
  if (later != nullptr && of_linear_ones != nullptr) {
    check_states_orders(*later, directories);
  }
}

// Sessions are compared whatever the participants' names, because a redacted copy holds the
// sessions of its study.
void check_different_participants(const std::vector<StudyStore>& stores) {
  std::map<std::string, std::string> directories;
  std::map<std::pair<std::uint64_t, std::string>, std::string> begun;
  for (const StudyStore& each : stores) {
    std::set<std::string> here;
    for (const results::SessionRow& session : each.store->sessions()) {
      here.insert(session.participant_id);
      const auto [other, is_new] =
          begun.try_emplace({session.seed, session.started_utc}, each.directory);
      if (!is_new && other->second != each.directory) {
        throw core::InvalidInput{
            fmt::format("{} and {} hold the same session, begun {} with the seed {}: is one a copy "
                        "of the other?",
                        other->second, each.directory, session.started_utc, session.seed)};
      }
    }
    for (const std::string& participant : here) {
      const auto [before, is_new] = directories.try_emplace(participant, each.directory);
      if (!is_new) {
        throw core::InvalidInput{fmt::format("participant {} is in {} and in {}", participant,
                                             before->second, each.directory)};
      }
    }
  }
}

// Of the sessions, those before major.minor.
std::set<std::string> versions_before(int major, int minor,
                                      const std::vector<results::SessionRow>& sessions) {
  std::set<std::string> versions;
  for (const results::SessionRow& session : sessions) {
    if (is_before(session.program_version, major, minor)) {
      versions.insert(session.program_version);
    }
  }
  return versions;
}

// Empty: no session of these stimuli was run by an earlier version.
std::string coupled_fingers_before(const protocols::Protocol& protocol,
                                   const std::vector<results::SessionRow>& sessions) {
  const std::set<std::string> versions = versions_before(0, 2, sessions);
  const auto coupled = std::ranges::find_if(protocol.stimuli, [](const auto& stimulus) {
    return stimulus.technique->has(core::coupled_vibration);
  });
  if (versions.empty() || coupled == protocol.stimuli.end()) {
    return "";
  }
  const double contact = protocol.rendering.penalty_stiffness_n_per_m;
  const double finger = protocol.rendering.finger.stiffness_n_per_m;
  const double in_series = contact * finger / (contact + finger);
  return fmt::format(
      "sessions run by tapstudy {}: {} pressed slowly was stiffer than techniques without a "
      "coupled finger ({:.4g} N/m instead of {:.4g} with the protocol's own values), and the plate "
      "carried {:.0f} % of the force that the hand felt; from 0.2.0 on all techniques are equally "
      "stiff at rest, and it carries all of it",
      fmt::join(versions, ", "), coupled->technique->name, contact + in_series, contact,
      100.0 * in_series / (contact + in_series));
}

bool is_on_springs(const protocols::Stimulus& stimulus) {
  const auto has_springs = [](const core::Plate& body) {
    return core::is_on_springs(body.fixations);
  };
  return stimulus.technique->needs_model() &&
         (has_springs(*stimulus.plate) ||
          (stimulus.contacts && (!stimulus.contacts->springs.empty() ||
                                 std::ranges::any_of(stimulus.contacts->bodies, has_springs))));
}

bool is_automatic_sheet(const protocols::Stimulus& stimulus) {
  return is_meshed(stimulus) && stimulus.plate->mesh.is_automatic &&
         core::is_sheet(stimulus.plate->shape);
}

// What version 0.`minor` changed for some stimuli; the message has {} for their names.
struct RenderingChange {
  int minor;
  bool (*concerns)(const protocols::Stimulus& stimulus);
  const char* message;
};
constexpr std::array rendering_changes{
    RenderingChange{
        4, is_on_springs,
        "springs under {} held parts of triangles where a region's edge cuts through them, "
        "so that frequencies may have been some per cent higher; from 0.4.0 on they hold the "
        "nodes that a rigid fixation of the region holds"},
    RenderingChange{
        5, is_automatic_sheet,
        "mesh: auto took tetrahedra for {}, and takes shell elements from 0.5.0 on, whose "
        "frequencies differ by up to what the study's accuracy allows"}};

// Empty: no session of these stimuli was run by an earlier version.
std::string stimuli_before(const RenderingChange& change, const protocols::Protocol& protocol,
                           const std::vector<results::SessionRow>& sessions) {
  const std::set<std::string> versions = versions_before(0, change.minor, sessions);
  std::vector<std::string> names;
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (change.concerns(stimulus)) {
      names.push_back(stimulus.name);
    }
  }
  return versions.empty() || names.empty()
             ? ""
             : fmt::format("sessions run by tapstudy {}: ", fmt::join(versions, ", ")) +
                   fmt::format(fmt::runtime(change.message), fmt::join(names, ", "));
}
}  // namespace

std::vector<std::string> rendered_by_earlier_versions(
    const protocols::Protocol& protocol, const std::vector<results::SessionRow>& sessions) {
  std::vector<std::string> said{coupled_fingers_before(protocol, sessions)};
  for (const RenderingChange& change : rendering_changes) {
    said.push_back(stimuli_before(change, protocol, sessions));
  }
  std::erase(said, "");
  return said;
}

namespace {
// Values of blocks are of who is reported; nobody else need be left out here.
std::vector<analysis::ParticipantGroup> participant_groups(
    const protocols::Protocol& protocol, const std::vector<results::SessionRow>& sessions) {
  std::vector<analysis::ParticipantGroup> groups;
  for (const protocols::Group& group : protocol.groups) {
    groups.push_back({group.label, {}});
    for (const results::SessionRow& session : sessions) {
      if (session.group && session.group->name == group.name) {
        groups.back().participants.insert(session.participant_id);
      }
    }
  }
  return groups;
}

// Blocks that two groups did with different stimuli.
std::vector<analysis::DifferentStimuli> different_stimuli(const protocols::Protocol& protocol) {
  std::vector<analysis::DifferentStimuli> different;
  for (const protocols::Block& block : protocol.blocks) {
    for (auto first = protocol.groups.begin(); first != protocol.groups.end(); ++first) {
      for (auto second = std::next(first); second != protocol.groups.end(); ++second) {
        const protocols::Block own = protocols::block_of(&*first, block);
        const protocols::Block other = protocols::block_of(&*second, block);
        if (!block.is_practice && protocols::does(&*first, block) &&
            protocols::does(&*second, block) &&
            std::set<std::string>(own.stimuli.begin(), own.stimuli.end()) !=
                std::set<std::string>(other.stimuli.begin(), other.stimuli.end())) {
          different.push_back({block.name, first->label, second->label,
                               protocols::right_answers(own) == protocols::right_answers(other)});
        }
      }
    }
  }
  return different;
}

// Hypotheses are adjusted for the number of all of them, so that theirs are always computed, and
// contrasts, groups and what is measured again are of all blocks, whose main results do. A block
// without answers is one that the report tells of.
void leave_out_unwanted(const Wanted& wanted, const std::vector<results::AnswerRow>& answers,
                        analysis::StudyDesign& design) {
  namespace names = analysis::study_sections;
  for (analysis::BlockDesign& block : design.blocks) {
    block.is_for_main_results = !wanted.has(block.name);
  }
  if (wanted.has(names::contrasts) || wanted.has(names::groups) || wanted.has(names::retest) ||
      wanted.has(names::mixed_models)) {
    return;
  }
  std::set<std::string> others;
  for (const analysis::BlockDesign& block : design.blocks) {
    for (const analysis::PlannedComparison& planned : block.comparisons) {
      others.insert(planned.other_block);
    }
  }
  std::erase_if(design.blocks, [&](const analysis::BlockDesign& block) {
    return !wanted.has(block.name) && block.hypotheses.empty() && block.comparisons.empty() &&
           !others.contains(block.name) &&
           std::ranges::find(answers, block.name, &results::AnswerRow::block) != answers.end();
  });
}

std::optional<analysis::ReportSection> mixed_models(const protocols::Protocol& protocol,
                                                    const StoredResults& all,
                                                    const FitMixedModels& fit,
                                                    const Summary& summary) {
  const auto data =
      fit ? mixed_models_data(protocol, all.answers, summary.blocks, all.sessions) : std::nullopt;
  if (!data) {
    return std::nullopt;
  }
  const Progress progress{"fitting mixed models in R"};
  return analysis::mixed_models_section(fit(*data));
}

// They stand before the other sections: groups first, then blocks, test and retest, mixed models.
void add_comparisons(const protocols::Protocol& protocol, const StoredResults& all,
                     const FitMixedModels& fit, const Wanted& wanted, Summary& summary) {
  namespace names = analysis::study_sections;
  const auto add = [&](std::string_view name, const auto& compute) {
    if (!wanted.has(name)) {
      return;
    }
    if (std::optional<analysis::ReportSection> section = compute()) {
      summary.sections.insert(summary.sections.begin(), std::move(*section));
    }
  };
  add(names::mixed_models, [&] { return mixed_models(protocol, all, fit, summary); });
  add(names::retest,
      [&] { return analysis::retest_section(summary.blocks, repeated_blocks(protocol)); });
  add(names::contrasts, [&] {
    return analysis::block_contrasts(summary.blocks,
                                     protocol.block_order.order == protocols::Order::listed);
  });
  add(names::groups, [&] {
    return analysis::groups_section(summary.blocks, participant_groups(protocol, all.sessions),
                                    different_stimuli(protocol));
  });
}
}  // namespace

Summary summary_of_study(const std::vector<StudyStore>& stores, Mode mode, Detail detail,
                         const std::vector<std::string>& only,
                         const FitMixedModels& fit_mixed_models) {
  check_same_protocol(stores);
  check_different_participants(stores);
  const results::StudyRow study = stores.front().store->study();
  const protocols::Protocol protocol = stored_protocol(*stores.front().store);
  const Wanted wanted{only, protocol};
  const bool shows_tracks = detail == Detail::all && wants_tracks(protocol, wanted);
  StoredResults all;
  std::vector<std::string> directories;
  std::vector<ReplayedTracks> tracks;  // of each store
  for (const StudyStore& each : stores) {
    check_names(*each.store, protocol);
    tracks.emplace_back(protocol, *each.store);
    append(all,
           stored_results(*each.store, protocol, mode, shows_tracks ? &tracks.back() : nullptr));
    directories.push_back(each.directory);
  }
  if (std::ranges::all_of(stores,
                          [](const StudyStore& each) { return each.store->sessions().empty(); })) {
    throw core::InvalidInput{
        fmt::format("{}: {}", fmt::join(directories, ", "), unfinished_beginning)};
  }
  if (all.answers.empty()) {
    throw core::InvalidInput{fmt::format(
        "{}: no answers of {} participants to report{}", fmt::join(directories, ", "),
        results::to_text(mode),
        all.excluded.empty() ? "" : fmt::format(" ({} excluded)", all.excluded.size()))};
  }
  analysis::StudyDesign design = design_of(protocol, mode);
  design.groups = participant_groups(protocol, all.sessions);
  if (detail == Detail::main_results) {
    for (analysis::BlockDesign& block : design.blocks) {
      block.is_for_main_results = true;
    }
    return analysis::summarise(design, all.answers, all.visits, all.presentations);
  }
  leave_out_unwanted(wanted, all.answers, design);
  Summary summary = [&] {
    Progress progress{"blocks summarised"};
    design.count = progress.count();
    return analysis::summarise(design, all.answers, all.visits, all.presentations);
  }();
  const DoneBlocks done = done_blocks(stores, mode);
  summary.sections = sections_of(protocol, stores, mode, done, wanted, tracks);
  add_comparisons(protocol, all, fit_mixed_models, wanted, summary);
  summary.provenance = provenance(study, protocol, all.sessions);
  summary.procedure = describe_procedure(protocol, all.sessions, summary.participant_ids, done);
  summary.unfinished = std::move(all.unfinished);
  summary.excluded = std::move(all.excluded);
  std::ranges::move(all.deviations, std::back_inserter(summary.deviations));
  std::ranges::move(rendered_by_earlier_versions(protocol, all.sessions),
                    std::back_inserter(summary.deviations));
  if (!only.empty()) {
    analysis::keep_only(summary, only);
  }
  return summary;
}
}  // namespace tapstudy::runner
