#pragma once
#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/model/plate.hpp"
#include "core/placement.hpp"
#include "core/settings/hand_body.hpp"
#include "core/settings/render_settings.hpp"
#include "core/techniques/technique.hpp"
#include "protocols/surface/surface_source.hpp"
#include "protocols/tasks/task.hpp"
namespace tapstudy::protocols {
// A study as specified by its YAML file. Maps are sorted by name; lists keep the order of the file.

// A stimulus: a plate of a material, rendered by a technique. Plates and materials are shared
// between stimuli.
struct Stimulus {
  std::string name;
  std::string label;  // what participants read
  std::shared_ptr<const core::Plate> plate;
  std::shared_ptr<const core::Material> material;
  const core::Technique* technique{};
  std::map<std::string, std::string> factors;  // factor → level, for reports
};

// How the trials of a block follow one another.
//   listed                     as in the file, repetition after repetition
//   shuffle                    all presentations in one random order
//   shuffle_within_repetition  every stimulus once in random order, then again
//   williams                   a balanced Latin square over participants (Williams 1949)
enum class Order { listed, shuffle, shuffle_within_repetition, williams };

struct Block {
  std::string name;
  const Task* task{};
  std::string question;
  std::vector<std::string> stimuli;
  std::vector<std::string> responses;  // names of stimuli that can be answered, if not the above
  int repetitions{1};
  Order order{Order::shuffle};
  bool is_practice{false};
};

// A pre-registered hypothesis; reports treat only these as planned tests.
struct Hypothesis {
  std::string name;
  std::string statement;
  std::string block;
  Claim claim{};
  std::string stimulus;  // chosen_above_chance: which
};

// Simulated participants, for studies without people.
struct SimulatedTapSettings {
  std::vector<std::string> points;  // names of tapping points, visited in random order
  int taps_per_visit{8};
  int visits{2};             // to each alternative, where there are several
  double scatter_m{0.01};    // standard deviation of the place hit, on the plate
  double speed_m_s{0.3};     // median speed
  double speed_spread{0.2};  // standard deviation of its logarithm
  double dwell_s{0.25};
  double pause_s{0.35};
  double hover_m{0.02};
  double press_m{0.004};
};
struct SimulatedObserverSettings {
  // Internal noise on each felt feature; the default reproduces the accuracies of the paper's
  // Table 2.
  double noise_db{9.0};
  double threshold_n{1e-4};      // force amplitudes well below are not felt
  int familiarisation_taps{24};  // on each real plate, before the study
  std::string reference;         // the stimulus taken as reality, where a task needs one
};
struct Simulation {
  core::HandBody hand;
  SimulatedTapSettings taps;
  SimulatedObserverSettings observer;
};

struct Protocol {
  std::string text;                     // the file, whole
  std::vector<SurfaceSource> surfaces;  // the files that its plates name, whole
  std::string title;
  std::string notes;
  double band_limit_hz{};
  double rate_hz{};
  core::RenderSettings rendering;
  core::Placement placement;
  std::map<std::string, std::shared_ptr<const core::Material>> materials;
  std::map<std::string, std::shared_ptr<const core::Plate>> plates;
  std::map<std::string, Eigen::Vector2d> tapping_points_m;  // plate frame
  std::vector<Stimulus> stimuli;
  std::vector<Block> blocks;
  std::vector<Hypothesis> hypotheses;
  Simulation simulation;

  // Throws InvalidInput listing the known stimuli.
  const Stimulus& stimulus(const std::string& name) const;
  const Block& block(const std::string& name) const;
};
}  // namespace tapstudy::protocols
