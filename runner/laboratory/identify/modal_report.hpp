#pragma once
#include <string>
#include <vector>

#include "analysis/report/figures/figure.hpp"
#include "runner/laboratory/identify/tap_identification.hpp"
namespace tapstudy::runner {
// Prints modes, damping, sinusoid, the model beside it, taps and remarks to stdout. What is no mode
// for certain is summed up, or with Listing::all shown.
enum class Listing { modes, all };
void print(const TapIdentification& found, Listing listing);
// The parts of this that follow from modes alone: Rayleigh's coefficients and the model.
void print_damping_and_model(const ModalFindings& found);

// The results as keys of a protocol, with intervals and remarks as comments: the whole material
// under `materials` if a stimulus was named, else `damping` alone; under `rendering` the sinusoid
// where its force is known. Damping is Rayleigh's where it fits. Ratios stand beside the
// frequencies at which they were found; as `modal_ratios`, which go to the model's modes in order,
// they are offered where a model says which mode is which: up to the last mode that was measured,
// those between by linear interpolation over frequency, which a comment says. Where springs were
// found, the plate's `fixations`, whole, under `plates`.
std::string yaml_of(const ModalFindings& found);

// One of a protocol's fixations, as it is read: {region: ...}. is_of_box: of a plate, not a
// surface.
std::string fixation_yaml(const core::Fixation& fixation, bool is_of_box);

std::string json_of(const TapIdentification& found);

// The taps as `recordings` of a protocol, of accelerations of a fingertip or stylus that tapped at
// one place, with their speeds: the forces that give `finger_kg` these accelerations
// (acceleration matching, Kuchenbecker, Fiene & Niemeyer 2006).
std::string playback_of(const TapIdentification& found, double finger_kg);

struct NamedFigure {
  std::string name;  // of its file
  analysis::Figure figure;
};
// time.svg and spectrum.svg: measured and fitted, of the first taps; stabilisation.svg of the
// first.
std::vector<NamedFigure> figures_of(const TapIdentification& found);

// identified.yaml, identified.json, recordings.yaml where a place was given, and the figures, into
// a new directory. Throws InvalidInput if it exists already or cannot be written.
void write_files(const std::string& directory, const TapIdentification& found);
}  // namespace tapstudy::runner
