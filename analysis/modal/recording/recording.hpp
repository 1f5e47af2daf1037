#pragma once
#include <istream>
#include <string>
#include <vector>
namespace tapstudy::analysis {
// The quantity that a sensor measures. Natural frequencies and damping ratios are the same for all
// three.
enum class Quantity { acceleration, velocity, displacement };

// "acceleration" ... Throws InvalidInput for another word.
Quantity quantity_from(const std::string& word);
const char* name(Quantity quantity);

// One channel, sampled uniformly.
struct Recording {
  std::string file;
  std::string channel;  // the column's header, or "channel 1"
  double rate_hz{};
  std::vector<double> samples;       // in the file's unit; of sound, 1 is full scale
  std::vector<std::string> remarks;  // sentences: what was noticed while reading
};

struct ReadingOptions {
  double rate_hz{0.0};  // of CSV without a time column; 0: there must be one
  std::string column;   // header or number, from 1, of the channel; empty: the only one
};

inline constexpr std::size_t min_samples = 64;
// Times may differ from a uniform grid by this share of a period.
inline constexpr double max_jitter_periods = 0.1;

// Chooses the reader by the extension: read_csv_recording for .csv, .txt and .tsv, read_sound_file
// for any other. Throws InvalidInput, with the file and, of CSV, the line: unreadable, no such
// column, no rate, times that are not uniform, values that are not finite, fewer than min_samples.
Recording read_recording(const std::string& file, const ReadingOptions& options);

// One channel of a table: cells separated by tabs, semicolons or commas (the first of these that
// the first row holds; with semicolons and tabs a decimal comma is understood), perhaps with
// comments (#) and a header. A column is the time if its header says so (t, time, and a unit s, ms
// or us in brackets or after an underscore) or, with no header and no rate given, if it is the
// first of several and ascends. The rate is that of the even times nearest to these (least
// squares). A rate given as well must be the same within 0.1 %. Throws InvalidInput as
// read_recording says.
Recording read_csv_recording(std::istream& text, const std::string& file,
                             const ReadingOptions& options);

// One channel of a WAV, FLAC, AIFF ... file, by libsndfile. The file says its rate: another one in
// the options is refused. Throws InvalidInput as read_recording says.
Recording read_sound_file(const std::string& file, const ReadingOptions& options);
}  // namespace tapstudy::analysis
