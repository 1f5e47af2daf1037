#pragma once
#include <optional>
#include <string>
#include <vector>

#include "analysis/modal/response/response_modes.hpp"
#include "runner/laboratory/identify/tap_identification.hpp"
namespace tapstudy::runner {
// The request for an identification from measured frequency responses.
struct ResponseQuestion {
  std::vector<std::string> files;
  std::optional<analysis::ResponseKind> kind;  // where the files do not state it
  std::optional<analysis::Band> band;          // unset: all frequencies
  std::string places;    // CSV of where the responses' places are; empty: not known
  std::string protocol;  // with a stimulus, or both empty
  std::string stimulus;
};

struct ResponseIdentification : ModalFindings {
  ResponseQuestion question;
  analysis::ResponseModes responses;  // its modes are those of ModalFindings, in this order
};

// Throws InvalidInput as read_responses, find_response_modes and read_named_places do, and for a
// place that no response has; ModelError if the stimulus's
// model cannot be built.
ResponseIdentification identify_responses(const ResponseQuestion& question, Progress& progress);

// Prints modes, damping, the model beside it and remarks to stdout.
void print(const ResponseIdentification& found);

std::string json_of(const ResponseIdentification& found);

// A row for each mode and place: mode (from 1), frequency_hz, place, real, imaginary.
std::string shapes_csv(const ResponseIdentification& found);

// identified.yaml, identified.json, shapes.csv, stabilisation.svg, responses.svg and, of known
// places, mac.csv and mac.svg, into a new directory. Throws InvalidInput if it exists already or
// cannot be written.
void write_files(const std::string& directory, const ResponseIdentification& found);
}  // namespace tapstudy::runner
