#pragma once
#include <string>

#include "runner/laboratory/identify/tap_identification.hpp"
namespace tapstudy::runner {
// Of the modal assurance of every measured mode with every one of the model's, where it is known
// (ModelComparison::assurance): mac.csv, a row for each pair with the frequencies, the model's at
// the protocol's Young's modulus, and mac.svg, a square for each pair, those that were matched
// framed. Throws InvalidInput if they exist already or cannot be written.
void write_assurance(const ModalFindings& found, const std::string& directory);
}  // namespace tapstudy::runner
