#pragma once
#include "protocols/protocol.hpp"
#include "protocols/rig.hpp"
#include "runner/session/stimuli/model_library.hpp"
namespace tapstudy::runner {
// Prints the stimuli that vary: along what, how many models that takes, what these cost to solve
// and to hold, and how many modes the members have. Builds all models. Throws as build_all does.
void print_families(const protocols::Protocol& protocol, ModelLibrary& models);

// The energy that a strike leaves in a plate at rest, over the kinetic energy of the finger, whose
// momentum goes to the modes (paper eq. 14 to 16): m sum over modes of (phi . n)^2. Above 1 the
// finger gives more than it has. at_m: on the plate from above, plate frame.
double impact_energy_share(const core::VibratingPlate& plate, const Eigen::Vector2d& at_m,
                           double finger_kg);
// What a stimulus's model spends, and what for: unknowns and seconds for an accuracy; modes of the
// band in each tick, and those that no tap excites by name, with the level that they have, or would
// have. A line each.
std::string describe_spending(const protocols::Protocol& protocol,
                              const protocols::PresentedStimulus& stimulus, ModelLibrary& models);
// Prints a warning for each stimulus with a tapping point where it is above 1, and one for each
// that can move as a rigid body, which no technique renders.
void warn_of_light_plates(const protocols::Protocol& protocol, ModelLibrary& models);

// How many modes the device, the actuator and both render, where the protocol has a crossover.
void print_divided_modes(const protocols::Protocol& protocol, ModelLibrary& models);

// Names the modes of each stimulus that the rig's device does not render: above its vibration band,
// which is 300 Hz where a device of hardware states none (the paper, section 4), and where its
// response to a vibration is below a half; not those that an actuator renders. Nothing of a rig
// that has neither.
void print_unrendered_modes(const protocols::Protocol& protocol, ModelLibrary& models,
                            const protocols::Rig& rig);

// A line that names the real plates that simulated participants remember and no stimulus's model
// is of; empty without any. Throws as with_real_plates does.
std::string describe_real_plates(const protocols::Protocol& protocol);

// Lines for each surface file of the protocol that has something in excess of its body, and for
// each surface that is repaired: what changed.
std::string describe_surfaces(const protocols::Protocol& protocol);
// A line for each body whose elements are linear because quadratic ones were too many: a warning
// with its cure.
std::string warning_of_order(const protocols::PresentedStimulus& stimulus,
                             const core::ModelReport& report);
// A line for each body whose mesher was given a larger radius-edge ratio than the protocol's: what
// and why.
std::string note_of_relaxation(const protocols::PresentedStimulus& stimulus,
                               const core::ModelReport& report);
// A line for each sheet by its middle that is folded: along how many edges, as a curved one is,
// too, whose triangles are wide.
std::string note_of_folds(const protocols::PresentedStimulus& stimulus);
// A line where two bodies are joined by springs between one pair of regions only, which turn freely
// about each other there.
std::string note_of_hinges(const protocols::PresentedStimulus& stimulus);
// The edges at which the surface of the plate that is tapped, or of a body that it touches, from 1,
// is folded; 0 where that is no sheet.
std::size_t folds_of(const protocols::PresentedStimulus& stimulus, std::size_t body);
// "445 linear tetrahedra"; "8 shell elements".
std::string describe_elements(const core::ModelReport& report);
// One line about the discretisation error of a model's frequencies.
std::string describe_errors(const core::FrequencyErrors& errors);
// Beyond 5 %, or where modes are missing, or nothing is known, and where fixations are held in
// part: warnings with their cures; else empty.
std::string warning_of_errors(const std::string& stimulus, const core::FrequencyErrors& errors);
}  // namespace tapstudy::runner
