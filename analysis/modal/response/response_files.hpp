#pragma once
#include <string>
#include <vector>

#include "analysis/modal/response/frequency_responses.hpp"
namespace tapstudy::analysis {
// Whether a file holds frequency responses and no recording: a table with a column frequency_hz, or
// a universal file (.uff, .unv, .uf) with functions of frequency and without time records. Throws
// InvalidInput if it cannot be read.
bool holds_responses(const std::string& file);

// All frequency responses of the files, which must be at the same frequencies and of one kind.
//
// Universal files: data sets 58 and 58b of function type 4, complex, evenly spaced, with response
// and reference, of accelerations, velocities or displacements by forces; spectra and coherences
// beside them are left out with a remark.
//
// Tables: a column frequency_hz, and for each response two columns whose headers are its name and
// one of real and imag, or magnitude and phase_deg: "12+Z/1+Z real". The name is the response's
// place, or that and the reference's.
//
// given: the kind, where the files do not state it. Throws InvalidInput with the file, of text with
// the line: no response, no kind or another than given, no reference, a response twice, values cut
// off or not finite, frequencies that do not ascend or differ between responses.
FrequencyResponses read_responses(const std::vector<std::string>& files,
                                  std::optional<ResponseKind> given);
}  // namespace tapstudy::analysis
