#pragma once
#include <istream>

#include "analysis/recordings/recording.hpp"
namespace tapstudy::analysis {
// One channel of a table: cells separated by tabs, semicolons or commas (the first of these that
// the first row holds; with semicolons and tabs a decimal comma is understood), perhaps with
// comments (#) and a header. A column is the time if its header says so (t, time, and a unit s, ms
// or us in brackets or after an underscore) or, with no header and no rate given, if it is the
// first of several and ascends. The rate is that of the even times nearest to these (least
// squares). A rate given as well must be the same within 0.1 %. Throws InvalidInput as
// read_recording says.
Recording read_csv_recording(std::istream& text, const std::string& file,
                             const ReadingOptions& options);
}  // namespace tapstudy::analysis
