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
  std::string unit{};  // of the samples, where the file states it apart from the channel
};
inline constexpr const char* full_scale = "full scale";  // the unit of sound

struct ReadingOptions {
  double rate_hz{0.0};      // where the file states none; 0: it must
  std::string column;       // header or number, from 1, of the channel; empty: the only one
  bool trusts_rate{false};  // rate_hz instead of another one that the file states
};

inline constexpr std::size_t min_samples = 64;
// Times may differ from a uniform grid by this share of a period.
inline constexpr double max_jitter_periods = 0.1;

// Chooses the reader by the extension: read_csv_recording for .csv, .txt, .tsv, .dat, .asc and
// .lvm, read_matlab_file for .mat, read_hdf5_file for .h5, .hdf5 ..., read_universal_file for .uff,
// .unv and .uf, read_sound_file for any other. Throws InvalidInput, with the file and, of text, the
// line: unreadable, no such column, no rate, another rate than given, times that are not uniform,
// values that are not finite, fewer than min_samples; in words how to convert what is not read.
Recording read_recording(const std::string& file, const ReadingOptions& options);

// One channel of a table: cells separated by tabs, semicolons, commas or blanks (the first of these
// that the rows hold; but with commas a decimal comma is understood), perhaps with comments (#),
// lines of settings and a header above (plain_table). A column is the time if its header says so
// (time_unit_of) or, with no header and no rate given, if it is the first of several and
// ascends. A time that is no number gives way to a rate. The rate is that of the even times nearest
// to these (least squares). A rate given as well must be the same within 0.1 % (agreed_rate).
// Throws InvalidInput as read_recording says.
Recording read_csv_recording(std::istream& text, const std::string& file,
                             const ReadingOptions& options);

// One channel of a WAV, FLAC, AIFF ... file, by libsndfile, with a remark where the format is
// lossy. What has no header of sound, but libsndfile takes for it, is refused. Throws InvalidInput
// as read_recording says.
Recording read_sound_file(const std::string& file, const ReadingOptions& options);

// One real numeric array of a MATLAB file of versions 4 to 7.3, by matio, or of an HDF5 file (and
// so of netCDF 4): recording_in says which, and its rate. Throw InvalidInput as read_recording
// says.
Recording read_matlab_file(const std::string& file, const ReadingOptions& options);
Recording read_hdf5_file(const std::string& file, const ReadingOptions& options);

// One time record (function type 1) of the data sets 58 and 58b of a universal file (SDRC, as
// documented by the University of Cincinnati): real, evenly spaced, single or double, of either
// byte order. It is named by its number among them or as the response's node and direction
// ("12+Z"). Throws InvalidInput as read_recording says; also for data cut off.
Recording read_universal_file(const std::string& file, const ReadingOptions& options);
}  // namespace tapstudy::analysis
