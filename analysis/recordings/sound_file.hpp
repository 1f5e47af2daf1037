#pragma once
#include "analysis/recordings/recording.hpp"
namespace tapstudy::analysis {
// One channel of a WAV, FLAC, AIFF ... file, by libsndfile. The file says its rate: another one in
// the options is refused. Throws InvalidInput as read_recording says.
Recording read_sound_file(const std::string& file, const ReadingOptions& options);
}  // namespace tapstudy::analysis
